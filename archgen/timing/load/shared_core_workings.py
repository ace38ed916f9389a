"""How a response on several cores comes about: A in the threads of the path, and B with all cores busy beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.load.backlog_workings import BacklogWorkings
from archgen.timing.load.busy_cores import find_blocked_time
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.core_paths import CorePath
from archgen.timing.load.event_streams import earliest_arrivals, max_arrivals
from archgen.timing.load.last_step_workings import add_last_step
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.load_system import list_storing_ids
from archgen.timing.load.path_work import split_lanes
from archgen.timing.load.plain_core_workings import OWN_JOBS
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_core_responses import SharedCoreSolver
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.load.work_terms import (
    CountFormulas,
    EventCount,
    FigureWorking,
    ThreadShare,
    WorkTerm,
    group_terms,
    shorten_working,
)


@dataclass(frozen=True, slots=True)
class SharedCoreWorkings:
    """How figures come about on several cores; their solver has done its work."""

    solver: SharedCoreSolver
    state: PropagationState
    formulas: CountFormulas
    responses: Mapping[str, WorstResponse]
    """What the solver found, before anything else limits it."""

    def _find_rest(self, name: str) -> SharedCoreWorkings | None:
        """Return how figures come about on the cores that full threads leave, where an activity has its bound there."""
        rest_solver = self.solver.rest_solver
        if rest_solver is None or name not in self.solver.cause_of or name not in rest_solver.cores.unit_of:
            return None
        return SharedCoreWorkings(rest_solver, self.state, self.formulas, self.responses)

    def _name_full_threads(
        self, rest: SharedCoreWorkings, workings: Iterable[FigureWorking]
    ) -> Iterator[FigureWorking]:
        left_ids = rest.solver.cores.unit_of
        full_ids = tuple(name for name in self.solver.cores.unit_of if name not in left_ids)
        yield from (replace(working, full_ids=(*full_ids, *working.full_ids)) for working in workings)

    def list_responses(self, name: str) -> Iterator[FigureWorking]:
        """Yield how the response of an activity may have been found."""
        if rest := self._find_rest(name):
            yield from self._name_full_threads(rest, rest.list_responses(name))
            return
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
        if rest := self._find_rest(name):
            yield from self._name_full_threads(rest, rest.list_delays(name, way))
            return
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
            yield from BacklogWorkings(self.solver.limits.backlog, self.formulas).list_delays(way)

    def _add_last_step(self, name: str, way: EntryWay) -> Iterator[FigureWorking]:
        before = way.steps[-2]
        yield from add_last_step(
            way,
            self.state.ways_to[before],
            self.solver.step_responses.get(name),
            lambda way_before: self.list_delays(before, way_before),
            lambda response: self._follow_path((name,), response),
        )

    def _follow_path(self, steps: tuple[str, ...], value: int) -> Iterator[FigureWorking]:
        """Yield the window of a path that gives a figure: of each activation of its last step, where these are looked at."""
        path, spend = self.solver.paths.look_up(steps), SearchBudget().start_search()
        try:
            if path.last_step is None:
                window = self.solver.find_window(path, 0, max(path.cost, 1), spend, None)
                if window == value:
                    yield self._explain_window(path, steps, 0, 0, window)
                return
            arrival_times = earliest_arrivals(self.solver.find_activation_streams(path.last_step))
            arrival, count, window = next(arrival_times, 0), 0, max(path.cost, 1)
            while True:
                spend(1)
                count += 1
                next_arrival = next(arrival_times, None)
                if next_arrival == arrival:
                    continue
                window = self.solver.find_window(path, count, window, spend, None)
                if window - arrival == value:
                    yield self._explain_window(path, steps, count, arrival, window)
                    return
                if next_arrival is None or window <= next_arrival:
                    return
                arrival = next_arrival
        except DivergedError:
            return

    def list_holds(self, name: str, hold: int) -> Iterator[FigureWorking]:
        """Yield what may hold up the storing of an activity's inputs for so long."""
        if rest := self._find_rest(name):
            yield from self._name_full_threads(rest, rest.list_holds(name, hold))
            return
        for thread_id in (name, *list_storing_ids(self.solver.cores.system.activities[name])):
            path = self.solver.paths.look_up((thread_id,))
            if path.last_step is None:
                workings: Iterable[FigureWorking] = self._follow_path((thread_id,), hold)
                yield from (replace(working, is_hold=True) for working in workings)
            else:
                streams = self.solver.find_activation_streams(path.last_step)
                count = self.formulas.count_held_jobs(streams, hold)
                working = self._explain_window(path, (thread_id,), count.number, 0, hold)
                own_term = WorkTerm(((thread_id, path.last_step.cost),), count, OWN_JOBS)
                own_terms = group_terms([own_term, *self._list_own_terms(path, hold)])
                yield replace(working, terms=own_terms, activation=0, is_hold=True)
            if self.solver.limits.backlog is not None:
                yield from BacklogWorkings(self.solver.limits.backlog, self.formulas).list_holds(thread_id, hold)

    def _explain_window(
        self, path: CorePath, steps: tuple[str, ...], count: int, arrival: int, window: int
    ) -> FigureWorking:
        terms = [*self._list_own_terms(path, window)]
        if path.last_step:
            terms.insert(0, WorkTerm(((steps[-1], path.last_step.cost),), EventCount(count, str(count)), "its own"))
        if path.own_cost:
            is_silent = steps[-1] in self.solver.cores.inner_triggers.silent_ids
            reason = "at the start" if is_silent else "its own, beside others of its kind"
            terms.append(WorkTerm(((steps[-1], path.own_cost),), EventCount(1, "1"), reason))
        work = self.solver.work
        arrivals = {origin: max_arrivals(model, window) for origin, model in work.streams.items()}
        blocked_time = work.find_time_blocked(path, window, arrivals)
        shares, pending, is_pending_inside = self._share_cores(path, window, arrivals, blocked_time)
        return FigureWorking(
            max(window - arrival, 0),
            window,
            group_terms(terms),
            count,
            arrival,
            steps=steps if len(steps) > 1 else (),
            core_count=self.solver.cores.core_count,
            blocked_time=blocked_time,
            beside_terms=group_terms(self._list_beside_terms(path, window, with_pending=is_pending_inside)),
            shares=shares,
            pending=pending,
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
                yield WorkTerm(((names, -(-total // threads)),), EventCount(1, "1"), reason)

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
        return WorkTerm(((key[0], work),), count, f"{self._describe_origin(origin)}{before}")

    def _describe_origin(self, origin: EventOrigin) -> str:
        if origin.kind == "arc":
            arc = self.solver.cores.entering_arcs[int(origin.key)].arc
            return f"events of {arc.topic} from {arc.source}"
        return f"events of {origin.key}"

    def _share_cores(
        self, path: CorePath, window: int, arrivals: dict[EventOrigin, int], blocked_time: int
    ) -> tuple[tuple[ThreadShare, ...], int, bool]:
        """Return what the threads beside a path do, the pending work that is counted with it, and whether all pending
        work is counted in the threads instead.
        """
        work, cores = self.solver.work, self.solver.cores
        units = [cores.jobs[lane[0]].unit for lane in path.other_lanes]
        lane_works = [
            sum(cores.jobs[number].work * arrivals[cores.jobs[number].origin] for number in lane)
            for lane in path.other_lanes
        ]
        pending_works: list[int] = []
        pending_by_origin: dict[EventOrigin, int] = {}
        held_work = 0
        for lane in path.other_lanes:
            pending_works.append(0)
            for number in lane:
                job = cores.jobs[number]
                amount = job.work * work.count_pending(job.origin, window, work.delays.get(job.key, 0), arrivals)
                pending_works[-1] += amount
                if number in path.held_jobs:
                    held_work += amount
                elif amount:
                    pending_by_origin[job.origin] = pending_by_origin.get(job.origin, 0) + amount
        most_waiting = held_work + work.find_most_waiting(path, pending_by_origin)
        all_works = [own + pending for own, pending in zip(lane_works, pending_works, strict=True)]
        whole_shares = [
            (lane_works, most_waiting, False),
            (all_works, 0, True),
            (lane_works, work.find_most_pending(path), True),
        ]
        for works, pending, is_cut in whole_shares:
            is_limited = (is_cut or not pending) and not path.crowds
            lane_works_by_core = split_lanes(path, works)
            limit = _cut_time([*lane_works_by_core], pending, cores.core_count) if is_limited else None
            counted = [
                Fraction(each) if limit is None else min(Fraction(each), limit * width)
                for each, width in zip(works, path.lane_widths, strict=True)
            ]
            if -(-(sum(counted) + pending) // cores.core_count) == blocked_time:
                shares = zip(units, works, counted, strict=True)
                thread_shares = tuple(ThreadShare(unit, whole, -(-part // 1)) for unit, whole, part in shares if whole)
                return thread_shares, pending, works is all_works
        return (), 0, False


def _cut_time(works: list[int], pending: int, core_count: int) -> Fraction:
    """Return the time for which no thread works longer: that in which all cores may be busy."""
    numerator, denominator = find_blocked_time(works, pending, core_count) if works else (pending, core_count)
    return Fraction(numerator, denominator)
