"""Response times on one resource, by tier: any scheduler, fixed priorities, executor.

A utilisation of one or more on a core is overload; with fixed priorities exactly one is bearable where everything is
strictly periodic (Burns and Wellings' process set C). No result rests on a figure that nobody wrote.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import accumulate
from math import lcm

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import ResponseTier, UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    WorstActivation,
    add_demands,
    find_worst_activation,
    longest_busy_period,
    longest_wait_for_turn,
    subtract_demand,
)
from archgen.timing.load.event_streams import settles_at_full_load
from archgen.timing.load.inner_core import urgency_of
from archgen.timing.load.thread_work import (
    DIVERGED_CAUSE,
    OVERLOAD_CAUSE,
    CoreWindow,
    EventModels,
    ThreadWork,
    WorstResponse,
    build_core_threads,
    find_work,
    work_utilisation,
)
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import works_in_order
from archgen.timing.system.timing_system import TimingSystem


class RankedThreads:
    """Threads by falling priority, and what the first of them demand together.

    Any count may be asked for at any time. Growing counts are cheap, since each builds on the one before; a smaller one
    begins anew.
    """

    def __init__(self, threads: Iterable[ThreadWork]) -> None:
        """Rank the threads; those without a priority are left out."""
        self.threads = sorted((t for t in threads if t.highest_priority is not None), key=_rank_key)
        pairs = [thread.share.as_integer_ratio() for thread in self.threads]
        self._common_denominator = lcm(*[denominator for _, denominator in pairs])
        self._cumulated_shares = tuple(
            accumulate(
                (numerator * (self._common_denominator // own_denominator) for numerator, own_denominator in pairs),
                initial=0,
            )
        )
        self._load, self._loaded_count = GrowingLoad(), 0
        self._busy_period, self._searched_count = 0, 0
        self._cause: UnknownCause | None = None
        self._cause_count = 0

    def count_down_to(self, priority: int) -> int:
        """Return how many threads may have this priority or a higher one."""
        return bisect_right(self.threads, -priority, key=_rank_key)

    def share_of_first(self, count: int) -> Fraction:
        """Return the share of a core that the first threads take."""
        return Fraction(self._cumulated_shares[count], self._common_denominator)

    def cause_of_first(self, count: int) -> UnknownCause | None:
        """Return what is missing of the first threads, None where nothing is."""
        if count < self._cause_count:
            self._cause, self._cause_count = None, 0
        new_causes = [thread.cause for thread in self.threads[self._cause_count : count] if thread.cause]
        if new_causes:
            self._cause = unite_causes((*filter(None, (self._cause,)), *new_causes))
        self._cause_count = count
        return self._cause

    def demand_of_first(self, count: int) -> DemandFunction:
        """Return the demand of the first threads; it is good until another count is asked for."""
        if count < self._loaded_count:
            self._load, self._loaded_count = GrowingLoad(), 0
        for thread in self.threads[self._loaded_count : count]:
            self._load.add_work(thread.works)
        self._loaded_count = count
        return self._load.demand_function()

    def busy_period_of_first(self, count: int, budget: SearchBudget) -> int:
        """Return the busy period of the first threads; that of fewer is a lower bound, where the search begins."""
        if count != self._searched_count:
            lower_bound = self._busy_period if self._searched_count < count else 0
            self._busy_period = longest_busy_period(self.demand_of_first(count), budget, lower_bound)
            # Only now: a search that ended with `DivergedError` has found nothing for this count.
            self._searched_count = count
        return self._busy_period


def _rank_key(thread: ThreadWork) -> int:
    """Sort key: threads by falling greatest priority."""
    return -(thread.highest_priority or 0)


class AnalysisEffort(NamedTuple):
    """How much may still be computed, and for whom: `stale_ids` have other event models than before, None at first.

    The windows that bound responses are put into `windows`, where somebody asks for them.
    """

    budget: SearchBudget
    stale_ids: frozenset[str] | None = None
    windows: dict[str, CoreWindow] | None = None


class _ThreadBound(NamedTuple):
    """The response of a thread, and the window in which it ends, None where there is none."""

    response: WorstResponse
    worst: WorstActivation | None = None


def find_dedicated_response(
    system: TimingSystem, name: str, event_models: EventModels, budget: SearchBudget
) -> WorstResponse:
    """Return the response of an activity without a host: its own queue, on a core of its own."""
    activity = system.activities[name]
    if activity.response is not None:
        return WorstResponse(activity.response, "declared")
    work = find_work(system, name, event_models)
    if isinstance(work, UnknownCause):
        return WorstResponse(None, "dedicated" if activity.wcet is not None else "unknown", work)
    if work_utilisation(work.cost, work.streams) >= 1:
        return WorstResponse(None, "dedicated", OVERLOAD_CAUSE)
    try:
        worst = find_lone_activation(work, budget, in_order=works_in_order(system, activity))
        return WorstResponse(worst.response, "dedicated")
    except DivergedError:
        return WorstResponse(None, "dedicated", DIVERGED_CAUSE)


def find_lone_activation(work: ActivityWork, budget: SearchBudget, *, in_order: bool) -> WorstActivation:
    """Return what takes longest on a core of its own; `in_order` where activations begin in the order in which they come."""
    if in_order:
        return find_worst_activation(work, NO_DEMAND, budget)
    return WorstActivation(0, 0, longest_busy_period(GrowingLoad((work,)).demand_function(), budget))


def find_responses(
    system: TimingSystem, resource: ProcessingResource, event_models: EventModels, effort: AnalysisEffort
) -> dict[str, WorstResponse]:
    """Return the responses on one core, or on cores that are joined; without those that cannot have changed."""
    budget, stale_ids, windows = effort
    all_threads = build_core_threads(system, resource, event_models)
    wanted_threads = all_threads[: len(resource.units)]
    # Only what is as urgent or more can interfere: threads above the most urgent stale one keep their response. Threads
    # without a priority (low None) always wait for everything.
    if stale_ids is not None:
        highest_stale = max(
            (urgency_of(thread.highest_priority) for thread in all_threads if not stale_ids.isdisjoint(thread.unit)),
            default=-1,
        )
        wanted_threads = [
            thread
            for thread in wanted_threads
            if thread.lowest_priority is None or thread.lowest_priority <= highest_stale
        ]
    # Joined cores: while one of their threads waits, one of the cores works. That is one core with all the work.
    response_of: dict[str, WorstResponse] = {}
    thread_bounds = (
        _leave_open(resource, wanted_threads)
        if resource.missing
        else _solve_one_core(all_threads, wanted_threads, budget)
    )
    for thread, (response, worst) in map(_soften_overload, thread_bounds) if resource.joined else thread_bounds:
        if windows is not None and worst is not None:
            windows |= dict.fromkeys(thread.unit, CoreWindow(thread, all_threads, worst))
        for name in thread.unit:
            # A declared response is taken as it is, whatever the rest of the thread does; its work still interferes
            # with others.
            declared = system.activities[name].response
            response_of[name] = response if declared is None else WorstResponse(declared, "declared")
            if declared is None and system.activities[name].wcet is None:
                response_of[name] = WorstResponse(
                    None, "unknown", unite_causes((UnknownCause((name,)), response.cause))
                )
    return response_of


def _soften_overload(thread_bound: tuple[ThreadWork, _ThreadBound]) -> tuple[ThreadWork, _ThreadBound]:
    """Replace overload: all of the joined cores may bear what is too much for one, only no bound was found."""
    thread, (response, worst) = thread_bound
    if response.cause == OVERLOAD_CAUSE:
        response = response._replace(cause=DIVERGED_CAUSE)
    return thread, _ThreadBound(response, worst)


def _leave_open(
    resource: ProcessingResource, wanted_threads: Iterable[ThreadWork]
) -> Iterable[tuple[ThreadWork, _ThreadBound]]:
    """Yield no bound for threads of which nobody knows how many cores they have, but what is too much for any core."""
    for thread in wanted_threads:
        causes = (*((thread.cause,) if thread.cause else ()), UnknownCause(resource.missing))
        cause = OVERLOAD_CAUSE if thread.share > 1 else unite_causes(causes)
        yield thread, _ThreadBound(WorstResponse(None, "unknown", cause))


def _solve_one_core(
    all_threads: Sequence[ThreadWork], wanted_threads: Sequence[ThreadWork], budget: SearchBudget
) -> Iterable[tuple[ThreadWork, _ThreadBound]]:
    """Yield the bounds of the wanted threads on one core."""
    ranked = RankedThreads(all_threads)
    any_order_bound = (
        _bound_any_order(all_threads, budget)
        if any(thread.lowest_priority is None for thread in wanted_threads)
        else None
    )
    for thread in wanted_threads:
        if any_order_bound is not None and thread.lowest_priority is None:
            is_only = len(all_threads) == 1 and len(thread.unit) > 1
            # What works only once, at the start, has no events and interferes with nobody, but still takes its own
            # time.
            once_cost = sum(work.cost for work in thread.works if not work.streams)
            response, worst = (
                _bound_any_order(all_threads, budget, once_cost, waits_on=thread.takes_no_time)
                if (once_cost or thread.takes_no_time) and any_order_bound.worst is not None
                else any_order_bound
            )
            yield thread, _ThreadBound(response._replace(tier="executor") if is_only else response, worst)
    previous_response: WorstResponse | None = None
    # By falling priority: the busy period of each level is where the search of the next begins.
    for thread in sorted(
        (t for t in wanted_threads if t.lowest_priority is not None), key=lambda t: -(t.lowest_priority or 0)
    ):
        bound = _bound_by_priority(thread, ranked, budget, previous_response)
        previous_response = bound.response
        yield thread, bound


def _bound_any_order(
    threads: Sequence[ThreadWork], budget: SearchBudget, once_cost: int = 0, *, waits_on: bool = False
) -> _ThreadBound:
    """Bound the response under any work-conserving scheduler: the longest busy period, with `once_cost` on top.

    What is alone on a core works in the order in which it is activated. What takes no time waits on (`waits_on`) where
    one busy period follows another at once.
    """
    search = longest_wait_for_turn if waits_on else longest_busy_period
    if sum_fractions(thread.share for thread in threads) >= 1:
        return _ThreadBound(WorstResponse(None, "host", OVERLOAD_CAUSE))
    causes = [thread.cause for thread in threads if thread.cause]
    if causes:
        return _ThreadBound(WorstResponse(None, "host", unite_causes(causes)))
    works = [work for thread in threads for work in thread.works]
    try:
        if len(works) == 1 and works[0].streams and threads[0].in_order:
            worst = find_lone_activation(works[0], budget, in_order=True)
        else:
            demand = add_demands(GrowingLoad(works).demand_function(), DemandFunction(lambda _: once_cost))
            worst = WorstActivation(0, 0, search(demand, budget, once_cost))
    except DivergedError:
        return _ThreadBound(WorstResponse(None, "host", DIVERGED_CAUSE))
    return _ThreadBound(WorstResponse(worst.response, "host"), worst)


def _bound_by_priority(
    thread: ThreadWork, ranked: RankedThreads, budget: SearchBudget, previous_response: WorstResponse | None
) -> _ThreadBound:
    """Bound the response of a thread below all that may have its priority or a higher one.

    Where the search for the previous, more urgent one did not end, this one, with more work in it, is not begun.
    """
    # A thread competes at its least priority, and others interfere at their greatest: members of one thread wait for
    # one another, so that any of them may be held up at the level of the least urgent.
    count = ranked.count_down_to(thread.lowest_priority or 0)
    tier: ResponseTier = "priorities" if len(thread.unit) == 1 else "executor"
    share = ranked.share_of_first(count)
    if share > 1 or (share == 1 and not _settles_at_full_load(ranked.threads[:count])):
        return _ThreadBound(WorstResponse(None, tier, OVERLOAD_CAUSE))
    cause = ranked.cause_of_first(count)
    if cause is not None:
        return _ThreadBound(WorstResponse(None, tier, cause))
    if previous_response is not None and previous_response.cause == DIVERGED_CAUSE:
        return _ThreadBound(WorstResponse(None, tier, DIVERGED_CAUSE))
    try:
        busy_period = ranked.busy_period_of_first(count, budget)
        # Activation by activation, only for a single activity; for an executor the whole busy period is the bound,
        # since its callbacks may run in any order.
        if len(thread.works) == 1 and thread.in_order:
            interference = subtract_demand(ranked.demand_of_first(count), GrowingLoad(thread.works).demand_function())
            worst = find_worst_activation(thread.works[0], interference, budget, busy_period)
        else:
            if thread.takes_no_time:
                busy_period = longest_wait_for_turn(ranked.demand_of_first(count), budget, busy_period)
            worst = WorstActivation(0, 0, busy_period)
    except DivergedError:
        return _ThreadBound(WorstResponse(None, tier, DIVERGED_CAUSE))
    return _ThreadBound(WorstResponse(worst.response, tier), worst)


def _settles_at_full_load(threads: Iterable[ThreadWork]) -> bool:
    works = [work for thread in threads for work in thread.works if work.cost]
    return settles_at_full_load([stream for work in works for stream in work.streams])
