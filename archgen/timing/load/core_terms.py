"""How figures on one core come about: the windows that its solvers found, term by term.

On cores that are shared fairly: A, a thread's own work, and what others are served before it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType

from archgen.frozen import dataclass
from archgen.timing.load.busy_windows import find_blocked_time
from archgen.timing.load.core_responses import CoreSolver, LevelBound, LevelWindow, name_way
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.fair_shares import FairBound, FairSolver
from archgen.timing.load.level_cascades import EntryWay, EventOrigin
from archgen.timing.load.queue_orders import QueueBound, QueueShare
from archgen.timing.load.thread_work import CoreWindow, ThreadWork
from archgen.timing.load.waiting_threads import WaitingWindow
from archgen.timing.load.work_terms import (
    ONCE,
    CountFormulas,
    EventCount,
    FigureWorking,
    ThreadShare,
    WorkTerm,
    add_counts,
    add_last_step,
    choose_working,
    describe_origin,
    group_terms,
    multiply_count,
    shorten_working,
)
from archgen.timing.system.timing_system import TimingSystem

OWN_JOBS = "its own jobs before the one that comes too soon"


def explain_core_window(window: CoreWindow, name: str, formulas: CountFormulas) -> FigureWorking:
    """Return how a window comes about in which each activity of a core is looked at by itself."""
    thread, (count, arrival, finish) = window.thread, window.worst
    own_works = dict(zip(thread.unit, thread.works, strict=True))
    if count and own_works[name].streams:
        own_term = WorkTerm(((name, own_works[name].cost),), EventCount(count, str(count)), "its own")
        # What takes no time waits for what comes at the very end as well: a tick more has it.
        closing_tick = 0 if own_works[name].cost else 1
        terms = [own_term, *_count_threads(formulas, window.list_others(), finish + closing_tick)]
        return FigureWorking(finish - arrival, finish, group_terms(terms), count, arrival)
    # What works only at the start has no events, but takes its own time.
    start_costs = [(each, work.cost) for each, work in own_works.items() if not work.streams]
    terms = [
        *_count_threads(formulas, (thread, *window.list_others()), finish + int(thread.takes_no_time)),
        WorkTerm(tuple(start_costs), ONCE, "at the start"),
    ]
    return FigureWorking(finish, finish, group_terms(terms))


def explain_core_hold(window: CoreWindow, name: str, hold: int, formulas: CountFormulas) -> FigureWorking:
    """Return what holds up the storing of an activity's inputs for so long, on such a core."""
    terms = [
        WorkTerm(((name, work.cost),), formulas.count_held_jobs(work.streams, hold), OWN_JOBS)
        for each, work in zip(window.thread.unit, window.thread.works, strict=True)
        if each == name
    ]
    terms += [
        term
        for term in _count_threads(formulas, (window.thread, *window.list_others()), hold)
        if all(each != name for each, _ in term.parts)
    ]
    return FigureWorking(hold, hold, group_terms(terms), is_hold=True)


def _count_threads(formulas: CountFormulas, threads: Iterable[ThreadWork], window: int) -> Iterator[WorkTerm]:
    for thread in threads:
        for name, work in zip(thread.unit, thread.works, strict=True):
            if work.streams and work.cost:
                yield WorkTerm(((name, work.cost),), formulas.count_events(work.streams, window))


