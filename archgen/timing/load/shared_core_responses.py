"""Response times on several cores that share their work, under any global work-conserving scheduler.

Let t0 be the last instant before an arrival at which a core was idle and nothing waited in the threads of the run that
the arrival begins. From then on until the last step of the run has ended, one of the m cores works for a thread of the
run, or all m are busy with other threads. The former takes at most A, the work of those threads; the latter takes B with
m B = sum of min(W, B) over the other threads, since none works more than B in a time B. So the run has ended A + B after
t0: were it not, more work would have been done than there is. W is what arrives in that time, and what was pending at
t0: at most m - 1 threads had work then, and each pending cascade waits for one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from heapq import nlargest
from typing import NamedTuple, TypeVar

from archgen.frozen import dataclass
from archgen.timing.analysis import ResponseTier
from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.cascade_demand import CascadeDemand, LevelCascades, Origin, build_level_cascades, number_arcs
from archgen.timing.load.core_responses import CoreResponses, rank_threads, urgency_of
from archgen.timing.load.event_streams import EventStreams, earliest_arrivals, max_arrivals, streams_of_calls
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.load.run_ways import EntryWay, Priority, find_entry_ways
from archgen.timing.load.thread_work import (
    DIVERGED_CAUSE,
    OVERLOAD_CAUSE,
    UNBOUNDED_CAUSE,
    ThreadWork,
    WorstResponse,
)
from archgen.timing.system.core_placement import ProcessingResource, ThreadUnit
from archgen.timing.system.timing_system import TimingSystem

_Amount = TypeVar("_Amount", int, Fraction)
_MAX_SWEEPS = 60
"""Sweeps over all runs of some cores before their responses are given up."""


@dataclass(frozen=True, slots=True)
class SharedCores:
    """Cores that share their work, as far as no figure of events matters.

    `crowd_of` is the container whose threads an activity waits for, with the number of its threads.
    """

    system: TimingSystem
    resource: ProcessingResource
    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    cascades: LevelCascades
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    unit_of: Mapping[str, ThreadUnit]
    crowd_of: Mapping[str, tuple[str, int]]
    foreign_ids: frozenset[str]
    threads: Mapping[ThreadUnit, ThreadWork]


def prepare_shared_cores(
    system: TimingSystem, resource: ProcessingResource, inner_triggers: InnerTriggers
) -> SharedCores:
    """Find the threads of some cores, and the cascades of what enters them."""
    foreign_ids = tuple(name for unit in resource.foreign_units for name in unit)
    arc_numbers, entering_arcs = number_arcs(inner_triggers)
    cascades = build_level_cascades(system, inner_triggers, arc_numbers, (*resource.members, *foreign_ids), foreign_ids)
    return SharedCores(
        system,
        resource,
        inner_triggers,
        entering_arcs,
        cascades,
        find_entry_ways(system, inner_triggers, arc_numbers),
        {name: unit for unit in (*resource.units, *resource.foreign_units) for name in unit},
        _find_crowds(system, resource),
        frozenset(foreign_ids),
        {
            thread.unit: thread
            for thread in rank_threads(system, (*resource.units, *resource.foreign_units), inner_triggers.silent_ids)
        },
    )


def _find_crowds(system: TimingSystem, resource: ProcessingResource) -> dict[str, tuple[str, int]]:
    """Return the containers that have several threads, but fewer than members."""
    members_by_container: dict[str, list[str]] = {}
    for name in resource.members:
        container = system.activities[name].container
        if container is not None:
            members_by_container.setdefault(container, []).append(name)
    return {
        name: (container, threads)
        for container, names in members_by_container.items()
        if 1 < (threads := system.threads.get(container) or 1) < len(names)
        for name in names
    }


class _Job(NamedTuple):
    """What each event of an origin asks of a thread on one way: the work of the way's last step, in ticks."""

    key: tuple[str, int]
    origin: Origin
    work: int
    unit: ThreadUnit
    steps: tuple[str, ...]


class _Path(NamedTuple):
    """What counts for some steps: their own time, and the work in their threads and beside them, by its place in the jobs.

    `own_jobs` says of each job in the steps' threads which way leads to it from other threads: what is pending of it can
    only be on that way. `crowds` are the jobs of each container whose threads the steps wait for, with the threads' number.
    Of the other threads only those count that may be as urgent; `less_urgent_ways` are the jobs among theirs that something
    less urgent leads to, which may have been held up for long.
    """

    cost: int
    own_jobs: list[tuple[int, tuple[str, int] | None]]
    crowds: list[tuple[list[int], int]]
    other_lanes: list[list[int]]
    other_jobs: list[int]
    waiting_lanes: list[frozenset[Origin]]
    less_urgent_ways: frozenset[int]


