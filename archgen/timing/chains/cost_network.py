"""The costs of steps as whole numbers, so that paths through thousands of activities are compared exactly and fast."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import lcm
from typing import Literal

from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.latest_result import remember_latest
from archgen.timing.analysis import Analysis, RunResponse
from archgen.timing.chains.element_index import ElementIndex, MeasuredBasis
from archgen.timing.chains.path_search import CostGraph, Hop
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue, is_boundless, is_known_bound
from archgen.timing.system.timing_system import Arc

PathAim = Literal["bound", "reduced reaction", "reduced age", "best"]
"""What a path is extreme in: three kinds of longest paths, and `best`, the shortest one."""
_TIE_BITS = 24
"""Bits below the figures that break ties by how much is unknown: a path with gaps precedes an equal one without."""


@dataclass(frozen=True, slots=True)
class CostNetwork:
    """A system's activities as vertices, its arcs with their costs for each aim. Costs are computed on first use.

    Consecutive steps cost together what their run takes, of those in `runs`; all others each its own response. Each view
    (no runs, those on one core, those over hosts as well) bounds all paths, and each may be the smaller bound.
    """

    steps: StepDelays
    names: tuple[str, ...]
    vertex_of: dict[str, int]
    runs: Mapping[str, RunResponse] = field(default_factory=dict)
    _graphs: dict[PathAim, tuple[CostGraph, list[int]]] = field(default_factory=dict)
    _other_views: list[CostNetwork] = field(default_factory=list)
    _arcs_by_ends: dict[tuple[str, str], list[int]] = field(default_factory=dict)
    _indices: list[ElementIndex] = field(default_factory=list)
    _bases: list[MeasuredBasis] = field(default_factory=list)
    _arcs_of_output: dict[str, list[int]] = field(default_factory=dict)

    @classmethod
    def of_analysis(cls, analysis: Analysis) -> CostNetwork:
        """Prepare an analysis for questions about paths; the one that was asked of last is prepared already."""
        return _prepare_network(analysis)

    def list_views(self) -> tuple[CostNetwork, ...]:
        """Return this network, which has none, and its views with runs where there are some."""
        runs, host_runs = self.steps.analysis.runs, self.steps.analysis.host_runs
        if not self._other_views:
            self._other_views.extend(
                CostNetwork(self.steps, self.names, self.vertex_of, each)
                for each in ([runs] if runs else []) + ([{**runs, **host_runs}] if host_runs else [])
            )
        return (self, *self._other_views)

    @property
    def arcs(self) -> tuple[Arc, ...]:
        """Return the system's arcs; `Hop.arc` is an index into them."""
        return self.steps.analysis.system.arcs

    def list_parallel(self, arc_index: int) -> Sequence[int]:
        """Return the arcs that have the ends of an arc, itself among them."""
        if not self._arcs_by_ends:
            for index, each in enumerate(self.arcs):
                self._arcs_by_ends.setdefault((each.source, each.target), []).append(index)
        arc = self.arcs[arc_index]
        return self._arcs_by_ends[arc.source, arc.target]

    def index_elements(self, architecture: Architecture) -> ElementIndex:
        """Return what the elements of chains stand for in an architecture with this timing."""
        if not self._indices or self._indices[0].architecture is not architecture:
            self._indices[:] = [ElementIndex(self.steps.analysis.system, architecture)]
        return self._indices[0]

    def find_measured_basis(self) -> MeasuredBasis:
        """Return the measured execution times on which the figures of chains rest."""
        if not self._bases:
            self._bases.append(MeasuredBasis(self.steps.analysis))
        return self._bases[0]

    def list_arcs(self, output: str) -> Sequence[int]:
        """Return the arcs (as indices) by which data leaves by an output."""
        if not self._arcs_of_output:
            for arc_index, arc in enumerate(self.arcs):
                self._arcs_of_output.setdefault(arc.output, []).append(arc_index)
        return self._arcs_of_output.get(output, ())

    def cost_graph(self, aim: PathAim) -> tuple[CostGraph, list[int]]:
        """Return the graph with the costs of an aim, and what each vertex costs as a start."""
        if aim not in self._graphs:
            self._graphs[aim] = self._build_graph(aim)
        return self._graphs[aim]

    def start_costs(self, name: str, aim: PathAim) -> tuple[TimingValue, ...]:
        """Return what the first activity of a path adds."""
        if aim == "best":
            return (self.steps.response_value(name, worst=False),)
        return (self.steps.start_delay(name).value if aim == "bound" else ZERO_VALUE, self.start_response(name))

    def start_response(self, name: str) -> TimingValue:
        """Return what the response of a path's first activity adds."""
        return self.steps.run_response(name, self.runs)

    def step_response(self, arc: Arc) -> TimingValue:
        """Return what the response of an arc's reader adds."""
        return self.steps.added_response(arc, self.runs)

    def step_costs(self, arc: Arc, aim: PathAim) -> tuple[TimingValue, ...]:
        """Return what a step adds: link, sampling (or holding), response."""
        if aim == "best":
            return (self.steps.link_latency(arc, worst=False), self.steps.response_value(arc.target, worst=False))
        if aim != "reduced age":
            return (self.steps.link_latency(arc), self.steps.sampling_wait(arc), self.step_response(arc))
        holding_age = self.steps.holding_age(arc)
        # What is used again, with a later event of something else, is not used in the run that brought it.
        is_held = holding_age is not ZERO_VALUE
        response = self.start_response(arc.target) if is_held else self.step_response(arc)
        return (self.steps.link_latency(arc), holding_age, response)

    def _build_graph(self, aim: PathAim) -> tuple[CostGraph, list[int]]:
        starts = [self.start_costs(name, aim) for name in self.names]
        steps = [self.step_costs(arc, aim) for arc in self.arcs]
        weigh = _make_scale([*starts, *steps])
        hops: list[list[Hop]] = [[] for _ in self.names]
        for arc_index, (arc, costs) in enumerate(zip(self.arcs, steps, strict=True)):
            hops[self.vertex_of[arc.source]].append(Hop(self.vertex_of[arc.target], weigh(costs), arc_index))
        return hops, [weigh(costs) for costs in starts]