def explain_waiting_window(window: WaitingWindow, system: TimingSystem, formulas: CountFormulas) -> FigureWorking:
    """Return how a window comes about in which a thread keeps waiting for resources: its work and waits, and the others'."""
    (own_ids, works, rivals_of), interference, (count, arrival, finish) = window
    looked_at = finish + int(any(not work.cost for work in works))
    terms: list[WorkTerm] = []
    for name, work in zip(own_ids, works, strict=True):
        activity = system.activities[name]
        cost, waits = activity.wcet or 0, "/".join([*activity.uses, *(["waiting"] if activity.wait else [])])
        events = EventCount(count, str(count)) if count else formulas.count_events(work.streams, looked_at)
        reason = f"{waits} {'alone' if rivals_of else 'with all of others that may come first'}" if waits else ""
        terms.append(WorkTerm(((name, cost), (waits, work.cost - cost)), events if work.streams else ONCE, reason))
    for resource_id, rivals in rivals_of.items():
        for each in rivals.competitors:
            events = formulas.count_events(each.streams, looked_at + each.response)
            terms.append(WorkTerm(((each.name, each.worst),), events, f"at {resource_id}, pending ones included"))
    if interference.list_served:
        reason = "served before it: no more than its own work and a lead for each wait, nor than it has to do"
        terms += [WorkTerm(((name, served),), ONCE, reason) for name, served in interference.list_served(looked_at)]
    terms += _count_threads(formulas, interference.mates, looked_at)
    beside = group_terms(_count_threads(formulas, interference.threads, looked_at))
    core_count = interference.core_count
    if core_count == 1:
        return FigureWorking(finish - arrival, finish, group_terms([*terms, *beside]), count, arrival)
    works_beside = [(each.unit, _count_work(each, looked_at)) for each in interference.threads]
    return FigureWorking(
        finish - arrival,
        finish,
        group_terms(terms),
        count,
        arrival,
        core_count=core_count,
        blocked_time=-(-sum(work for _, work in works_beside) // core_count),
        beside_terms=beside,
        shares=tuple(ThreadShare(unit, work, work) for unit, work in works_beside if work),
    )


def _count_work(thread: ThreadWork, window: int) -> int:
    return sum(work.cost * max_arrivals(work.streams, window) for work in thread.works)


def explain_queue_bound(bound: QueueBound, formulas: CountFormulas) -> FigureWorking:
    """Return how a response comes about in a queue whose order is written."""
    terms = group_terms(_count_share(share, formulas) for share in bound.shares)
    return FigureWorking(bound.response, bound.finish, terms, arrival=bound.arrival, is_queue=True)


def _count_share(share: QueueShare, formulas: CountFormulas) -> WorkTerm:
    parts, until = ((share.task.name, share.work),), share.until
    if until is None:
        return WorkTerm(parts, EventCount(share.number, str(share.number)), share.reason)
    if until < 0:  # a closed window that ends before it begins
        return WorkTerm(parts, EventCount(0, "0"))
    reason = f"those that come until {formulas.write_duration(until)}"
    return WorkTerm(parts, formulas.count_until(share.task.streams, until), reason)


@dataclass(frozen=True, slots=True)
class CoreTerms:
    """How figures come about on a core on which activities fire one another; its solver has done its work."""

    solver: CoreSolver
    formulas: CountFormulas

    def list_responses(self, name: str, ways: Iterable[EntryWay]) -> Iterator[FigureWorking]:
        """Yield what bounds the response of an activity, also by the ways to it."""
        yield from self._list_own(name)
        for way in ways:
            yield from (shorten_working(working, way.best_before) for working in self.list_delays(way))

    def list_delays(self, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield what bounds the longest time of a way, from the event on to the end of an activity."""
        if len(way.steps) == 1:
            yield from self._list_own(way.steps[0], way.steps)
        for window in self.solver.way_windows.get(name_way(way), ()):
            yield self._explain_window(window, way.steps)

    def _list_own(self, name: str, steps: tuple[str, ...] = ()) -> Iterator[FigureWorking]:
        """Yield what bounds the response of an activity, whatever may be known of the steps before it."""
        yield from (self._explain_window(window, steps) for window in self.solver.windows.get(name, ()))

    def _explain_window(self, window: LevelWindow, steps: tuple[str, ...]) -> FigureWorking:
        bound, (count, arrival, finish), lead = self.solver.bounds[window.level], window.worst, window.lead
        if count:
            cost = self.solver.core.system.activities[window.name].wcet or 0
            terms = [WorkTerm(((window.name, cost),), EventCount(count, str(count)), "its own")]
            terms += self._list_terms(bound, finish, window.name)
        else:
            terms = [*self._list_terms(bound, finish + window.closing_tick)]
            terms.append(WorkTerm(window.start_costs, ONCE, "at the start"))
        value = max(finish - arrival - lead, 0)
        return FigureWorking(value, finish, group_terms(terms), count, arrival, lead, steps)

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
        window = self.solver.find_wait_for_turn(level) or 0
        yield FigureWorking(window, window, group_terms(self._list_terms(bound, window + 1)), is_hold=True)

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
        if origin.kind == "once":
            return "what less urgent work may have fired just before"
        return (
            "events that get through"
            if origin.kind == "gate"
            else describe_origin(origin, self.solver.core.entering_arcs)
        )


@dataclass(frozen=True, slots=True)
class FairTerms:
    """How the figures of fair shares come about, for all that was found in the end."""

    solver: FairSolver
    formulas: CountFormulas

    def list_responses(self, name: str) -> Iterator[FigureWorking]:
        """Yield what bounds the response of an activity, also by the ways to it."""
        yield from self._list_own(name, (name,))
        for way in self.solver.found.ways_to.get(name, ()):
            yield from (shorten_working(working, way.best_before) for working in self.list_delays(way))

    def list_delays(self, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield what bounds the longest time of a way, from the event on to the end of an activity."""
        yield from self._list_own(way.steps[-1], way.steps)
        before = self.solver.find_way_before(way)
        response = self.solver.found.response_of[way.steps[-1]].value
        if before is not None and before.delay is not None and response is not None:
            first = choose_working(self.list_delays(before), before.delay)
            last = choose_working(self._list_own(way.steps[-1], way.steps[-1:]), response)
            yield from add_last_step(way.steps, first, last)

    def _list_own(self, name: str, steps: tuple[str, ...]) -> Iterator[FigureWorking]:
        """Yield the windows of a thread that bound an activity, or a run that does not leave the thread."""
        bound = self._find_bound(name)
        if bound is None or not all(step in bound.thread.unit for step in steps):
            return
        count, arrival, finish = bound.worst
        if count:
            own_term = WorkTerm(((name, bound.own_works[0].cost),), EventCount(count, str(count)), "its own")
            yield replace(
                self._explain(bound, [own_term], finish), value=finish - arrival, activation=count, arrival=arrival
            )
        closing_tick = int(any(not work.cost for work in bound.own_works))
        yield self._explain(bound, self._count_own(bound, bound.window + closing_tick), bound.window)

    def _find_bound(self, name: str) -> FairBound | None:
        thread = next((each for each in self.solver.cores.threads if name in each.unit), None)
        return self.solver.find_bound(thread) if thread else None

    def _count_own(self, bound: FairBound, window: int) -> list[WorkTerm]:
        works = zip(bound.thread.own_ids, bound.own_works, strict=True)
        return [
            WorkTerm(((name, work.cost),), self.formulas.count_events(work.streams, window)) for name, work in works
        ]

    def list_holds(self, name: str, hold: int) -> Iterator[FigureWorking]:
        """Yield what may hold up the storing of an activity's inputs for so long."""
        bound = self._find_bound(name)
        if bound is not None:
            terms, number = self._count_own(bound, hold), bound.thread.own_ids.index(name)
            count = self.formulas.count_held_jobs(bound.own_works[number].streams, hold)
            terms[number] = WorkTerm(terms[number].parts, count, OWN_JOBS)
            yield replace(self._explain(bound, terms, hold), is_hold=True)

    def _explain(self, bound: FairBound, own_terms: Sequence[WorkTerm], window: int) -> FigureWorking:
        """Return a window with what the thread does in it itself, and what is served before it."""
        looked_at = window + int(any(not work.cost for work in bound.own_works))
        counts = [term.events.number for term in own_terms]
        block = self.solver.find_block(bound.thread, bound.own_works, counts, bound.others, looked_at)
        beside_terms = [
            WorkTerm(((name, work.cost),), self.formulas.count_events(work.streams, looked_at), "pending ones included")
            for _, lanes in bound.others.groups
            for lane in lanes
            for name, work in lane.works
        ]
        is_served = block.served <= block.blocked
        shares = self._share_served(bound, block.cut, looked_at) if is_served else self._share_blocked(bound, looked_at)
        return FigureWorking(
            window,
            window,
            group_terms(own_terms),
            core_count=self.solver.cores.core_count,
            blocked_time=min(block.served, block.blocked),
            beside_terms=group_terms(beside_terms),
            shares=tuple(each for each in shares if each.work),
            leads=(self.solver.cores.lead,) * block.leads if is_served else (),
        )

    def _share_served(self, bound: FairBound, cut: int, window: int) -> Iterator[ThreadShare]:
        """Yield what the threads of each process have to do, and how much of it is served before the thread."""
        for group, lanes in bound.others.groups:
            work = sum(lane.count_work(window) for lane in lanes)
            yield ThreadShare(tuple(name for unit in group.units for name in unit), work, group.cut_work(work, cut))

    def _share_blocked(self, bound: FairBound, window: int) -> Iterator[ThreadShare]:
        """Yield what each lane has to do, and how much of it keeps one of all cores busy."""
        lanes = [
            (unit, lane) for group, each in bound.others.groups for unit, lane in zip(group.units, each, strict=True)
        ]
        parts = [part for _, lane in lanes for part in lane.split_work(window)]
        limit = Fraction(*find_blocked_time(parts, 0, self.solver.cores.core_count))
        for unit, lane in lanes:
            counted = min(Fraction(lane.count_work(window)), limit * lane.width)
            yield ThreadShare(unit, lane.count_work(window), -(-counted // 1))
