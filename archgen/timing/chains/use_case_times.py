"""How long the steps of use cases take: the same terms as those of chains, step by step and in sum.

A step between two components costs the link, the wait until the reader takes it, and its response. Whoever begins by itself
adds what the first element of a chain adds: its wait and its response. What actors do outside takes no time here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.diagnostics.source_span import Span
from archgen.frozen import NamedTuple, dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.model.component import Component
from archgen.model.quantity import Quantity
from archgen.model.step_connections import ConnectedStep, UseCaseSteps
from archgen.timing.analysis import Analysis
from archgen.timing.chains import chain_regions
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.element_index import ElementIndex
from archgen.timing.chains.extreme_paths import find_extreme_path
from archgen.timing.chains.path_search import RouteRegion, find_paths
from archgen.timing.figures.timing_values import (
    ZERO_VALUE,
    TimingValue,
    is_boundless,
    is_known_bound,
    largest_value,
    sum_bounds,
    unknown_value,
)
from archgen.timing.system.timing_system import Arc


@dataclass(frozen=True, slots=True)
class UseCaseTimes:
    """How long the steps of a use case take at most, in ns, in their order, and all of them together.

    The whole may take less than the sum: what runs one after the other on a core waits for others only once.
    None stands for a step that takes no time of the architecture's: between actors, within one component, or to an actor
    from whoever has just reacted; and for one that runs along nothing.
    """

    steps: tuple[TimingValue | None, ...]
    total: TimingValue


def bound_use_cases(analysis: Analysis, architecture: Architecture) -> dict[str, UseCaseTimes]:
    """Return the times of all use cases with steps, by id. What they have in common is computed once."""
    steps_by_use_case = UseCaseSteps(architecture).by_use_case
    if not steps_by_use_case:
        return {}
    ends = dict.fromkeys(
        end.participant
        for steps in steps_by_use_case.values()
        for each in steps
        for end in (each.step.source, each.step.target)
        if end.kind in {"component", "output"}
    )
    points = ElementIndex(analysis.system, architecture).resolve_points([Waypoint("component", name) for name in ends])
    activities = {name: point.activities for name, point in zip(ends, points, strict=True)}
    arcs_by_port: dict[str, list[int]] = defaultdict(list)
    for index, arc in enumerate(analysis.system.arcs):
        # What is sent is known by its output; a request by that of the server, which it leads to.
        arcs_by_port[arc.input if arc.role == "request" else arc.output].append(index)
    # Either view bounds the whole; each step by itself is bounded by its own response.
    network, *run_views = CostNetwork.of_analysis(analysis).list_views()
    times: dict[str, UseCaseTimes] = {}
    for use_case_id, steps in steps_by_use_case.items():
        own_times = _StepClock(network, activities, arcs_by_port).time_steps(steps)
        run_totals = (_StepClock(view, activities, arcs_by_port).time_steps(steps).total for view in run_views)
        times[use_case_id] = UseCaseTimes(own_times.steps, min((own_times.total, *run_totals), key=_rank_total))
    return times


def _rank_total(total: TimingValue) -> tuple[bool, bool, Fraction]:
    """Return the sort key of several bounds of one use case: known ones first, the smallest before others."""
    return is_boundless(total), not is_known_bound(total), total.value or Fraction(0)


class _StepClock:
    """Goes through the steps of one use case, and knows which activities have reacted so far."""

    def __init__(
        self, network: CostNetwork, activities: Mapping[str, Sequence[str]], arcs_by_port: Mapping[str, Sequence[int]]
    ) -> None:
        self._network = network
        self._activities = activities
        self._arcs_by_port = arcs_by_port
        self._reached: dict[str, dict[str, None]] = {}
        """By component, the activities that have reacted last."""

    def time_steps(self, steps: Sequence[ConnectedStep]) -> UseCaseTimes:
        """Return the time of each step, and their sum."""
        values = tuple(self._time_step(each) for each in steps)
        return UseCaseTimes(values, sum_bounds(value for value in values if value is not None))

    def _time_step(self, connected: ConnectedStep) -> TimingValue | None:
        source, target = connected.step.source, connected.step.target
        if not connected.connections:
            return None
        if source.kind == "actor":
            return self._enter(target.participant, {each.input for each in connected.connections})
        if target.kind == "actor":
            value = self._leave(source.participant, self._find_senders(source.participant, connected))
            return None if value is ZERO_VALUE else value
        return self._pass_on(source.participant, target.participant, connected)

    def _enter(self, component_id: str, inputs: set[str | None]) -> TimingValue:
        """Return how long a component takes to react to what comes from outside."""
        system = self._network.steps.analysis.system
        members = self._activities[component_id]
        entered = [name for name in members if not inputs.isdisjoint(system.external_inputs.get(name, ()))] or members
        self._reached[component_id] = dict.fromkeys(entered)
        if not entered:
            return unknown_value(component_id)
        return largest_value(self._start_value(name) for name in entered)

    def _pass_on(self, sender: str, reader: str, connected: ConnectedStep) -> TimingValue:
        """Return how long it takes until a component has reacted to what another one sends."""
        arcs = list(self._list_arcs(sender, reader, connected))
        if not arcs:
            self._reached[reader] = dict.fromkeys(self._activities[reader])
            return unknown_value(reader)
        before = {name: self._leave(sender, [name]) for name in dict.fromkeys(arc.source for arc in arcs)}
        self._reached[reader] = dict.fromkeys(arc.target for arc in arcs)
        return largest_value(sum_bounds((before[arc.source], *self._step_costs(arc))) for arc in arcs)

    def _list_arcs(self, sender: str, reader: str, connected: ConnectedStep) -> Iterator[Arc]:
        senders, readers = frozenset(self._activities[sender]), frozenset(self._activities[reader])
        for output in dict.fromkeys(each.output for each in connected.connections):
            for index in self._arcs_by_port.get(output or "", ()):
                arc = self._network.arcs[index]
                if arc.source in senders and arc.target in readers:
                    yield arc

    def _find_senders(self, component_id: str, connected: ConnectedStep) -> Sequence[str]:
        """Return the activities that give something to the outside; those of the component where nobody says which."""
        system = self._network.steps.analysis.system
        outputs = {each.output for each in connected.connections}
        members = self._activities[component_id]
        return [name for name in members if not outputs.isdisjoint(system.activities[name].outputs)] or members

    def _leave(self, component_id: str, senders: Iterable[str]) -> TimingValue:
        """Return what passes in a component until one of these activities sends, since the step before has ended.

        Nothing (`ZERO_VALUE`, the very object) where they are what has reacted; else the way inside, or a new beginning.
        """
        reached = self._reached.get(component_id, {})
        values = [self._leave_by(component_id, name, reached) for name in senders if name not in reached]
        return largest_value(values) if values else ZERO_VALUE

    def _leave_by(self, component_id: str, name: str, reached: Mapping[str, None]) -> TimingValue:
        inner_way = self._bound_inner_way(component_id, reached, name) if reached else None
        if inner_way is not None:
            return inner_way
        return unknown_value(name) if reached else self._start_value(name)

    def _bound_inner_way(self, component_id: str, reached: Iterable[str], name: str) -> TimingValue | None:
        """Return the longest way inside of a component to an activity; None where there is none."""
        network, vertex_of = self._network, self._network.vertex_of
        graph, start_costs = network.cost_graph("bound")
        route = (
            RouteRegion(frozenset(vertex_of[each] for each in reached), inside=False),
            RouteRegion(frozenset(vertex_of[each] for each in self._activities[component_id]), optional=True),
            RouteRegion(frozenset({vertex_of[name]}), inside=False),
        )
        path = next(find_paths(graph, [0] * len(start_costs), route, longest=True).best_paths(), None)
        if path is None:
            return None
        return sum_bounds(cost for index in path.arcs for cost in self._step_costs(network.arcs[index]))

    def _start_value(self, name: str) -> TimingValue:
        return sum_bounds(self._network.start_costs(name, "bound"))

    def _step_costs(self, arc: Arc) -> tuple[TimingValue, ...]:
        return self._network.step_costs(arc, "bound")


LIMIT_KEYS = ("deadline", "response")
"""The keys of a composed component's `timing` that say how long it may take."""


