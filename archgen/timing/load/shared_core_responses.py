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
from functools import cache

from archgen.timing.figures.timing_values import ResponseTier, UnknownCause, unite_causes
from archgen.timing.load.busy_windows import DivergedError, SearchBudget, WorstActivation
from archgen.timing.load.core_paths import CorePath, CorePaths, LastStep, build_thread_work
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    delay_streams,
    earliest_arrivals,
    streams_of_calls,
)
from archgen.timing.load.idle_backlogs import find_idle_backlog
from archgen.timing.load.level_cascades import ArcModelFinder, CascadeDemand, EntryWay, look_up_arcs
from archgen.timing.load.load_system import list_storing_ids
from archgen.timing.load.path_work import PathWork
from archgen.timing.load.shared_core_limits import CoreShares, SharedCoreLimits, has_priorities, open_refining_budget
from archgen.timing.load.shared_cores import WayKey
from archgen.timing.load.storing_waits import hold_beside_others
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, WorstResponse
from archgen.timing.load.whole_hosts import HostLimit
from archgen.timing.system.timing_system import samples_inputs

_MAX_SWEEPS = 60
"""Sweeps over all runs of some cores before their responses are given up."""
_MAX_WAITING_EVENTS = 50
"""Events of one origin that may come within a delay, before it is said to have run away."""


def open_shared_solver(
    paths: CorePaths,
    model_of: ArcModelFinder,
    known_bounds: tuple[Mapping[str, WorstResponse], Mapping[str, HostLimit]],
    budget: SearchBudget,
) -> SharedCoreSolver:
    """Return what finds the responses on some cores, for the event models of what enters them (`model_of`).

    `known_bounds` have the responses of the foreign units, which are found elsewhere, and what bounds each activity on
    its host as a whole.
    """
    demand = CascadeDemand(paths.cores.cascades, look_up_arcs(model_of, paths.cores.entering_arcs))
    return SharedCoreSolver(paths, demand, known_bounds, budget)