_LastJobs = tuple[str, int, Sequence[tuple[Origin, int]]]
"""The last step of a path, which of its activations is looked at, and the entries that lead to it, with how many each."""


def solve_shared_cores(
    cores: SharedCores,
    model_of: Callable[[Origin, FiringArc | None], EventStreams | UnknownCause],
    known_responses: Mapping[str, WorstResponse],
    budget: SearchBudget,
) -> CoreResponses:
    """Return the responses on some cores, for the event models of what enters them (`model_of`).

    `known_responses` have those of the foreign units, which are found elsewhere.
    """

    def find_model(origin: Origin) -> EventStreams | UnknownCause:
        return model_of(origin, cores.entering_arcs[int(origin.key)] if origin.kind == "arc" else None)

    demand = CascadeDemand(cores.cascades, find_model)
    return _SharedCoreSolver(cores, demand, known_responses, budget).solve()


class _SharedCoreSolver:
    def __init__(
        self,
        cores: SharedCores,
        demand: CascadeDemand,
        known_responses: Mapping[str, WorstResponse],
        budget: SearchBudget,
    ) -> None:
        self.cores = cores
        self.demand = demand
        self.known_responses = known_responses
        self.budget = budget
        self.core_count = cores.resource.cores
        self.volumes = {origin: volume for origin, volume in cores.cascades.volumes.items() if volume}
        self.jobs = list(self._list_jobs())
        self.job_numbers: dict[ThreadUnit, list[int]] = {
            unit: [] for unit in (*cores.resource.units, *cores.resource.foreign_units)
        }
        for number, job in enumerate(self.jobs):
            self.job_numbers[job.unit].append(number)
        self.origins_of_unit = {
            unit: frozenset(self.jobs[number].origin for number in numbers)
            for unit, numbers in self.job_numbers.items()
        }
        self.units_of_origin: dict[Origin, set[ThreadUnit]] = {}
        for job in self.jobs:
            self.units_of_origin.setdefault(job.origin, set()).add(job.unit)
        self.paths: dict[tuple[str, ...], _Path] = {}
        self.delays: dict[tuple[str, int], int] = {}
        self.step_responses: dict[str, int] = {}
        self.whole_ways: set[tuple[str, int]] = set()
        self.cause_of: dict[str, UnknownCause] = {}

    def _list_jobs(self) -> Iterator[_Job]:
        for name, ways in self.cores.ways_to.items():
            cost = self.cores.system.activities[name].wcet
            for number, way in enumerate(ways):
                if cost and way.entry in self.volumes:
                    unit = self.cores.unit_of[name]
                    yield _Job((name, number), way.entry, cost * way.multiplicity, unit, way.steps)
        for name in self.cores.foreign_ids:
            origin = Origin("activity", name)
            if origin in self.volumes:
                cost = self.cores.system.activities[name].wcet or 0
                yield _Job((name, 0), origin, cost, self.cores.unit_of[name], (name,))

    def solve(self) -> CoreResponses:
        """Find the responses of all runs together, from below, and those of the activities."""
        cause = self._find_common_cause()
        if cause is not None:
            self.cause_of = dict.fromkeys(self.cores.inner_triggers.order, cause)
            return self._build_responses()
        self._mark_full_threads()
        self.delays = {job.key: 0 for job in self.jobs}
        for name in self.cores.foreign_ids:
            self.delays[name, 0] = self.known_responses[name].value or 0
        while grown_names := self._repeat_sweeps():
            # What still grows has no bound that is found, and neither has what it comes in the way of.
            self._mark_boundless(grown_names, DIVERGED_CAUSE)
        return self._build_responses()

    def _repeat_sweeps(self) -> list[str]:
        """Sweep until nothing grows; return what still does where the end is not reached."""
        grown_names: list[str] = []
        for _ in range(_MAX_SWEEPS):
            grown_names = []
            try:
                self._sweep_ways(grown_names)
            except DivergedError:
                break
            if not grown_names:
                break
        return grown_names

    def _find_common_cause(self) -> UnknownCause | None:
        """Return why nothing is known of any response here, None where all is well."""
        if self.demand.share() >= self.core_count:
            return OVERLOAD_CAUSE
        unknown_costs = [
            UnknownCause((name,))
            for name in self.cores.cascades.unknown_costs
            if name not in self.cores.inner_triggers.silent_ids
        ]
        if unknown_costs or self.demand.causes:
            return unite_causes((*unknown_costs, *self.demand.causes))
        return None

    def _mark_full_threads(self) -> None:
        """Mark what has no bound because its thread is busy all the time, and find the ways that can be looked at whole."""
        shares = {unit: self._share_of(numbers) for unit, numbers in self.job_numbers.items()}
        for unit in self.cores.resource.units:
            if shares[unit] >= 1:
                self._mark_boundless(unit, OVERLOAD_CAUSE)
        boundless_ids = [
            name
            for name in self.cores.foreign_ids
            if (response := self.known_responses.get(name)) is None or response.value is None
        ]
        self._mark_boundless(
            [*boundless_ids, *(name for name in self.cores.inner_triggers.order if self._fills_core((name,), shares))],
            UNBOUNDED_CAUSE,
        )
        self.whole_ways = {
            (name, number)
            for name, ways in self.cores.ways_to.items()
            for number, way in enumerate(ways)
            if len(way.steps) > 1 and not self._fills_core(way.steps, shares)
        }

    def _mark_boundless(self, names: Iterable[str], cause: UnknownCause) -> None:
        """Note that some activities have no bound: any amount of what is pending comes in the way of others at last."""
        for name in names:
            self.cause_of.setdefault(name, cause)
        lasting_cause = UNBOUNDED_CAUSE if cause == OVERLOAD_CAUSE else cause
        boundless_jobs = {number for number, job in enumerate(self.jobs) if job.key[0] in self.cause_of}
        has_grown = True
        while has_grown:
            has_grown = False
            for name in self.cores.inner_triggers.order:
                if name not in self.cause_of and not boundless_jobs.isdisjoint(self._list_disturbing_jobs(name)):
                    self.cause_of[name] = lasting_cause
                    boundless_jobs.update(number for number, job in enumerate(self.jobs) if job.key[0] == name)
                    has_grown = True

    def _list_disturbing_jobs(self, name: str) -> Iterator[int]:
        """Yield the jobs that come in the way of an activity, and those that lead to it."""
        path = self._look_at_path((name,))
        yield from (number for number, _ in path.own_jobs)
        yield from path.other_jobs
        for numbers, _ in path.crowds:
            yield from numbers
        steps = {step for way in self.cores.ways_to[name] for step in way.steps}
        yield from (number for number, job in enumerate(self.jobs) if job.key[0] in steps)

    def _share_of(self, job_numbers: Iterable[int]) -> Fraction:
        """Return the share of a core that some jobs take in the long run."""
        jobs = [self.jobs[number] for number in job_numbers]
        return sum_fractions([Fraction(0), *(self.demand.rate_of(job.origin) * job.work for job in jobs)])

    def _fills_core(self, steps: tuple[str, ...], lane_shares: Mapping[ThreadUnit, Fraction]) -> bool:
        """Whether the threads of some steps, and what keeps all cores busy beside them, fill a core in the long run."""
        path = self._look_at_path(steps)
        own_share = sum_fractions(
            [
                *(lane_shares[unit] for unit in dict.fromkeys(self.cores.unit_of[step] for step in steps)),
                *(self._share_of(numbers) / threads for numbers, threads in path.crowds),
            ]
        )
        other_shares = [lane_shares[self.jobs[numbers[0]].unit] for numbers in path.other_lanes if numbers]
        # Most are far from it, as the plain sum says.
        if own_share + sum_fractions([Fraction(0), *other_shares]) / self.core_count < 1:
            return False
        numerator, denominator = _find_blocked_time(other_shares, Fraction(0), self.core_count)
        return own_share + numerator / denominator >= 1

    def _sweep_ways(self, grown_names: list[str]) -> None:
        """Find the delays of all ways anew for what may be pending now, and note what grew."""
        spend = self.budget.start_search()
        delays_by_steps: dict[tuple[Origin, tuple[str, ...]], int] = {}
        for name in self.cores.inner_triggers.order:
            if name in self.cause_of:
                continue
            ways = self.cores.ways_to[name]
            declared_response = self.cores.system.activities[name].response
            # Not less what comes before it at the least: the event may have come before the window.
            response = self._find_delay((name,), ways, spend)
            if declared_response is not None:
                response = max(response, declared_response)
            self.step_responses[name] = response
            for number, way in enumerate(ways):
                delay = response
                if len(way.steps) > 1:
                    delay += delays_by_steps[way.entry, way.steps[:-1]]
                    if (name, number) in self.whole_ways:
                        delay = self._find_delay(way.steps, ways, spend, delay)
                if delay > self.delays.get((name, number), 0):
                    grown_names.append(name)
                self.delays[name, number] = delays_by_steps[way.entry, way.steps] = delay

    def _find_delay(
        self,
        steps: tuple[str, ...],
        ways: Sequence[EntryWay],
        spend: Callable[[int], None],
        limit: int | None = None,
    ) -> int:
        """Return how long some steps take at most from the event on, or `limit` where that is not less.

        `ways` lead to the last step. Where it has a thread of its own, each activation of it is looked at: the n-th
        comes no sooner than the n-th event that leads to it.
        """
        path = self._look_at_path(steps)
        window = max(path.cost, 1)
        entries = [(way.entry, way.multiplicity) for way in ways]
        is_counted = (
            len(self.cores.unit_of[steps[-1]]) == 1
            and self.cores.system.activities[steps[-1]].wcet
            and all(origin in self.volumes for origin, _ in entries)
            and (len(steps) == 1 or len(ways) == 1)
        )
        if not is_counted:
            return self._find_window(path, window, None, spend, limit)
        streams = tuple(
            stream
            for origin, multiplicity in entries
            for stream in streams_of_calls(self.demand.streams_of(origin), Fraction(multiplicity))
        )
        arrival_times = earliest_arrivals(streams)
        arrival, longest, count = next(arrival_times, 0), 0, 0
        while True:
            count += 1
            next_arrival = next(arrival_times, None)
            window = self._find_window(
                path, window, (steps[-1], count, entries), spend, None if limit is None else arrival + limit
            )
            longest = max(longest, window - arrival)
            if next_arrival is None or window <= next_arrival or (limit is not None and longest >= limit):
                return longest
            arrival = next_arrival

    def _find_window(
        self,
        path: _Path,
        window: int,
        last_jobs: _LastJobs | None,
        spend: Callable[[int], None],
        limit: int | None,
    ) -> int:
        """Return the least window in which a path is sure to be done, or `limit` where it is not less."""
        while limit is None or window < limit:
            spend(2 * len(self.volumes) + 2 * len(self.jobs) + 1)
            needed = self._time_needed(path, window, last_jobs)
            if needed <= window:
                return needed if window == 1 else window
            window = needed
        return limit

    def _look_at_path(self, steps: tuple[str, ...]) -> _Path:
        """Return what counts for some steps."""
        path = self.paths.get(steps)
        if path is None:
            path = self.paths[steps] = self._build_path(steps)
        return path

    def _build_path(self, steps: tuple[str, ...]) -> _Path:
        units = dict.fromkeys(self.cores.unit_of[step] for step in steps)
        level = min((self.cores.threads[unit].lowest_priority for unit in units), key=urgency_of)
        crowds = self._find_path_crowds(steps, units)
        # What holds the threads of a container does so k at a time, with k threads: that counts for more than the cores.
        other_units = [
            unit
            for unit in self.job_numbers
            if unit not in units and self._counts_at(unit, level) and self.cores.crowd_of.get(unit[0]) not in crowds
        ]
        own_numbers = [number for unit in units for number in self.job_numbers[unit]]
        own_origins = {self.jobs[number].origin for number in own_numbers}
        inner_origins = {origin for origin in own_origins if self.units_of_origin[origin] <= units.keys()}
        other_jobs = [
            number
            for unit in other_units
            for number in self.job_numbers[unit]
            if self.jobs[number].origin not in inner_origins
        ]
        return _Path(
            sum(self.cores.system.activities[step].wcet or 0 for step in steps),
            [(number, self._find_way_before(self.jobs[number], units)) for number in own_numbers],
            [(numbers, min(threads, self.core_count)) for (_, threads), numbers in crowds.items()],
            [self.job_numbers[unit] for unit in other_units],
            other_jobs,
            self._list_waiting_lanes(other_units),
            frozenset(number for number in other_jobs if not self._is_urgent_way(number, units, level)),
        )

    def _find_path_crowds(
        self, steps: Iterable[str], units: Mapping[ThreadUnit, None]
    ) -> dict[tuple[str, int], list[int]]:
        """Return the containers whose threads some steps wait for, each with the jobs of its other members."""
        if not self.cores.crowd_of:
            return {}
        crowds: dict[tuple[str, int], list[int]] = {
            self.cores.crowd_of[step]: [] for step in steps if step in self.cores.crowd_of
        }
        for number, job in enumerate(self.jobs):
            crowd = self.cores.crowd_of.get(job.key[0])
            if crowd is not None and crowd in crowds and job.unit not in units:
                crowds[crowd].append(number)
        return crowds

    def _is_urgent_way(self, number: int, units: Mapping[ThreadUnit, None], level: Priority) -> bool:
        """Whether all steps that lead to a job may be as urgent as a level, or are of the path itself."""
        return level is None or all(
            self.cores.unit_of[step] in units or self._counts_at(self.cores.unit_of[step], level)
            for step in self.jobs[number].steps
        )

    def _counts_at(self, unit: ThreadUnit, level: Priority) -> bool:
        """Whether a thread may be as urgent as a level."""
        highest = self.cores.threads[unit].highest_priority
        return level is None or (highest is not None and highest >= level)

    def _find_way_before(self, job: _Job, units: Mapping[ThreadUnit, None]) -> tuple[str, int] | None:
        """Return the way to the step before a job, where that leads through other threads than these, else None."""
        if all(self.cores.unit_of[step] in units for step in job.steps[:-1]):
            return None
        before = job.steps[-2]
        return next(
            (before, number)
            for number, way in enumerate(self.cores.ways_to[before])
            if way.entry == job.origin and way.steps == job.steps[:-1]
        )

    def _list_waiting_lanes(self, units: Iterable[ThreadUnit]) -> list[frozenset[Origin]]:
        """Return what waits in each thread, or container, that takes an idle core as soon as it has work."""
        origins_by_crowd: dict[object, frozenset[Origin]] = {}
        lanes: list[frozenset[Origin]] = []
        for unit in units:
            crowd = self.cores.crowd_of.get(unit[0])
            if crowd is not None:
                origins_by_crowd[crowd] = origins_by_crowd.get(crowd, frozenset()) | self.origins_of_unit[unit]
            elif unit[0] not in self.cores.foreign_ids:
                lanes.append(self.origins_of_unit[unit])
        return [*lanes, *origins_by_crowd.values()]

    def _time_needed(self, path: _Path, window: int, last_jobs: _LastJobs | None) -> int:
        """Return how long all takes that may come in the way of a path in a window: A + B."""
        arrivals = {origin: max_arrivals(self.demand.streams_of(origin), window) for origin in self.volumes}
        # The way's own time at least, also where it works only at the start and so has no events.
        path_work = max(self._path_work(path, window, arrivals, last_jobs), path.cost)
        return path_work + self._blocked_time(path, window, arrivals)

    def _count_pending(self, origin: Origin, window: int, delay: int, arrivals: Mapping[Origin, int]) -> int:
        """Return how many events may have come up to `delay` before a window, beside those in it."""
        return max_arrivals(self.demand.streams_of(origin), window + delay) - arrivals[origin] if delay else 0

    def _path_work(self, path: _Path, window: int, arrivals: Mapping[Origin, int], last_jobs: _LastJobs | None) -> int:
        """Return the work of the threads of a path in a window, as the time for which they can hold it up."""
        total = 0
        for number, way_before in path.own_jobs:
            job = self.jobs[number]
            # At the start of the window nothing waits in the threads of the path themselves.
            delay = self.delays.get(way_before, 0) if way_before else 0
            total += job.work * (arrivals[job.origin] + self._count_pending(job.origin, window, delay, arrivals))
        for numbers, threads in path.crowds:
            crowd_work = 0
            for job in (self.jobs[number] for number in numbers):
                pending = self._count_pending(job.origin, window, self.delays[job.key], arrivals)
                crowd_work += job.work * (arrivals[job.origin] + pending)
            total -= -crowd_work // threads
        if last_jobs is None:
            return total
        name, count, entries = last_jobs
        all_jobs = sum([arrivals[origin] * multiplicity for origin, multiplicity in entries])
        # Later activations of the last step, in its own thread, are none of this one's.
        return total - max(0, all_jobs - count) * (self.cores.system.activities[name].wcet or 0)

    def _blocked_time(self, path: _Path, window: int, arrivals: Mapping[Origin, int]) -> int:
        """Return how long all cores may be busy with other threads: with what arrives, and with what was pending.

        Pending, while a core was idle, is what waits for m - 1 threads, and all that is foreign, for that may have
        waited for a core of its own.
        """
        jobs = self.jobs
        pending_works = {
            number: jobs[number].work * count
            for number in path.other_jobs
            if (count := self._count_pending(jobs[number].origin, window, self.delays[jobs[number].key], arrivals))
        }
        lane_works = [
            sum([jobs[number].work * arrivals[jobs[number].origin] for number in numbers])
            for numbers in path.other_lanes
        ]
        most_pending = self._most_pending(path, pending_works)
        blocked_time = self._divide_work(lane_works, most_pending)
        if most_pending:
            # Or all that may be pending of each thread: less, where a single one has most of it.
            all_works = [
                work + sum([pending_works.get(number, 0) for number in numbers])
                for work, numbers in zip(lane_works, path.other_lanes, strict=True)
            ]
            blocked_time = min(blocked_time, self._divide_work(all_works, 0))
        return blocked_time

    def _most_pending(self, path: _Path, pending_works: Mapping[int, int]) -> int:
        """Return the most work that may have been pending while a core was idle, or busy with what is less urgent."""
        work_by_origin: dict[Origin, int] = {}
        foreign_work = 0
        for number, work in pending_works.items():
            job = self.jobs[number]
            if job.key[0] in self.cores.foreign_ids or number in path.less_urgent_ways:
                foreign_work += work
            else:
                work_by_origin[job.origin] = work_by_origin.get(job.origin, 0) + work
        waiting_works = [
            sum([work for origin, work in work_by_origin.items() if origin in origins])
            for origins in path.waiting_lanes
        ]
        return foreign_work + min(sum(nlargest(self.core_count - 1, waiting_works)), sum(work_by_origin.values()))

    def _divide_work(self, lane_works: list[int], pending_work: int) -> int:
        """Return the longest time for which threads can keep all cores busy, rounded up."""
        # The plain quotient is the answer where no thread has more work than it.
        quotient = -(-(sum(lane_works) + pending_work) // self.core_count)
        if not lane_works or max(lane_works) <= quotient:
            return quotient
        numerator, denominator = _find_blocked_time(lane_works, pending_work, self.core_count)
        return -(-numerator // denominator)

    def _build_responses(self) -> CoreResponses:
        ways_to: dict[str, tuple[EntryWay, ...]] = {}
        for name, ways in self.cores.ways_to.items():
            ways_to[name] = (
                ways
                if name in self.cause_of
                else tuple(way._replace(delay=self.delays[name, number]) for number, way in enumerate(ways))
            )
        return CoreResponses(
            {name: self._build_response(name, ways_to[name]) for name in self.cores.inner_triggers.order}, ways_to
        )

    def _build_response(self, name: str, ways: Sequence[EntryWay]) -> WorstResponse:
        activity = self.cores.system.activities[name]
        if activity.response is not None:
            return WorstResponse(activity.response, "declared")
        cause = self.cause_of.get(name, UnknownCause())
        if activity.wcet is None:
            return WorstResponse(None, "unknown", unite_causes((UnknownCause((name,)), cause)))
        tier: ResponseTier = "executor" if len(self.cores.unit_of[name]) > 1 else "cores"
        if name in self.cause_of:
            return WorstResponse(None, tier, cause)
        longest = max((way.delay or 0) - way.best_before for way in ways)
        return WorstResponse(min(self.step_responses[name], longest), tier)


def _find_blocked_time(lane_works: Sequence[_Amount], pending_work: _Amount, core_count: int) -> tuple[_Amount, int]:
    """Return the longest time B for which threads can keep all cores busy, as numerator and denominator.

    m B = pending work + sum of min(work, B): no thread works longer than that time.
    """
    rest = pending_work
    for work in lane_works:
        rest += work
    largest_works = nlargest(core_count - 1, lane_works)
    # The k threads with the most work are busy all the time: what is left fills the other m - k cores.
    for busy_count, work in enumerate(largest_works):
        if work * (core_count - busy_count) <= rest:
            return rest, core_count - busy_count
        rest -= work
    return rest, core_count - len(largest_works)
