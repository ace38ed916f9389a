"""How a response on several cores comes about: A in the threads of the path, and B with all cores busy beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.frozen import NamedTuple, dataclass, replace
from archgen.timing.load.busy_windows import DivergedError, SearchBudget, WorstActivation, find_blocked_time
from archgen.timing.load.core_paths import CorePath, SharedWork, WayWork, build_thread_work
from archgen.timing.load.core_terms import OWN_JOBS
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.idle_backlogs import IdleBacklog
from archgen.timing.load.level_cascades import EntryWay, EventOrigin
from archgen.timing.load.load_system import list_storing_ids
from archgen.timing.load.path_work import CoreBlock, split_lanes
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.shared_core_responses import SharedCoreSolver
from archgen.timing.load.work_terms import (
    ONCE,
    CountFormulas,
    EventCount,
    FigureWorking,
    ThreadShare,
    WorkTerm,
    add_last_step,
    choose_working,
    describe_origin,
    group_terms,
    shorten_working,
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


@dataclass(frozen=True, slots=True)
class SharedCoreTerms:
    """How figures come about on several cores; their solver has done its work."""

    solver: SharedCoreSolver
    state: PropagationState
    formulas: CountFormulas

    def list_responses(self, name: str) -> Iterator[FigureWorking]:
        """Yield how the response of an activity may have been found."""
        value = self.state.responses[name].value or 0
        yield from self._follow_path((name,), value)
        for way in self.solver.cores.ways_to[name]:
            workings = self._list_backlog(way)
            yield from (shorten_working(each, way.best_before) for each in workings)
        for way in self.state.ways_to.get(name, ()):
            if way.delay is not None and way.delay - way.best_before == value:
                yield from (shorten_working(working, way.best_before) for working in self.list_delays(name, way))

    def list_delays(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield how the longest time of a way may have been found, from the event on to the end of an activity."""
        yield from self._follow_path(way.steps, way.delay or 0)
        yield from self._list_backlog(way)
        if len(way.steps) > 1:
            yield from self._add_last_step(name, way)
        # A step has ended before the ones that it leads to: what bounds them bounds it.
        for later_ways in self.state.ways_to.values():
            for later_way in later_ways:
                if (
                    later_way.delay == way.delay
                    and later_way.entry == way.entry
                    and len(later_way.steps) > len(way.steps)
                    and later_way.steps[: len(way.steps)] == way.steps
                ):
                    yield from self._follow_path(later_way.steps, way.delay or 0)
                    yield from self._list_backlog(later_way)

    def _list_backlog(self, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield how what may be pending bounds a way."""
        if self.solver.limits.backlog is not None:
            yield from BacklogTerms(self.solver.limits.backlog, self.formulas).list_delays(way)

    def _add_last_step(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        """Yield the time of a way as a sum: of that of the way before, and of the response of the last step."""
        before, response = way.steps[-2], self.solver.step_responses.get(name)
        ways_before = (each for each in self.state.ways_to[before] if each.entry == way.entry)
        way_before = next((each for each in ways_before if each.steps == way.steps[:-1]), None)
        if way_before is None or way_before.delay is None or response is None:
            return
        if way_before.delay + response == way.delay:
            first = choose_working(self.list_delays(before, way_before), way_before.delay)
            yield from add_last_step(way.steps, first, choose_working(self._follow_path((name,), response), response))

    def _follow_path(self, steps: tuple[str, ...], value: int) -> Iterator[FigureWorking]:
        """Yield the window of a path that gives a figure: of each activation of its last step, where these are looked at."""
        path, spend = self.solver.paths.look_up(steps), SearchBudget().start_search()
        try:
            worst = self.solver.find_worst(path, spend, max(value, 1) + 1)
        except DivergedError:
            return
        if worst.response == value:
            yield self._explain_window(path, steps, worst)

    def list_holds(self, name: str, hold: int) -> Iterator[FigureWorking]:
        """Yield what may hold up the storing of an activity's inputs for so long."""
        if name in self.solver.cause_of:
            return
        for thread_id in (name, *list_storing_ids(self.solver.cores.system.activities[name])):
            path = self.solver.paths.look_up((thread_id,))
            if path.last_step is None:
                workings: Iterable[FigureWorking] = self._follow_path((thread_id,), hold)
                yield from (replace(working, is_hold=True) for working in workings)
            else:
                streams = self.solver.find_activation_streams(path.last_step)
                count = self.formulas.count_held_jobs(streams, hold)
                working = self._explain_window(path, (thread_id,), WorstActivation(count.number, 0, hold))
                own_term = WorkTerm(((thread_id, path.last_step.cost),), count, OWN_JOBS)
                own_terms = group_terms([own_term, *self._list_own_terms(path, hold)])
                yield replace(working, terms=own_terms, activation=0, is_hold=True)
            if self.solver.limits.backlog is not None:
                yield from BacklogTerms(self.solver.limits.backlog, self.formulas).list_holds(thread_id, hold)

    def _explain_window(self, path: CorePath, steps: tuple[str, ...], worst: WorstActivation) -> FigureWorking:
        count, arrival, window = worst
        terms = [*self._list_own_terms(path, window)]
        if path.last_step:
            terms.insert(0, WorkTerm(((steps[-1], path.last_step.cost),), EventCount(count, str(count)), "its own"))
        if path.own_cost:
            is_silent = steps[-1] in self.solver.cores.inner_triggers.silent_ids
            reason = "at the start" if is_silent else "its own, beside others of its kind"
            terms.append(WorkTerm(((steps[-1], path.own_cost),), ONCE, reason))
        block = self.solver.work.find_block(path, window)
        return FigureWorking(
            max(window - arrival, 0),
            window,
            group_terms(terms),
            count,
            arrival,
            steps=steps if len(steps) > 1 else (),
            core_count=self.solver.cores.core_count,
            blocked_time=block.time,
            beside_terms=group_terms(self._list_beside_terms(path, window, with_pending=block.has_pending)),
            shares=tuple(self._share_cores(path, block)),
            pending=block.pending,
        )

    def _list_own_terms(self, path: CorePath, window: int) -> Iterator[WorkTerm]:
        work, jobs = self.solver.work, self.solver.cores.jobs
        for number, way_before in path.own_jobs:
            delay = work.delays.get(way_before, 0) if way_before else 0
            yield self._count_job(number, window, delay)
        for numbers, threads in path.crowds:
            crowd_terms = [self._count_job(number, window, work.delays.get(jobs[number].key, 0)) for number in numbers]
            total = sum(term.total for term in crowd_terms)
            names = ", ".join(dict.fromkeys(jobs[number].key[0] for number in numbers))
            formula = " + ".join(
                f"({term.events.formula}) x {self.formulas.write_duration(term.parts[0][1])}"
                for term in crowd_terms
                if term.total
            )
            if total:
                reason = f"others in the container: ({formula}) / {threads}, as {threads} threads work side by side"
                yield WorkTerm(((names, -(-total // threads)),), ONCE, reason)

    def _list_beside_terms(self, path: CorePath, window: int, *, with_pending: bool) -> Iterator[WorkTerm]:
        work, jobs = self.solver.work, self.solver.cores.jobs
        for lane in path.other_lanes:
            for number in lane:
                delay = work.delays.get(jobs[number].key, 0) if with_pending else 0
                yield self._count_job(number, window, delay)

    def _count_job(self, number: int, window: int, delay: int) -> WorkTerm:
        """Count what comes of a job in a window, and may be pending for so long before it."""
        key, origin, work, _, _ = self.solver.cores.jobs[number]
        count = self.formulas.count_events(self.solver.work.streams[origin], window + delay)
        before = (
            f", those of {self.formulas.write_duration(delay)} before, which may be pending, included" if delay else ""
        )
        return WorkTerm(((key[0], work),), count, f"{describe_origin(origin, self.solver.cores.entering_arcs)}{before}")

    def _share_cores(self, path: CorePath, block: CoreBlock) -> Iterator[ThreadShare]:
        """Yield what the threads beside a path do, and how much of it counts."""
        works, limit = block.lane_works, None
        lane_parts = split_lanes(path, works) if block.is_cut else ()
        # As in `divide_among_cores`: where none has more to do than that, all of it counts.
        if max(lane_parts, default=0) > block.time:
            limit = Fraction(*find_blocked_time(lane_parts, 0, self.solver.cores.core_count))
        for lane, work, width in zip(path.other_lanes, works, path.lane_widths, strict=True):
            counted = Fraction(work) if limit is None else min(Fraction(work), limit * width)
            if work:
                yield ThreadShare(self.solver.cores.jobs[lane[0]].unit, work, -(-counted // 1))