class SharedCoreSolver:
    """Finds the responses on some cores; `work` then has what may be pending of each way."""

    def __init__(
        self,
        paths: CorePaths,
        demand: CascadeDemand,
        known_bounds: tuple[Mapping[str, WorstResponse], Mapping[str, HostLimit]],
        budget: SearchBudget,
    ) -> None:
        """Take what enters the cores from the demand."""
        self.paths, self.cores, self.demand = paths, paths.cores, demand
        self.whole_budget = self.budget = budget
        self.known_responses, host_limits = known_bounds
        self.limits = SharedCoreLimits(self.cores.ways_to, host_limits)
        self.step_responses: dict[str, int] = {}
        self.cause_of: dict[str, UnknownCause] = {}
        self.raised_names: set[str] = set()
        self.way_before = {
            (name, number): self.cores.find_way_before(way.entry, way.steps)
            for name, ways in self.cores.ways_to.items()
            for number, way in enumerate(ways)
            if len(way.steps) > 1
        }
        # The longest ways first: each passes on what it is bounded by.
        self.ways_before = sorted(
            self.way_before.items(), key=lambda pair: -len(self.cores.ways_to[pair[0][0]][pair[0][1]].steps)
        )
        self.last_windows: dict[tuple[int, int], int] = {}
        self.busy_windows: dict[int, int] = {}
        """The longest window of each path (by identity): in each shorter one there was more to do than it lasts."""

    def solve(self) -> CoreResponses:
        """Find the responses of all runs together, from below."""
        cause = self._find_common_cause()
        if cause is not None:
            self.cause_of = dict.fromkeys(self.cores.inner_triggers.order, cause)
            return self._build_responses()
        self.work = PathWork(self.cores, self.demand)
        is_backlog_late = self._wants_backlog_late()
        if is_backlog_late:
            self.budget = open_refining_budget(self.whole_budget, self.paths, None)
        else:
            self._find_backlog()
        if self.limits.backlog is None:
            self._mark_full_threads()
        self.longest_wait = self._find_longest_wait()
        for name in sorted(self.cores.foreign_ids):
            self.work.note_delay((name, 0), self.known_responses[name].value or 0)
        while stuck_names := self._repeat_sweeps():
            if is_backlog_late:
                is_backlog_late = False
                self._find_backlog()
            # What still grows has the bound of its limit, or none that is found; what it comes in the way of then has
            # none either.
            self.raised_names.update(name for name in stuck_names if self.limits.has_limit(name))
            self._mark_boundless([name for name in stuck_names if not self.limits.has_limit(name)], DIVERGED_CAUSE)
        return self._build_responses()

    def _find_backlog(self) -> None:
        """Look for what may be pending, if it can be said, and cut down what may be spent on bounds that are smaller."""
        if self._can_have_backlog():
            way_works, budget = self.paths.way_works, self.whole_budget
            self.limits.note_backlog(find_idle_backlog(self.cores, way_works, self.demand, budget))
            self.budget = open_refining_budget(budget, self.paths, self.limits.backlog)

    def _wants_backlog_late(self) -> bool:
        """Whether the backlog is looked for only when nothing else ends: with priorities it is seldom the smaller bound."""
        # Where something comes later than when the next of its kind is due, delays may have come back as jitter, and would
        # grow from turn to turn of the whole analysis though each has an end here.
        is_jitter_long = any(stream.jitter > stream.period for model in self.work.streams.values() for stream in model)
        return has_priorities(self.cores) and self._can_have_backlog() and not is_jitter_long

    def _can_have_backlog(self) -> bool:
        return not (self.cores.foreign_ids or self.cores.reentrant_units)

    def _find_longest_wait(self) -> int:
        """Return a delay above which a bound has run away."""
        streams = [stream for model in self.work.streams.values() for stream in model]
        return max((_MAX_WAITING_EVENTS * (stream.period + stream.jitter) for stream in streams), default=0)

    def _find_common_cause(self) -> UnknownCause | None:
        """Return why nothing is known of any response here, None where all is well."""
        if self.demand.share() >= self.cores.core_count:
            return OVERLOAD_CAUSE
        unknown_causes = self._find_unknown_causes()
        return unite_causes(unknown_causes) if unknown_causes else None

    def _find_unknown_causes(self) -> list[UnknownCause]:
        """Return what is missing of all that comes, and of how long it takes."""
        unknown_costs = [
            UnknownCause((name,))
            for name in self.cores.cascades.unknown_costs
            if name not in self.cores.inner_triggers.silent_ids
        ]
        return [*unknown_costs, *self.demand.causes]

    def _mark_full_threads(self) -> None:
        """Mark what has no bound as its thread, or a core with what is beside it, is busy all the time."""
        shares = CoreShares(self.cores, self.demand)
        for unit in self.cores.own_units:
            if shares.fills_thread(unit):
                self._mark_boundless(unit, OVERLOAD_CAUSE)
        boundless_ids = [
            name
            for name in sorted(self.cores.foreign_ids)
            if (response := self.known_responses.get(name)) is None or response.value is None
        ]
        order = self.cores.inner_triggers.order
        full_names = [
            name
            for name in order
            if name not in self.limits.of_host and shares.fills_core((name,), self.paths.look_up((name,)))
        ]
        self._mark_boundless([*boundless_ids, *full_names], DIVERGED_CAUSE)

    def _mark_boundless(self, names: Iterable[str], cause: UnknownCause) -> None:
        """Note that some activities have no bound: any amount of what is pending comes in the way of others at last."""
        marked_names = [name for name in names if name not in self.cause_of]
        self.cause_of.update(dict.fromkeys(marked_names, cause))
        lasting_cause = DIVERGED_CAUSE if cause == OVERLOAD_CAUSE else cause
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

    def _repeat_sweeps(self) -> list[str]:
        """Sweep until nothing grows; return what still does where the end is not reached."""
        grown_names: list[str] = []
        for _ in range(_MAX_SWEEPS):
            spend = self.budget.start_search()
            delays: dict[WayKey, int] = {}
            for name in self._list_bounded():
                try:
                    self._find_way_delays(name, delays, spend)
                except DivergedError:
                    return self._list_unsettled(name, delays)
            # A step has ended before the one that it fires: what bounds all of them bounds each.
            for key, way_before in self.ways_before:
                if key in delays and delays[key] < delays[way_before]:
                    delays[way_before] = delays[key]
            grown_names = [key[0] for key, delay in delays.items() if self.work.note_delay(key, delay)]
            if self.work.is_calm():
                return []  # the next sweep would find the same
            if not grown_names or self._has_run_away(grown_names):
                break
        return grown_names

    def _list_unsettled(self, name: str, delays: Mapping[WayKey, int]) -> list[str]:
        """Return what is given up where the budget is spent: all that has a limit, else one activity and what grew."""
        raisable_names = [each for each in self._list_bounded() if each not in self.raised_names]
        limited_names = [each for each in raisable_names if self.limits.has_limit(each)]
        if limited_names:
            return limited_names
        return list(
            dict.fromkeys([name, *(key[0] for key, delay in delays.items() if delay > self.work.delays.get(key, 0))])
        )

    def _has_run_away(self, grown_names: Iterable[str]) -> bool:
        """Whether a delay that still grows is so long that nothing is won by waiting for its end."""
        # It is no bound yet, and none is made of it: repeated from below, a delay bounds nothing before all have ended.
        return any(
            self.work.delays[name, number] > self.longest_wait
            for name in grown_names
            for number in range(len(self.cores.ways_to[name]))
        )

    def _list_bounded(self) -> list[str]:
        """Return the activities of which a bound may be found, each behind what fires it."""
        return [name for name in self.cores.inner_triggers.order if name not in self.cause_of]

    def _find_way_delays(self, name: str, delays: dict[WayKey, int], spend: Callable[[int], None]) -> None:
        """Find the delays of the ways to an activity anew, for what may be pending now."""
        response_limit = self.limits.limit_response(name)
        if response_limit is not None and name in self.raised_names:
            self.step_responses[name] = response_limit
            for number, way in enumerate(self.cores.ways_to[name]):
                before = delays[self.way_before[name, number]] if len(way.steps) > 1 else 0
                limit = self.limits.limit_delay((name, number))
                delays[name, number] = before + response_limit if limit is None else limit
            return
        response = self.find_worst(self.paths.look_up((name,)), spend, response_limit).response
        # What a declared response says may be more than is computed: so long it may be pending.
        response = max(response, self.cores.system.activities[name].response or 0)
        self.step_responses[name] = response
        for number, way in enumerate(self.cores.ways_to[name]):
            delay, limit = response, self.limits.limit_delay((name, number))
            if len(way.steps) > 1:
                delay += delays[self.way_before[name, number]]
            delay = delay if limit is None else min(delay, limit)
            if len(way.steps) > 1:
                delay = self.find_worst(self.paths.look_up(way.steps), spend, delay).response
            delays[name, number] = delay

    def find_worst(self, path: CorePath, spend: Callable[[int], None], limit: int | None = None) -> WorstActivation:
        """Return what of a path takes longest from the event on; something of `limit` where nothing is known to take less.

        Where the last step has a thread of its own, each activation of it since t0 is looked at. None waited then, so
        that the n-th comes no sooner than the n-th of all that fires it.
        """
        if path.last_step is None:
            return WorstActivation(0, 0, self._find_window(path, 0, max(path.cost, 1), spend, limit))
        arrival_times = earliest_arrivals(self.find_activation_streams(path.last_step))
        arrival, longest, count, window = next(arrival_times, 0), 0, 0, max(path.cost, 1)
        worst = WorstActivation(0, 0, 0)
        while True:
            spend(1)
            count += 1
            next_arrival = next(arrival_times, None)
            if next_arrival == arrival:  # the last of those that come at once ends last
                continue
            window = self._find_window(path, count, window, spend, None if limit is None else arrival + limit)
            if window - arrival > longest:
                longest, worst = window - arrival, WorstActivation(count, arrival, window)
            if next_arrival is None or window <= next_arrival or (limit is not None and longest >= limit):
                return worst
            arrival = next_arrival

    def find_activation_streams(self, last_step: LastStep) -> EventStreams:
        """Return the event model of what fires the last step of a path: behind the steps that are not of the path."""
        streams: list[EventStream] = []
        for origin, multiplicity, way_before, best_before in last_step.arrivals:
            model = self.demand.streams_of(origin)
            if multiplicity > 1:
                model = streams_of_calls(model, Fraction(multiplicity))
            jitter = max(self.work.delays.get(way_before, 0) - best_before, 0) if way_before else 0
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
            needed = max(last_work + self.work.find_time_beside(path, window, spend), path.cost)
            if needed <= window:
                self.last_windows[key] = window
                self.busy_windows[id(path)] = max(window, self.busy_windows.get(id(path), 0))
                self.work.longest_window = max(window, self.work.longest_window)
                return needed if window == 1 else window
            window = needed
        self.work.longest_window = max(limit, self.work.longest_window)
        return limit

    def _build_responses(self) -> CoreResponses:
        """Return what was found, or why nothing was."""
        ways_to = {
            name: ways
            if name in self.cause_of
            else tuple(way._replace(delay=self.work.delays[name, number]) for number, way in enumerate(ways))
            for name, ways in self.cores.ways_to.items()
        }
        return CoreResponses(
            {name: self._build_response(name, ways_to[name]) for name in self.cores.inner_triggers.order},
            ways_to,
            {
                name: self._find_storing_wait(name)
                for name in self.cores.inner_triggers.order
                if samples_inputs(self.cores.system, self.cores.system.activities[name])
            },
        )

    def _find_storing_wait(self, name: str) -> WorstResponse:
        """Return how long a message that an activity only stores may wait until an activation that does not read it."""
        limit = self.limits.of_host.get(name)
        host_wait = None if limit is None else limit.storing_wait
        if name in self.cause_of:
            return WorstResponse(None, "cores", self.cause_of[name])
        if host_wait is not None and name in self.raised_names:
            return WorstResponse(host_wait, "whole host")
        thread_ids = (name, *list_storing_ids(self.cores.system.activities[name]))
        try:
            wait: int | None = max(self._hold_in_thread(each) for each in thread_ids)
        except DivergedError:
            wait = self._hold_by_backlog(thread_ids)
        if host_wait is not None and (wait is None or host_wait <= wait):
            return WorstResponse(host_wait, "whole host")
        return WorstResponse(wait, "cores", DIVERGED_CAUSE if wait is None else UnknownCause())

    def _hold_by_backlog(self, names: Iterable[str]) -> int | None:
        """Return how long the threads of some activities may have work all the time."""
        if self.limits.backlog is None:
            return None
        try:
            return max(self.limits.backlog.find_busy_window(build_thread_work(self.cores, name)) for name in names)
        except DivergedError:
            return None

    def _hold_in_thread(self, name: str) -> int:
        """Return how long the thread of an activity may have work until an activation comes that is not part of it."""
        path, spend = self.paths.look_up((name,)), self.budget.start_search()
        last_step = path.last_step
        if last_step is None:
            return self._find_window(path, 0, max(path.cost, 1), spend, None)
        return hold_beside_others(
            cache(lambda window: self.work.find_time_beside(path, window, spend)),
            last_step.cost,
            self.find_activation_streams(last_step),
            spend,
            self.busy_windows.get(id(path), 1),
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
        response = min(self.step_responses[name], max((way.delay or 0) - way.best_before for way in ways))
        limit = self.limits.of_host.get(name)
        return WorstResponse(response, tier if limit is None or response < limit.response else limit.tier)