class WholeLimit(NamedTuple):
    """How long (ns) a composed component may take, as it says itself; `name` is the key, or the indicator's title."""

    name: str
    duration: Quantity
    at: Span


class WholeBound(NamedTuple):
    """The worst way through a composed component: its activities, and how long it takes (ns)."""

    through: tuple[str, ...]
    duration: TimingValue


def list_limits(shell: Component) -> Iterator[WholeLimit]:
    """Yield what a composed component says of how long it takes."""
    for key in LIMIT_KEYS:
        limit: Quantity | None = getattr(shell.timing, key, None)
        if shell.timing and limit:
            yield WholeLimit(key, limit, shell.timing.places[key])
    for indicator in shell.performance:
        if indicator.execution_time:
            yield WholeLimit(indicator.title, indicator.execution_time, indicator.at)


def bound_wholes(analysis: Analysis, architecture: Architecture) -> dict[str, WholeBound]:
    """Return the worst ways through those composed components that say how long they take."""
    shells = [shell for shell in architecture.shells.values() if next(list_limits(shell), None)]
    if not shells:
        return {}
    network = CostNetwork.of_analysis(analysis)
    waypoints = [Waypoint("component", shell.id) for shell in shells]
    bounds = {}
    for shell, point in zip(shells, network.index_elements(architecture).resolve_points(waypoints), strict=True):
        # From the activation on, as a deadline counts: the bound of a chain also has the wait of the first sample.
        extreme_path = find_extreme_path(network, chain_regions.lay_out_chain(network, (point,)), "reduced reaction")
        if extreme_path is not None:
            view, path, duration = extreme_path
            through = (view.names[path.start], *(view.arcs[arc_index].target for arc_index in path.arcs))
            bounds[shell.id] = WholeBound(through, duration)
    return bounds
