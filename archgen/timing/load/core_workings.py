"""How a response on one core comes about: the work in its window, term by term, read off what the analysis found.

Each function offers the ways in which the analysis may have found a figure; the one that gives this very figure is it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from types import MappingProxyType

from archgen.frozen import dataclass
from archgen.timing.load.busy_windows import (
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    add_demands,
    find_worst_activation,
    longest_busy_period,
    subtract_demand,
)
from archgen.timing.load.core_responses import CoreSolver, LevelBound
from archgen.timing.load.event_streams import EventStreams, streams_of_calls
from archgen.timing.load.inner_core import urgency_of
from archgen.timing.load.last_step_workings import add_last_step
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.plain_core_workings import OWN_JOBS
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.run_ways import EntryWay, Priority
from archgen.timing.load.work_terms import (
    ONCE,
    CountFormulas,
    EventCount,
    FigureWorking,
    WorkTerm,
    add_counts,
    group_terms,
    multiply_count,
    shorten_working,
)


@dataclass(frozen=True, slots=True)
class InnerCoreWorkings:
    """How figures come about on a core on which activities fire one another; its solver has done its work."""

    solver: CoreSolver
    state: PropagationState
    formulas: CountFormulas
    _budget: SearchBudget = field(default_factory=SearchBudget)

    def list_responses(self, name: str) -> Iterator[FigureWorking]:
        """Yield how the response of an activity may have been found."""
        return self.list_way_responses(name, self.state.ways_to.get(name, ()))

    def list_way_responses(self, name: str, ways: Iterable[EntryWay]) -> Iterator[FigureWorking]:
        """Yield how the response of an activity may have been found, with what is known of the ways to it."""
        yield from self._list_step_responses(name)
        for way in ways:
            yield from (shorten_working(working, way.best_before) for working in self.list_delays(name, way))

    def _list_step_responses(self, name: str) -> Iterator[FigureWorking]:
        """Yield what bounds the response of an activity, whatever may be known of the steps before it."""
        solver, core = self.solver, self.solver.core
        thread = core.thread_of[name]
        bound = solver.bounds[thread.lowest_priority]
        ways = core.ways_to[name]
        if bound.busy_period is None:
            return
        start_costs = tuple(
            (each, cost)
            for each in thread.unit
            if each in core.inner_triggers.silent_ids and (cost := core.system.activities[each].wcet)
        )
        if start_costs:
            yield self._add_start(bound, start_costs)
        if thread.lowest_priority is not None and len(thread.unit) == 1 and thread.in_order:
            streams = self._activation_streams(ways, bound)
            if streams:
                lead = min(way.best_before for way in ways)
                yield from self._by_activation(name, streams, bound, lead, ())
        yield self._whole_period(name, thread.lowest_priority, ())
        if len(ways) == 1:
            yield from (shorten_working(each, ways[0].best_before) for each in self._list_run_delays(name, ways[0]))

    def list_delays(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield how the longest time of a way may have been found, from the event on to the end of an activity."""
        yield from self._list_run_delays(name, way)
        if len(way.steps) > 1:
            yield from self._add_last_step(name, way)

    def _list_run_delays(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield what bounds all steps of a way at once."""
        core = self.solver.core
        level: Priority = min((core.thread_of[step].lowest_priority for step in way.steps), key=urgency_of)
        bound = self.solver.bounds[level]
        if bound.busy_period is not None:
            if level is not None and len(core.thread_of[name].unit) == 1 and way.entry in bound.demand.level.volumes:
                streams = self._activation_streams((way,), bound)
                if streams:
                    yield from self._by_activation(name, streams, bound, 0, way.steps)
            yield self._whole_period(name, level, way.steps)

    def _add_last_step(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        before = way.steps[-2]
        yield from add_last_step(
            way,
            self.state.ways_to[before],
            self.state.responses[name].value,
            lambda way_before: self.list_delays(before, way_before),
            lambda _: self._list_step_responses(name),
        )

    def _activation_streams(self, ways: Sequence[EntryWay], bound: LevelBound) -> EventStreams:
        """Return the events that lead to an activity; empty where these are not all known at the level."""
        streams: EventStreams = ()
        for way in ways:
            if way.entry.kind in {"gate", "once"} or not bound.demand.level.volumes.get(way.entry):
                return ()
            streams += streams_of_calls(bound.demand.streams_of(way.entry), Fraction(way.multiplicity))
        return streams

    def _by_activation(
        self, name: str, streams: EventStreams, bound: LevelBound, lead: int, steps: tuple[str, ...]
    ) -> Iterator[FigureWorking]:
        cost = self.solver.core.system.activities[name].wcet
        if not cost:
            return
        own_work = ActivityWork(cost, streams)
        interference = subtract_demand(bound.demand.demand_function(), GrowingLoad((own_work,)).demand_function())
        try:
            activation = find_worst_activation(own_work, interference, self._budget, bound.busy_period or 0)
        except DivergedError:
            return
        count, arrival, finish = activation
        own_term = WorkTerm(((name, cost),), EventCount(count, str(count)), "its own")
        terms = group_terms([own_term, *self._list_terms(bound, finish, name)])
        yield FigureWorking(max(finish - arrival - lead, 0), finish, terms, count, arrival, lead, steps)

    def _whole_period(
        self, name: str, level: Priority, steps: tuple[str, ...], *, is_hold: bool = False
    ) -> FigureWorking:
        """Return the busy period of a level, for what takes no time with what comes at its very end."""
        closing_tick = int(is_hold or not self.solver.core.system.activities[name].wcet)
        bound = self.solver.bounds[level]
        window = (self.solver.find_wait_for_turn(level) if closing_tick else bound.busy_period) or 0
        terms = group_terms(self._list_terms(bound, window + closing_tick))
        return FigureWorking(window, window, terms, steps=steps, is_hold=is_hold)

    def _add_start(self, bound: LevelBound, start_costs: tuple[tuple[str, int], ...]) -> FigureWorking:
        start_work = sum(cost for _, cost in start_costs)
        demand = add_demands(bound.demand.demand_function(), DemandFunction(lambda _: start_work))
        window = longest_busy_period(demand, self._budget, bound.busy_period or 0)
        terms = [*self._list_terms(bound, window), WorkTerm(start_costs, ONCE, "at the start")]
        return FigureWorking(window, window, group_terms(terms))

    def list_holds(self, name: str, hold: int) -> Iterator[FigureWorking]:
        """Yield what may hold up the storing of an activity's inputs for so long."""
        level = self.solver.core.thread_of[name].lowest_priority
        bound = self.solver.bounds[level]
        origin = EventOrigin("activity", name)
        streams = self._streams_of(bound, origin)
        if name in self.solver.core.inner_triggers.entry_ids and streams:
            own_jobs = {origin: self.formulas.count_held_jobs(streams, hold)}
            terms = group_terms(self._list_terms(bound, hold, own_counts=own_jobs))
            yield FigureWorking(hold, hold, terms, is_hold=True)
        yield self._whole_period(name, level, (), is_hold=True)

    def _list_terms(
        self,
        bound: LevelBound,
        window: int,
        but_name: str = "",
        own_counts: Mapping[EventOrigin, EventCount] = MappingProxyType({}),
    ) -> Iterator[WorkTerm]:
        """Yield the work of a level in a window (in ticks), but that of `but_name`; of own jobs so much is counted."""
        counts = dict(own_counts)
        for name, activations in bound.demand.level.activations.items():
            cost = self.solver.core.system.activities[name].wcet
            for origin, multiplicity in activations.items() if cost and name != but_name else ():
                if origin not in counts:
                    counts[origin] = self._count_origin(bound, origin, window)
                reason = OWN_JOBS if origin in own_counts else self._describe_origin(origin)
                yield WorkTerm(((name, (cost or 0) * multiplicity),), counts[origin], reason)

    def _count_origin(self, bound: LevelBound, origin: EventOrigin, window: int) -> EventCount:
        if origin.kind == "once":
            return ONCE
        if origin.kind != "gate":
            return self.formulas.count_events(self._streams_of(bound, origin), window)
        rule = bound.demand.level.gate_rules[int(origin.key)]
        inputs = [
            add_counts(
                [
                    multiply_count(self._count_origin(bound, each, window), number)
                    for each, number in multiplicities.items()
                ]
            )
            for multiplicities in rule.inputs
        ]
        return self.formulas.count_gate(rule, inputs, window)

    def _streams_of(self, bound: LevelBound, origin: EventOrigin) -> EventStreams:
        try:
            return bound.demand.streams_of(origin)
        except KeyError:  # what brings no work has not been looked up
            return ()

    def _describe_origin(self, origin: EventOrigin) -> str:
        if origin.kind == "arc":
            arc = self.solver.core.entering_arcs[int(origin.key)].arc
            return f"events of {arc.topic} from {arc.source}"
        if origin.kind == "activity":
            return f"events of {origin.key}"
        return (
            "what less urgent work may have fired just before" if origin.kind == "once" else "events that get through"
        )