def has_gaps(cost: int) -> bool:
    """Whether a sum of costs has a figure in it that is not known."""
    return cost % (1 << _TIE_BITS) > 0


@remember_latest
def _prepare_network(analysis: Analysis) -> CostNetwork:
    names = tuple(analysis.system.activities)
    return CostNetwork(StepDelays.of_analysis(analysis), names, {name: vertex for vertex, name in enumerate(names)})


def _make_scale(rows: list[tuple[TimingValue, ...]]) -> Callable[[tuple[TimingValue, ...]], int]:
    """Return the function that turns figures into one whole number.

    What is boundless outweighs any sum of what is not; unknown figures count only where everything else is equal.
    """
    # By identity: step delays share their value objects, and hashing Fractions is slow. The rows keep the values alive,
    # so that no id is used twice.
    distinct = {id(value): value for row in rows for value in row}
    common_denominator = lcm(*(value.value.denominator for value in distinct.values() if value.value is not None))
    scaled_figures = {
        key: value.value.numerator * (common_denominator // value.value.denominator) if value.value is not None else 0
        for key, value in distinct.items()
    }
    # More than any sum of figures, ties included: a path visits each arc at most once.
    largest_sum = max((abs(number) for number in scaled_figures.values()), default=0) * sum(map(len, rows))
    boundless_weight = 1 << (largest_sum.bit_length() + _TIE_BITS + 1)
    weights = {
        key: boundless_weight
        if is_boundless(value)
        else (scaled_figures[key] << _TIE_BITS) + (0 if is_known_bound(value) else 1)
        for key, value in distinct.items()
    }
    # It knows the given values only: parts that were not in `rows` raise KeyError.
    return lambda parts: sum([weights[id(part)] for part in parts])
