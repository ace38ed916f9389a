"""Response times on several cores that share their work, under any global work-conserving scheduler.

A path is one step, or the steps of a run one after the other. Let t0 be the last instant up to an arrival at which
nothing waited in the threads of the path and a core was idle, or busy with something less urgent. From then on until the
last step of the path has ended, one of the m cores works for a thread of the path, or all m are busy with other threads.
The former takes at most A, the work of those threads; the latter takes B with m B = sum of min(W, B) over the other
threads, since none works more than B in a time B. So the path has ended A + B after t0: were it not, more work would have
been done than there is. W is what arrives in that time, and what was pending at t0: at most m - 1 threads had work then,
and each pending cascade waits for one of them.

In a container with k threads and more members a step may also wait for a thread, while k members work (or as many as
there are cores). Of the time in which it waits, each member's work then counts divided by k, and everybody else's divided
by m: whatever is running, the two together are used up at least as fast as time passes. Where fewer than k members run,
others take the cores, however much of it is one thread's: so no thread's work is cut to B there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from heapq import nlargest

from archgen.timing.analysis import ResponseTier
from archgen.timing.figures.timing_values import UnknownCause, unite_causes
from archgen.timing.load.busy_cores import divide_among_cores
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.cascade_demand import CascadeDemand, Origin
from archgen.timing.load.core_paths import CorePath, CorePaths, LastStep
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.core_shares import CoreShares
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    delay_streams,
    earliest_arrivals,
    max_arrivals,
    streams_of_calls,
)
from archgen.timing.load.inner_triggers import FiringArc
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_cores import SharedCores, WayKey
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, UNBOUNDED_CAUSE, WorstResponse

_MAX_SWEEPS = 60
"""Sweeps over all runs of some cores before their responses are given up."""
_ENDLESS = 1 << 200
"""Longer than any window, in ticks."""


def solve_shared_cores(
    paths: CorePaths,
    model_of: Callable[[Origin, FiringArc | None], EventStreams | UnknownCause],
    known_responses: Mapping[str, WorstResponse],
    budget: SearchBudget,
) -> CoreResponses:
    """Return the responses on some cores, for the event models of what enters them (`model_of`).

    `known_responses` have those of the foreign units, which are found elsewhere.
    """
    cores = paths.cores

    def find_model(origin: Origin) -> EventStreams | UnknownCause:
        return model_of(origin, cores.entering_arcs[int(origin.key)] if origin.kind == "arc" else None)

    demand = CascadeDemand(cores.cascades, find_model)
    return _SharedCoreSolver(paths, demand, known_responses, budget).solve()


class _SharedCoreSolver:
    def __init__(
        self,
        paths: CorePaths,
        demand: CascadeDemand,
        known_responses: Mapping[str, WorstResponse],
        budget: SearchBudget,
    ) -> None:
        self.paths, self.cores, self.demand, self.budget = paths, paths.cores, demand, budget
        self.known_responses = known_responses
        self.streams: dict[Origin, EventStreams] = {}
        self.delays: dict[WayKey, int] = {}
        self.longest_delay = 0
        self.step_responses: dict[str, int] = {}
        self.whole_ways: set[WayKey] = set()
        self.cause_of: dict[str, UnknownCause] = {}
        self.calm_arrivals: dict[Origin, int] = {}
        self.calm_windows: dict[Origin, int] = {}
        self.calm_window = 0
        self.calm_times: dict[int, int] = {}
        self.last_windows: dict[tuple[int, int], int] = {}

    def solve(self) -> CoreResponses:
        """Find the responses of all runs together, from below, and those of the activities."""
        cause = self._find_common_cause()
        if cause is not None:
            self.cause_of = dict.fromkeys(self.cores.inner_triggers.order, cause)
            return self._build_responses()
        self._mark_full_threads()
        self._find_calm_window()
        for name in self.cores.foreign_ids:
            self._note_delay((name, 0), self.known_responses[name].value or 0)
        while stuck_names := self._repeat_sweeps():
            # What still grows has no bound that is found, and neither has what it comes in the way of.
            self._mark_boundless(stuck_names, DIVERGED_CAUSE)
        return self._build_responses()

    def _find_common_cause(self) -> UnknownCause | None:
        """Return why nothing is known of any response here, None where all is well."""
        if self.demand.share() >= self.cores.core_count:
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
        """Mark what has no bound as its thread is busy all the time, and find the ways that can be looked at whole."""
        shares = CoreShares(self.cores, self.demand)
        for unit in self.cores.own_units:
            if shares.fills_thread(unit):
                self._mark_boundless(unit, OVERLOAD_CAUSE)
        boundless_ids = [
            name
            for name in self.cores.foreign_ids
            if (response := self.known_responses.get(name)) is None or response.value is None
        ]
        order = self.cores.inner_triggers.order
        full_names = [name for name in order if shares.fills_core((name,), self.paths.look_up((name,)))]
        self._mark_boundless([*boundless_ids, *full_names], UNBOUNDED_CAUSE)
        self.whole_ways = {
            (name, number)
            for name, ways in self.cores.ways_to.items()
            for number, way in enumerate(ways)
            if len(way.steps) > 1 and not shares.fills_core(way.steps, self.paths.look_up(way.steps))
        }

    def _mark_boundless(self, names: Iterable[str], cause: UnknownCause) -> None:
        """Note that some activities have no bound: any amount of what is pending comes in the way of others at last."""
        marked_names = [name for name in names if name not in self.cause_of]
        self.cause_of.update(dict.fromkeys(marked_names, cause))
        lasting_cause = UNBOUNDED_CAUSE if cause == OVERLOAD_CAUSE else cause
        boundless_jobs = {number for number, job in enumerate(self.cores.jobs) if job.key[0] in self.cause_of}
        has_grown = bool(marked_names)
        while has_grown:
            has_grown = False
            for name in self.cores.inner_triggers.order:
                if name not in self.cause_of and self._is_disturbed(name, boundless_jobs):
                    self.cause_of[name] = lasting_cause
                    boundless_jobs.update(number for number, job in enumerate(self.cores.jobs) if job.key[0] == name)
                    has_grown = True

    def _is_disturbed(self, name: str, boundless_jobs: set[int]) -> bool:
        """Whether something without a bound comes in the way of an activity, or leads to it."""
        if not boundless_jobs.isdisjoint(self.paths.look_up((name,)).list_jobs()):
            return True
        return any(step in self.cause_of for way in self.cores.ways_to[name] for step in way.steps)

    def _find_calm_window(self) -> None:
        """Find the longest windows in which no more comes of an origin, or of all of them, than at once."""
        self.streams = {
            origin: self.demand.streams_of(origin) for origin, volume in self.cores.cascades.volumes.items() if volume
        }
        self.calm_arrivals = {origin: max_arrivals(model, 1) for origin, model in self.streams.items()}
        self.calm_windows = {
            origin: min((_find_calm_time(stream) for stream in model), default=_ENDLESS)
            for origin, model in self.streams.items()
        }
        self.calm_window = min(self.calm_windows.values(), default=0)

    def _note_delay(self, key: WayKey, delay: int) -> bool:
        """Note how long a way takes, unless it was longer before; return whether it grew."""
        if delay <= self.delays.get(key, 0):
            self.delays.setdefault(key, delay)
            return False
        self.delays[key] = delay
        self.longest_delay = max(self.longest_delay, delay)
        return True

    def _repeat_sweeps(self) -> list[str]:
        """Sweep until nothing grows; return what still does where the end is not reached."""
        grown_names: list[str] = []
        for _ in range(_MAX_SWEEPS):
            grown_names = []
            spend = self.budget.start_search()
            for name in self.cores.inner_triggers.order:
                if name not in self.cause_of:
                    try:
                        grown_names += [name] if self._update_ways(name, spend) else []
                    except DivergedError:
                        return [name]
            if not grown_names:
                break
        return grown_names

    def _update_ways(self, name: str, spend: Callable[[int], None]) -> bool:
        """Find the delays of the ways to an activity anew for what may be pending now; return whether any grew."""
        response = self._find_delay(self.paths.look_up((name,)), spend)
        # What a declared response says may be more than is computed: so long it may be pending.
        response = max(response, self.cores.system.activities[name].response or 0)
        self.step_responses[name] = response
        has_grown = False
        for number, way in enumerate(self.cores.ways_to[name]):
            delay = response
            if len(way.steps) > 1:
                delay += self._delay_before(way)
                if (name, number) in self.whole_ways:
                    delay = self._find_delay(self.paths.look_up(way.steps), spend, delay)
            has_grown |= self._note_delay((name, number), delay)
        return has_grown

    def _delay_before(self, way: EntryWay) -> int:
        """Return how long a way takes to the end of the step before its last one."""
        before = way.steps[-2]
        return next(
            self.delays[before, number]
            for number, shorter_way in enumerate(self.cores.ways_to[before])
            if shorter_way.entry == way.entry and shorter_way.steps == way.steps[:-1]
        )

    def _find_delay(self, path: CorePath, spend: Callable[[int], None], limit: int | None = None) -> int:
        """Return how long a path takes at most from the event on, or `limit` where that is not less.

        Where the last step has a thread of its own, each activation of it since t0 is looked at. None waited then, so
        that the n-th comes no sooner than the n-th of all that fires it.
        """
        if path.last_step is None:
            return self._find_window(path, 0, max(path.cost, 1), spend, limit)
        arrival_times = earliest_arrivals(self._activation_streams(path.last_step))
        arrival, longest, count, window = next(arrival_times, 0), 0, 0, max(path.cost, 1)
        while True:
            count += 1
            next_arrival = next(arrival_times, None)
            if next_arrival == arrival:  # the last of those that come at once ends last
                continue
            window = self._find_window(path, count, window, spend, None if limit is None else arrival + limit)
            longest = max(longest, window - arrival)
            if next_arrival is None or window <= next_arrival or (limit is not None and longest >= limit):
                return longest
            arrival = next_arrival

    def _activation_streams(self, last_step: LastStep) -> EventStreams:
        """Return the event model of what fires the last step of a path: behind the steps that are not of the path."""
        streams: list[EventStream] = []
        for origin, multiplicity, way_before, best_before in last_step.arrivals:
            model = self.demand.streams_of(origin)
            if multiplicity > 1:
                model = streams_of_calls(model, Fraction(multiplicity))
            jitter = max(self.delays.get(way_before, 0) - best_before, 0) if way_before else 0
            streams += delay_streams(model, jitter)
        return tuple(streams)

    def _find_window(
        self, path: CorePath, count: int, window: int, spend: Callable[[int], None], limit: int | None
    ) -> int:
        """Return the least window in which a path is sure to be done, or `limit` where it is not less.

        It is not below `window`, nor below what it was when less was pending. So many activations (`count`) of the last
        step are looked at, where they are counted.
        """
        last_work = count * path.last_step.cost if path.last_step else 0
        key = (id(path), count)
        window = max(window, self.last_windows.get(key, 0))
        while limit is None or window < limit:
            spend(2)
            needed = max(last_work + self._time_beside(path, window, spend), path.cost)
            if needed <= window:
                self.last_windows[key] = window
                return needed if window == 1 else window
            window = needed
        return limit

    def _time_beside(self, path: CorePath, window: int, spend: Callable[[int], None]) -> int:
        """Return how long all takes in a window but the last step's activations: A + B."""
        if window + self.longest_delay > self.calm_window:
            spend(2 * (len(self.streams) + len(self.cores.jobs)))
            calm_windows = self.calm_windows
            arrivals = {
                origin: count if window <= calm_windows[origin] else max_arrivals(self.streams[origin], window)
                for origin, count in self.calm_arrivals.items()
            }
            return self._path_work(path, window, arrivals) + self._blocked_time(path, window, arrivals)
        # In such a window nothing comes twice, and nothing is pending: its length does not matter.
        time = self.calm_times.get(id(path))
        if time is None:
            arrivals = self.calm_arrivals
            time = self._path_work(path, window, arrivals) + self._blocked_time(path, window, arrivals)
            self.calm_times[id(path)] = time
        return time

    def _count_pending(self, origin: Origin, window: int, delay: int, arrivals: Mapping[Origin, int]) -> int:
        """Return how many events more there are in a window and up to `delay` before it than in a window."""
        if not delay or window + delay <= self.calm_windows[origin]:
            return 0
        return max_arrivals(self.streams[origin], window + delay) - arrivals[origin]

    def _path_work(self, path: CorePath, window: int, arrivals: Mapping[Origin, int]) -> int:
        """Return the work of the threads of a path in a window, as the time for which they can hold it up."""
        total, jobs = path.start_cost, self.cores.jobs
        for number, way_before in path.own_jobs:
            _, origin, work, _, _ = jobs[number]
            # At t0 nothing waits in the threads of the path themselves.
            delay = self.delays.get(way_before, 0) if way_before else 0
            total += work * (arrivals[origin] + self._count_pending(origin, window, delay, arrivals))
        for numbers, threads in path.crowds:
            crowd_work = 0
            for key, origin, work, _, _ in (jobs[number] for number in numbers):
                pending = self._count_pending(origin, window, self.delays.get(key, 0), arrivals)
                crowd_work += work * (arrivals[origin] + pending)
            total -= -crowd_work // threads
        return total

    def _blocked_time(self, path: CorePath, window: int, arrivals: Mapping[Origin, int]) -> int:
        """Return how long all cores may be busy with other threads: with what arrives, and with what was pending.

        Pending at t0 is what waits for m - 1 threads, and all that is foreign, for that may have waited for a core of its
        own.
        """
        core_count = self.cores.core_count
        lane_works: list[int] = []
        pending_works: list[int] = []
        pending_by_origin: dict[Origin, int] = {}
        held_work = 0
        for lane in path.other_lanes:
            lane_work = pending_work = 0
            for number in lane:
                key, origin, work, _, _ = self.cores.jobs[number]
                lane_work += work * arrivals[origin]
                count = self._count_pending(origin, window, self.delays.get(key, 0), arrivals)
                if count:
                    pending_work += work * count
                    if number in path.held_jobs:
                        held_work += work * count
                    else:
                        pending_by_origin[origin] = pending_by_origin.get(origin, 0) + work * count
            lane_works.append(lane_work)
            pending_works.append(pending_work)
        if not any(pending_works) and not path.crowds:
            return divide_among_cores(lane_works, 0, core_count)
        most_pending = held_work + self._most_waiting(path, pending_by_origin)
        blocked_time = -(-(sum(lane_works) + most_pending) // core_count)
        if path.crowds:
            return blocked_time
        # All that each thread may have in the end: less, where a single one has most of it.
        all_works = [work + pending for work, pending in zip(lane_works, pending_works, strict=True)]
        blocked_time = min(blocked_time, divide_among_cores(all_works, 0, core_count))
        if max(lane_works) > blocked_time:
            blocked_time = min(blocked_time, divide_among_cores(lane_works, self._most_pending(path), core_count))
        return blocked_time

    def _most_pending(self, path: CorePath) -> int:
        """Return the most work that can be pending at t0 at all.

        The more came before t0, the fewer come after it: but those may be of a thread that cannot do them in time.
        """
        pending_by_origin: dict[Origin, int] = {}
        held_work = 0
        for lane in path.other_lanes:
            for number in lane:
                key, origin, work, _, _ = self.cores.jobs[number]
                delay = self.delays.get(key, 0)
                pending_work = work * max_arrivals(self.streams[origin], delay) if delay else 0
                if number in path.held_jobs:
                    held_work += pending_work
                else:
                    pending_by_origin[origin] = pending_by_origin.get(origin, 0) + pending_work
        return held_work + self._most_waiting(path, pending_by_origin)

    def _most_waiting(self, path: CorePath, work_by_origin: Mapping[Origin, int]) -> int:
        """Return the most work that may have waited for m - 1 threads."""
        waiting_works = [0] * path.lane_count
        for origin, work in work_by_origin.items():
            for lane in path.lanes_of_origin[origin]:
                waiting_works[lane] += work
        return min(sum(nlargest(self.cores.core_count - 1, waiting_works)), sum(work_by_origin.values()))

    def _build_responses(self) -> CoreResponses:
        """Return what was found, or why nothing was."""
        ways_to = {
            name: ways
            if name in self.cause_of
            else tuple(way._replace(delay=self.delays[name, number]) for number, way in enumerate(ways))
            for name, ways in self.cores.ways_to.items()
        }
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


def _find_calm_time(stream: EventStream) -> int:
    """Return the longest window in which no more of a stream comes than at once."""
    period, jitter, distance, per_period, batch = stream
    batches = max_arrivals((stream,), 1) // batch
    return max(batches * period // per_period - jitter, batches * distance)
