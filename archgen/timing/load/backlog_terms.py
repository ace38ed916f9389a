"""How a delay on several cores comes about that what may be pending bounds: A, and B with all cores busy."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from archgen.timing.load.busy_windows import DivergedError, WorstActivation
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.idle_backlogs import IdleBacklog
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.way_works import SharedWork, WayWork, build_thread_work
from archgen.timing.load.work_terms import (
    ONCE,
    CountFormulas,
    EventCount,
    FigureWorking,
    WorkTerm,
    describe_origin,
    group_terms,
)


class BacklogTerms(NamedTuple):
    """Explains the delays that a backlog gives."""

    backlog: IdleBacklog
    formulas: CountFormulas

    def list_delays(self, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield how the longest time of a way comes about."""
        backlog = self.backlog
        key = next((key for key in backlog.delays if self._is_way(key, way)), None)
        if key is None:
            return
        way_work = backlog.way_works[key]
        if backlog.worst_events[key].response == backlog.delays[key]:
            yield self._explain_window(way_work, way.steps, backlog.worst_events[key])

    def list_holds(self, name: str, hold: int) -> Iterator[FigureWorking]:
        """Yield how long the thread of an activity may have work all the time, if that is so long."""
        thread_work = build_thread_work(self.backlog.cores, name)
        try:
            window = self.backlog.find_busy_window(thread_work)
        except DivergedError:
            return
        if window == hold:
            yield self._explain_window(thread_work, (), WorstActivation(1, 0, window))

    def _is_way(self, key: tuple[str, int], way: EntryWay) -> bool:
        ways = self.backlog.cores.ways_to[key[0]]
        return ways[key[1]].steps == way.steps and ways[key[1]].entry == way.entry

    def _explain_window(self, way_work: WayWork, steps: tuple[str, ...], event: WorstActivation) -> FigureWorking:
        backlog, (ordinal, arrival, window) = self.backlog, event
        count = ordinal - 1
        own_terms = group_terms(self._list_own_terms(way_work, count, window))
        crowd_terms = group_terms(self._list_crowd_terms(way_work, window))
        own_work, thread_wait = (sum(term.total for term in terms) for terms in (own_terms, crowd_terms))
        events = max_arrivals(backlog.streams.get(way_work.origin, ()), window)
        return FigureWorking(
            window - arrival,
            window,
            (*own_terms, *crowd_terms),
            ordinal,
            arrival,
            steps=steps if len(steps) > 1 else (),
            core_count=backlog.core_count,
            blocked_time=max(window - own_work - thread_wait, 0),
            beside_terms=group_terms(self._list_arriving(window)),
            pending=backlog.pending_work,
            pending_terms=tuple(self._list_pending()),
            unfinished=backlog.count_unfinished(way_work, count, events),
            thread_wait=thread_wait,
            is_backlog=True,
        )

    def _list_own_terms(self, way_work: WayWork, count: int, window: int) -> Iterator[WorkTerm]:
        yield WorkTerm(way_work.step_works, ONCE, "its own")
        if count:
            slowest = max(way_work.step_works, key=lambda pair: pair[1])
            yield WorkTerm((slowest,), EventCount(count, str(count)), "the slowest step, for each event before it")
        for shared_work in way_work.others:
            yield self._count_shared(shared_work, window)

    def _list_crowd_terms(self, way_work: WayWork, window: int) -> Iterator[WorkTerm]:
        core_count = self.backlog.core_count
        for members, threads in way_work.crowds:
            member_terms = [self._count_shared(member, window) for member in members]
            total = sum(term.total for term in member_terms)
            names = ", ".join(dict.fromkeys(term.parts[0][0] for term in member_terms if term.total))
            formula = " + ".join(
                f"({term.events.formula}) x {self.formulas.write_duration(term.parts[0][1])}"
                for term in member_terms
                if term.total
            )
            if total:
                reason = (
                    f"others in the container: ({formula}) x {core_count - threads} / ({threads} x {core_count}), as "
                    f"{threads} threads work, and not {core_count} cores"
                )
                waiting = -(-total * (core_count - threads) // (threads * core_count))
                yield WorkTerm(((names, waiting),), ONCE, reason)

    def _count_shared(self, shared_work: SharedWork, window: int) -> WorkTerm:
        origin, work, way_before = shared_work
        delay = self.backlog.delays[way_before] if way_before else 0
        name = next(job.key[0] for job in self.backlog.cores.jobs if job.origin == origin and job.work == work)
        count = self.formulas.count_events(self.backlog.streams[origin], window + delay)
        before = f", those of {self.formulas.write_duration(delay)} before included" if delay else ""
        return WorkTerm(((name, work),), count, f"{self._describe_origin(origin)}{before}")

    def _list_arriving(self, window: int) -> Iterator[WorkTerm]:
        for origin, streams in self.backlog.streams.items():
            parts = tuple((job.key[0], job.work) for job in self.backlog.cores.jobs if job.origin == origin)
            yield WorkTerm(parts, self.formulas.count_events(streams, window), self._describe_origin(origin))

    def _list_pending(self) -> Iterator[WorkTerm]:
        for share in self.backlog.pending_shares:
            if share.work:
                age = self.formulas.write_duration(share.age)
                reason = f"{self._describe_origin(share.origin)} that may be {age} old"
                if share.work == share.events * share.rest:
                    yield WorkTerm(((share.name, share.rest),), EventCount(share.events, str(share.events)), reason)
                else:
                    yield WorkTerm(((share.name, share.work),), ONCE, f"the rest of all {reason}")

    def _describe_origin(self, origin: EventOrigin) -> str:
        return describe_origin(origin, self.backlog.cores.entering_arcs)
