"""What an element takes in and gives out: how often and how old it comes, how it is read, and which deadlines rest on it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.timing.analysis import Analysis, ChainResult, EdgeFit, EventPace
from archgen.timing.chains.chain_regions import lay_out_chain
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.extreme_paths import find_extreme_path
from archgen.timing.chains.sensing_ways import SensingWays
from archgen.timing.figures.timing_values import TimingValue, sum_bounds
from archgen.timing.system.timing_system import Arc

_LONGEST_CHAIN = 20


@dataclass(frozen=True, slots=True)
class ElementFlow:
    """What passes along an arc; times in ns.

    `age` is that of the data where it arrives, since the work began that gives it; `wait` passes until it is read.
    `since_sensing` is its age on arrival since the farthest sensor took it, along `way` (activities, the reader last; see `SensingWays`).
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
        self._elements = self._network.index_elements(architecture)
        self._fits: Mapping[Arc, EdgeFit] = {fit.arc: fit for fit in analysis.edges}
        self._chains_by_step: dict[tuple[str, str], list[ChainResult]] = {}
        for chain in chains:
            names = [term.activity for term in chain.terms] if chain.deadline or chain.shares else []
            for step in itertools.pairwise(names):
                self._chains_by_step.setdefault(step, []).append(chain)
        self._flows: dict[Arc, ElementFlow] = {}
        self._unjudged: dict[Arc, UnjudgedWay | None] = {}
        self._ways = SensingWays(self._network, architecture)

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
        way = self._ways.find_way(arc.source, arc.target)
        return ElementFlow(
            arc,
            self.analysis.outputs.get((arc.source, arc.output), EventPace(None)),
            sum_bounds((response, steps.link_latency(arc))),
            delay.value,
            delay.why,
            steps.arrivals.fires_reader(arc),
            self._fits.get(arc),
            sum_bounds((way.age, steps.link_latency(arc))),
            (*way.activities, arc.target),
            tuple(self._chains_by_step.get((arc.source, arc.target), ())),
        )
