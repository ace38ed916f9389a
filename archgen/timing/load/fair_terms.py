"""How figures come about on cores that are shared fairly: A, a thread's own work, and what others are served before it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.load.busy_windows import find_blocked_time
from archgen.timing.load.core_terms import OWN_JOBS
from archgen.timing.load.fair_shares import FairBound, FairSolver
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.work_terms import (
    CountFormulas,
    EventCount,
    FigureWorking,
    ThreadShare,
    WorkTerm,
    add_last_step,
    choose_working,
    group_terms,
    shorten_working,
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
