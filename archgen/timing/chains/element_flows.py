"""What an element takes in and gives out: how often and how old it comes, how it is read, and which deadlines rest on it."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.model.graph_search import find_rings
from archgen.timing.analysis import Analysis, ChainResult, EdgeFit, EventPace
from archgen.timing.chains.chain_regions import lay_out_chain
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.extreme_paths import find_extreme_path
from archgen.timing.figures.timing_values import TimingValue, is_known_bound, sum_bounds
from archgen.timing.system.timing_system import Arc

_LONGEST_CHAIN = 20


@dataclass(frozen=True, slots=True)
class ElementFlow:
    """What passes along an arc; times in ns.

    `age` is that of the data where it arrives, since the work began that gives it; `wait` passes until it is read.
    `since_sensing` is its age on arrival since the farthest sensor took it, along `way` (activities, the reader last): of
    each sensor the way of the fewest elements counts, which is what it is read for.
    """

    arc: Arc
    pace: EventPace
    age: TimingValue
    wait: TimingValue
    reading: str
    triggers: bool
    fit: EdgeFit | None
    since_sensing: TimingValue
    way: tuple[str, ...]
    chains: tuple[ChainResult, ...]
    """The chains with a deadline that rest on it."""


@dataclass(frozen=True, slots=True)
class UnjudgedWay:
    """The longest time (ns) from a change in the world until an element has acted on it by an input on which no deadline
    rests, along `through`: what a chain would say; None of more elements than anybody writes as one chain.
    """

    flow: ElementFlow
    through: tuple[str, ...]
    duration: TimingValue | None


class FlowFinder:
    """Finds what elements take in and give out; what it has found out once, it remembers."""

    def __init__(self, analysis: Analysis, architecture: Architecture, chains: Iterable[ChainResult]) -> None:
        """Index the steps of chains with a deadline, and how the ends of arcs fit together."""
        self.analysis = analysis
        self._network = CostNetwork.of_analysis(analysis)
        edges = _find_edge_components(architecture)
        self._feeding_arcs = {name: self._list_feeding_arcs(name, edges) for name in analysis.system.activities}
        """By activity what it works on; of what touches the world, such as a motor that tells where it stands, nothing."""
        self._elements = self._network.index_elements(architecture)
        self._fits: Mapping[Arc, EdgeFit] = {fit.arc: fit for fit in analysis.edges}
        self._chains_by_step: dict[tuple[str, str], list[ChainResult]] = {}
        for chain in chains:
            names = [term.activity for term in chain.terms] if chain.deadline or chain.shares else []
            for step in itertools.pairwise(names):
                self._chains_by_step.setdefault(step, []).append(chain)
        self._flows: dict[Arc, ElementFlow] = {}
        self._unjudged: dict[Arc, UnjudgedWay | None] = {}
        self._ways: dict[tuple[str, str], tuple[tuple[str, ...], TimingValue]] = {}
        sources = {name: [arc.source for arc in arcs] for name, arcs in analysis.system.arcs_into.items()}
        self._loops = {name: loop for loop in find_rings(sources) for name in loop}

    def list_taken(self, activity_ids: Iterable[str]) -> list[ElementFlow]:
        """Return what some activities take in, without what they send one another, in the order of their inputs."""
        own_ids, arcs_into = tuple(activity_ids), self.analysis.system.arcs_into
        arcs = (arc for name in own_ids for arc in arcs_into.get(name, ()))
        return [self._describe(arc) for arc in arcs if arc.role != "answer" and arc.source not in own_ids]

    def list_given(self, activity_ids: Iterable[str]) -> list[ElementFlow]:
        """Return what some activities give out, without what they send one another."""
        own_ids, arcs_from = tuple(activity_ids), self.analysis.system.arcs_from
        arcs = (arc for name in own_ids for arc in arcs_from.get(name, ()))
        return [self._describe(arc) for arc in arcs if arc.role != "answer" and arc.target not in own_ids]

    def list_unjudged(self, flows: Iterable[ElementFlow]) -> Iterator[UnjudgedWay]:
        """Yield what no chain says of inputs: one way for each on which no deadline rests and that a sensor feeds."""
        for flow in flows:
            if flow.arc not in self._unjudged:
                self._unjudged[flow.arc] = self._find_unjudged(flow)
            way = self._unjudged[flow.arc]
            if way is not None:
                yield way

    def _find_unjudged(self, flow: ElementFlow) -> UnjudgedWay | None:
        if flow.chains or flow.arc.role != "data" or len(flow.way) < 2:  # noqa: PLR2004 - a sensor and a reader
            return None
        if len(flow.way) > _LONGEST_CHAIN:
            return UnjudgedWay(flow, flow.way, None)
        nodes = (self.analysis.system.activities[name].node for name in flow.way)
        points = self._elements.resolve_points([Waypoint("node", node) for node in nodes])
        longest = find_extreme_path(self._network, lay_out_chain(self._network, points), "bound")
        return None if longest is None else UnjudgedWay(flow, flow.way, longest.value)

    def _describe(self, arc: Arc) -> ElementFlow:
        # Each flow stands on the pages of both ends, of components and nodes.
        if arc not in self._flows:
            self._flows[arc] = self._make_flow(arc)
        return self._flows[arc]

    def _make_flow(self, arc: Arc) -> ElementFlow:
        steps = self._network.steps
        delay, response = steps.sampling_delay(arc), self.analysis.responses[arc.source].worst
        way, since = self._find_way(arc.source, arc.target)
        return ElementFlow(
            arc,
            self.analysis.outputs.get((arc.source, arc.output), EventPace(None)),
            sum_bounds((response, steps.link_latency(arc))),
            delay.value,
            delay.why,
            steps.arrivals.fires_reader(arc),
            self._fits.get(arc),
            sum_bounds((since, steps.link_latency(arc))),
            (*way, arc.target),
            tuple(self._chains_by_step.get((arc.source, arc.target), ())),
        )

    def _find_way(self, source: str, reader: str) -> tuple[tuple[str, ...], TimingValue]:
        """Return the way from the farthest sensor to an activity that sends to a reader, and how old what it sends then is
        at most.
        """
        # Only a reader that feeds the source, too, lies on a way to it: to all others what it sends is the same.
        passed = reader if reader in self._loops.get(source, ()) else ""
        if (source, passed) not in self._ways:
            ways = [
                ((*(arc.source for arc in arcs), source), self._sum_way(source, arcs))
                for arcs in self._list_ways(source, passed)
            ]
            # What has no bound is the farthest: then the others say nothing.
            self._ways[source, passed] = max(ways or [((source,), self._sum_way(source, ()))], key=_rank_age)
        return self._ways[source, passed]

    def _list_ways(self, source: str, reader: str) -> Iterator[tuple[Arc, ...]]:
        """Yield the arcs of the shortest way from each sensor to an activity, past a reader; none where it is one itself."""
        leaving: dict[str, Arc | None] = {source: None}
        waiting = deque([source])
        while waiting:
            current = waiting.popleft()
            arcs = self._feeding_arcs[current]
            if not arcs:
                yield tuple(_follow(leaving, current))
            for arc in arcs:
                if arc.source not in leaving and arc.source != reader:
                    leaving[arc.source] = arc
                    waiting.append(arc.source)

    def _list_feeding_arcs(self, name: str, edges: Mapping[str, frozenset[str]]) -> tuple[Arc, ...]:
        """Return what an activity works on: what fires it; where it works by its own clock, all that it reads."""
        activities = self.analysis.system.activities
        arcs = tuple(arc for arc in self.analysis.system.arcs_into.get(name, ()) if arc.role == "data")
        arcs = tuple(filter(self._network.steps.arrivals.fires_reader, arcs)) or arcs
        touching = edges.get(activities[name].node)
        if touching is None:
            return arcs
        # A sensor may be several nodes, of which the last one works on what the first one took.
        return tuple(arc for arc in arcs if touching & edges.get(activities[arc.source].node, frozenset()))

    def _sum_way(self, name: str, arcs: tuple[Arc, ...]) -> TimingValue:
        steps = self._network.steps
        parts = [self._network.start_response(arcs[0].source if arcs else name)]
        for arc in arcs:
            parts += (steps.link_latency(arc), steps.sampling_wait(arc), self._network.step_response(arc))
        return sum_bounds(parts)


def _follow(leaving: Mapping[str, Arc | None], name: str) -> Iterator[Arc]:
    """Yield the arcs of a way on from an activity, by the arc by which the way leaves each."""
    arc = leaving[name]
    while arc is not None:
        yield arc
        arc = leaving[arc.target]


def _find_edge_components(architecture: Architecture) -> dict[str, frozenset[str]]:
    """Return the components that sense or move something outside of the architecture, by each node that implements some."""
    edges = frozenset(
        component.id
        for component in architecture.components.values()
        if any(port.external for port in component.inputs.values())
        or any(port.external for port in component.outputs.values())
    )
    return {node.id: found for node in architecture.nodes.values() if (found := edges.intersection(node.implements))}


def _rank_age(found: tuple[tuple[str, ...], TimingValue]) -> tuple[bool, Fraction]:
    age = found[1]
    return not is_known_bound(age), age.value or Fraction(0)
