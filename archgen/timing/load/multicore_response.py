"""Response times on several cores that share their work, under any global work-conserving scheduler."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from archgen.timing.figures.timing_values import sum_fractions, unite_causes
from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    add_demands,
    divide_demand,
    longest_busy_period,
    subtract_demand,
    worst_response,
)
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, ThreadWork, WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import TimingSystem


def solve_several_cores(
    system: TimingSystem,
    resource: ProcessingResource,
    threads: tuple[Sequence[ThreadWork], Sequence[ThreadWork]],
    wanted_threads: Sequence[ThreadWork],
    budget: SearchBudget,
) -> Iterable[tuple[ThreadWork, WorstResponse]]:
    """Yield the responses of the wanted threads, among those of a resource and the foreign ones."""
    all_threads = (*threads[0], *threads[1])
    total_share = sum_fractions(thread.share for thread in all_threads)
    cause = unite_causes(causes) if (causes := [thread.cause for thread in all_threads if thread.cause]) else None
    carried_demand = _find_carried_demand(all_threads)
    shared_cores = _SharedCores(all_threads, total_share, carried_demand)
    for thread in wanted_threads:
        if total_share >= resource.cores or thread.share >= 1:
            yield thread, WorstResponse(None, "cores", OVERLOAD_CAUSE)
        elif cause is not None:
            yield thread, WorstResponse(None, "cores", cause)
        else:
            try:
                yield thread, _bound_global(system, resource, thread, shared_cores, budget)
            except DivergedError:
                yield thread, WorstResponse(None, "cores", DIVERGED_CAUSE)


class _SharedCores(NamedTuple):
    """All threads of some cores, their share, and the work that they carry into a window."""

    threads: Sequence[ThreadWork]
    share: Fraction
    carried_demand: DemandFunction


def _find_carried_demand(threads: Iterable[ThreadWork]) -> DemandFunction:
    """Return the demand of threads, with the jobs that may be carried into the window."""
    load = GrowingLoad()
    for thread in threads:
        load.add_carried_work(thread.works)
    return load.demand_function()


def _bound_undisturbed(thread: ThreadWork, budget: SearchBudget) -> WorstResponse:
    """Bound the response where there are no more threads than cores: nobody waits for anybody else."""
    if len(thread.works) == 1:
        return WorstResponse(worst_response(thread.works[0], NO_DEMAND, budget), "cores")
    return WorstResponse(longest_busy_period(GrowingLoad(thread.works).demand_function(), budget), "executor")


def _is_core_full(
    thread: ThreadWork, siblings: Sequence[ThreadWork], thread_limit: int, share_and_cores: tuple[Fraction, int]
) -> bool:
    """Whether a thread and its part of all other work fill a core, so that no window is long enough."""
    total_share, cores = share_and_cores
    # share + (total - share) / cores >= 1, multiplied out.
    if not siblings:  # in whole numbers: this is asked of each thread
        (own_numerator, own_denominator), (total_numerator, total_denominator) = (
            thread.share.as_integer_ratio(),
            total_share.as_integer_ratio(),
        )
        return (
            own_numerator * (cores - 1) * total_denominator + total_numerator * own_denominator
            >= cores * own_denominator * total_denominator
        )
    sibling_share = sum_fractions(t.share for t in siblings)
    return thread.share + sibling_share / thread_limit + (total_share - thread.share - sibling_share) / cores >= 1


def _bound_global(
    system: TimingSystem,
    resource: ProcessingResource,
    thread: ThreadWork,
    shared_cores: _SharedCores,
    budget: SearchBudget,
) -> WorstResponse:
    """Bound the response on several cores: while a job waits, all cores (or its container's threads) do other work."""
    all_threads, total_share, carried_demand = shared_cores
    thread_count = system.threads.get(thread.container) if thread.container else None
    # Work of the same container interferes by holding its threads: it must be divided by their number, if that is
    # smaller.
    thread_limit = min(thread_count, resource.cores) if thread_count else resource.cores
    siblings = [t for t in all_threads if t is not thread and t.container == thread.container and thread_count]
    if len(all_threads) <= resource.cores and len(siblings) < (thread_count or resource.cores):
        return _bound_undisturbed(thread, budget)
    if _is_core_full(thread, siblings, thread_limit, (total_share, resource.cores)):
        return WorstResponse(None, "cores", DIVERGED_CAUSE)
    if any(neighbour.boundless for neighbour in all_threads if neighbour is not thread):
        return WorstResponse(
            None, "cores", DIVERGED_CAUSE
        )  # what waits of it may be any amount, and comes in the way at last
    own_demand = _find_carried_demand((thread,))
    if siblings:
        sibling_demand = _find_carried_demand(siblings)
        # The lower bound of the difference needs `own_demand` and `sibling_demand` to be terms of `carried_demand` (see
        # `subtract_demand`): all three are made of the same threads.
        interference = divide_demand(
            (
                (sibling_demand, thread_limit),
                (subtract_demand(carried_demand, add_demands(own_demand, sibling_demand)), resource.cores),
            )
        )
    else:
        interference = divide_demand(((subtract_demand(carried_demand, own_demand), resource.cores),))
    if len(thread.works) == 1:
        return WorstResponse(worst_response(thread.works[0], interference, budget), "cores")
    own_work = GrowingLoad(thread.works).demand_function()
    return WorstResponse(longest_busy_period(add_demands(own_work, interference), budget), "cores")
