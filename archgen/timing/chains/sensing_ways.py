"""The ways on which data comes to an activity from the sensors: which of them is the longest, and how old data is at its end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.graph_search import find_rings
from archgen.timing.chains.cost_network import CostNetwork, has_gaps
from archgen.timing.figures.timing_values import TimingValue, sum_bounds
from archgen.timing.system.timing_system import Arc


class SensingWay(NamedTuple):
    """A way from a sensor: its activities, the sensor first, and how old (ns) what the last one gives is at most."""

    activities: tuple[str, ...]
    age: TimingValue


class _Step(NamedTuple):
    """An arc from an activity to one of its neighbours, with its cost in a `CostNetwork`."""

    neighbour: str
    cost: int
    arc: Arc


class SensingWays:
    """The way from the farthest sensor to each activity. Of each sensor the way of the fewest elements counts, which is what
    it is read for; of several of as many elements, the longest one.
    """

    def __init__(self, network: CostNetwork, architecture: Architecture) -> None:
        """Find the ways to all activities, in one search from each sensor."""
        system = network.steps.analysis.system
        self._network, edges = network, _find_edge_components(architecture)
        graph, starts = network.cost_graph("reduced reaction")
        self._start_costs = dict(zip(network.names, starts, strict=True))
        costs = {network.arcs[hop.arc]: hop.cost for hops in graph for hop in hops}
        self._steps_back = {
            name: [_Step(arc.source, costs[arc], arc) for arc in self._list_feeding_arcs(name, edges)]
            for name in system.activities
        }
        """By activity what it works on; of what touches the world, such as a motor that tells where it stands, nothing."""
        sources = {name: [arc.source for arc in arcs] for name, arcs in system.arcs_into.items()}
        self._loops = {name: loop for loop in find_rings(sources) for name in loop}
        self._ways = self._find_all_ways()
        self._ways_past: dict[tuple[str, str], SensingWay] = {}

    def find_way(self, source: str, reader: str) -> SensingWay:
        """Return the way from the farthest sensor to an activity that sends to a reader."""
        # Only a reader that feeds the source, too, lies on a way to it: to all others what it sends is the same.
        if reader not in self._loops.get(source, ()):
            return self._ways[source]
        if (source, reader) not in self._ways_past:
            costs, arcs = _search_fewest_steps(self._steps_back, source, reader)
            sensors = [name for name in costs if not self._steps_back[name]] or [source]
            name = max(sensors, key=lambda sensor: self._rank(sensor, costs[sensor]))
            way = self._begin_way(name)
            while name != source:
                way, name = self._lengthen_way(way, arcs[name]), arcs[name].target
            self._ways_past[source, reader] = way
        return self._ways_past[source, reader]

    def _find_all_ways(self) -> dict[str, SensingWay]:
        steps_on: dict[str, list[_Step]] = {name: [] for name in self._steps_back}
        for name, steps in self._steps_back.items():
            for step in steps:
                steps_on[step.neighbour].append(_Step(name, step.cost, step.arc))
        ranks: dict[str, tuple[bool, int]] = {}
        ways = {name: self._begin_way(name) for name in self._steps_back}
        for sensor in (name for name, steps in self._steps_back.items() if not steps):
            costs, arcs = _search_fewest_steps(steps_on, sensor)
            farther = {sensor: ways[sensor]}
            for name, cost in costs.items():
                rank = self._rank(sensor, cost)
                if name not in ranks or ranks[name] < rank:
                    ranks[name] = rank
                    ways[name] = self._follow_arcs(arcs, farther, name)
        return ways

    def _follow_arcs(self, arcs: Mapping[str, Arc], ways: dict[str, SensingWay], name: str) -> SensingWay:
        """Return the way to an activity by the arcs that lead to each, and add it to those that are known, with all before."""
        behind = []
        while name not in ways:
            behind.append(arcs[name])
            name = arcs[name].source
        for arc in reversed(behind):
            ways[arc.target] = self._lengthen_way(ways[arc.source], arc)
        return ways[behind[0].target if behind else name]

    def _rank(self, sensor: str, cost: int) -> tuple[bool, int]:
        """Return the rank of a way from a sensor: what has no bound is the farthest, and then the others say nothing."""
        total = self._start_costs[sensor] + cost
        return has_gaps(total), total

    def _begin_way(self, name: str) -> SensingWay:
        return SensingWay((name,), sum_bounds((self._network.start_response(name),)))

    def _lengthen_way(self, way: SensingWay, arc: Arc) -> SensingWay:
        costs = self._network.step_costs(arc, "reduced reaction")
        return SensingWay((*way.activities, arc.target), sum_bounds((way.age, *costs)))

    def _list_feeding_arcs(self, name: str, edges: Mapping[str, frozenset[str]]) -> tuple[Arc, ...]:
        """Return what an activity works on: what fires it; where it works by its own clock, all that it reads."""
        system = self._network.steps.analysis.system
        arcs = tuple(arc for arc in system.arcs_into.get(name, ()) if arc.role == "data")
        arcs = tuple(filter(self._network.steps.arrivals.fires_reader, arcs)) or arcs
        touching = edges.get(system.activities[name].node)
        if touching is None:
            return arcs
        # A sensor may be several nodes, of which the last one works on what the first one took.
        return tuple(arc for arc in arcs if touching & edges.get(system.activities[arc.source].node, frozenset()))


def _search_fewest_steps(
    steps: Mapping[str, Sequence[_Step]], start: str, passed: str | None = None
) -> tuple[dict[str, int], dict[str, Arc]]:
    """Return what each activity costs that is reached from one, over the fewest steps and past another, nearest first; and the
    last arc to each but the start. Of several ways of as few steps the one that costs most counts.
    """
    costs = {start: 0}
    arcs: dict[str, Arc] = {}
    level = [start]
    while level:
        reached: dict[str, int] = {}
        for name in level:
            for neighbour, step_cost, arc in steps[name]:
                if neighbour in costs or neighbour == passed:
                    continue
                cost = costs[name] + step_cost
                if cost > reached.get(neighbour, -1):
                    reached[neighbour] = cost
                    arcs[neighbour] = arc
        costs.update(reached)
        level = list(reached)
    return costs, arcs


def _find_edge_components(architecture: Architecture) -> dict[str, frozenset[str]]:
    """Return the components that sense or move something outside of the architecture, by each node that implements some."""
    edges = frozenset(
        component.id
        for component in architecture.components.values()
        if any(port.external for port in component.inputs.values())
        or any(port.external for port in component.outputs.values())
    )
    return {node.id: found for node in architecture.nodes.values() if (found := edges.intersection(node.implements))}
