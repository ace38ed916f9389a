"""What an element takes in and gives out: how often and how old it comes, how it is read, and which deadlines rest on it."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.timing.analysis import Analysis, ChainResult, EdgeFit, EventPace
from archgen.timing.chains.chain_regions import lay_out_chain
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.extreme_paths import find_extreme_path
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import is_known_bound, sum_bounds
from archgen.timing.system.timing_system import Arc


@dataclass(frozen=True, slots=True)
class ElementFlow:
    """What passes along an arc; times in ns.

    `age` is that of the data where it arrives, since the work began that gives it; `wait` passes until it is read.
    `since_sensing` is its age on arrival since the farthest sensor took it, along `way` (activities, the reader last).
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
    rests, along `through`: what a chain would say.
    """

    flow: ElementFlow
    through: tuple[str, ...]
    duration: TimingValue


class FlowFinder:
    """Finds what elements take in and give out; what it has found out once, it remembers."""

    def __init__(self, analysis: Analysis, architecture: Architecture, chains: Iterable[ChainResult]) -> None:
        """Index the steps of chains with a deadline, and how the ends of arcs fit together."""
        self.analysis = analysis
        self._edge_nodes = frozenset(_list_edge_nodes(architecture))
        self._network = CostNetwork.of_analysis(analysis)
        self._elements = self._network.index_elements(architecture)
        self._fits: Mapping[Arc, EdgeFit] = {fit.arc: fit for fit in analysis.edges}
        self._chains_by_step: dict[tuple[str, str], list[ChainResult]] = {}
        for chain in chains:
            names = [term.activity for term in chain.terms] if chain.deadline or chain.shares else []
            for step in itertools.pairwise(names):
                self._chains_by_step.setdefault(step, []).append(chain)
        self._ways: dict[tuple[str, str], tuple[tuple[str, ...], TimingValue]] = {}

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
            if flow.chains or flow.arc.role != "data" or len(flow.way) < 2:  # noqa: PLR2004 - a sensor and a reader
                continue
            nodes = (self.analysis.system.activities[name].node for name in flow.way)
            points = self._elements.resolve_points([Waypoint("node", node) for node in nodes])
            longest = find_extreme_path(self._network, lay_out_chain(self._network, points), "bound")
            if longest is not None:
                yield UnjudgedWay(flow, flow.way, longest.value)

    def _describe(self, arc: Arc) -> ElementFlow:
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
        if (source, reader) not in self._ways:
            found = [
                ((*(arc.source for arc in arcs), source), self._sum_way(source, arcs))
                for arcs in self._list_ways(source, reader)
            ]
            # What has no bound is the farthest: then the others say nothing.
            self._ways[source, reader] = max(found or [((source,), self._sum_way(source, ()))], key=_rank_age)
        return self._ways[source, reader]

    def _list_ways(self, source: str, reader: str) -> Iterator[tuple[Arc, ...]]:
        """Yield the arcs of the shortest way from each sensor to an activity, past a reader; none where it is one itself.

        What fires an element is what it works on; one that works by its own clock works on all that it reads. Behind what
        touches the world itself, such as the driver of a motor that tells where it stands, nothing is asked any more.
        """
        system, fires_reader = self.analysis.system, self._network.steps.arrivals.fires_reader
        leaving: dict[str, tuple[Arc, ...]] = {source: ()}
        waiting = deque([source])
        while waiting:
            current = waiting.popleft()
            arcs = [arc for arc in system.arcs_into.get(current, ()) if arc.role == "data"]
            arcs = [arc for arc in arcs if fires_reader(arc)] or arcs
            if not arcs or system.activities[current].node in self._edge_nodes:
                yield leaving[current]
                continue
            for arc in arcs:
                if arc.source not in leaving and arc.source != reader:
                    leaving[arc.source] = (arc, *leaving[current])
                    waiting.append(arc.source)

    def _sum_way(self, name: str, arcs: tuple[Arc, ...]) -> TimingValue:
        steps = self._network.steps
        parts = [self._network.start_response(arcs[0].source if arcs else name)]
        for arc in arcs:
            parts += (steps.link_latency(arc), steps.sampling_wait(arc), self._network.step_response(arc))
        return sum_bounds(parts)


def _list_edge_nodes(architecture: Architecture) -> Iterator[str]:
    """Yield the nodes of components that sense or move something outside of the architecture."""
    for node in architecture.nodes.values():
        components = [architecture.components[name] for name in node.implements if name in architecture.components]
        inputs = (port.external for each in components for port in each.inputs.values())
        if any(inputs) or any(port.external for each in components for port in each.outputs.values()):
            yield node.id


def _rank_age(found: tuple[tuple[str, ...], TimingValue]) -> tuple[bool, Fraction]:
    age = found[1]
    return not is_known_bound(age), age.value or Fraction(0)
