"""How long a message that is only stored may wait for that while its reader is activated and reads what was there before.

Let a message come, and a be the last activation whose job begins before the message is stored. The next activation reads
it, so it waits a gap at most, and the time from its coming until a. In that time it is ready to be stored, and its thread
or the cores are busy with other work: with the reader's own earlier jobs, but not with the one that a makes. So where s is
the start of that busy time, all that is done from s to a came from s on, and of the reader's own jobs at least one fewer
than can come in so long a window. The wait is no longer than the longest such window in which there is so much to do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import (
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    longest_wait_for_turn,
)
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.inner_core import urgency_of
from archgen.timing.load.response_times import RankedThreads
from archgen.timing.load.thread_work import (
    DIVERGED_CAUSE,
    OVERLOAD_CAUSE,
    EventModels,
    ThreadWork,
    WorstResponse,
    build_thread,
    lower_crowded_threads,
)
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import TimingSystem


def hold_before_activation(
    demand: DemandFunction, own_cost: int, own_streams: EventStreams, busy_period: int, budget: SearchBudget
) -> int:
    """Return the longest time (ticks) for which work can go on until an activation comes that is not part of it.

    `demand` includes `own_cost` for each event of `own_streams`.
    """

    def work_before(window: int) -> int:
        # The activation itself comes at the end of the window: with it there are no more than in a longer one.
        own_count = max_arrivals(own_streams, window) - max(max_arrivals(own_streams, window + 1) - 1, 0)
        return demand.within(window) - own_cost * own_count

    return longest_busy_window(work_before, busy_period, budget.start_search(), demand.term_count + 1)


def hold_beside_others(
    find_time_beside: Callable[[int], int],
    own_cost: int,
    own_streams: EventStreams,
    spend: Callable[[int], None],
    lower_bound: int = 1,
) -> int:
    """Return the same for a thread on several cores, of which others take so much time in a window.

    In each window shorter than `lower_bound` there must be at least as much work as it lasts.
    """
    # What is stored takes no time, as a rule: it waits on where something comes as the last work ends.
    window = lower_bound
    while (work := find_time_beside(window) + own_cost * max_arrivals(own_streams, window)) >= window:
        window = work + 1
    return longest_busy_window(
        lambda window: find_time_beside(window) + own_cost * max(max_arrivals(own_streams, window + 1) - 1, 0),
        window,
        spend,
        1,
    )


def longest_busy_window(
    work_within: Callable[[int], int], longest: int, spend: Callable[[int], None], terms_per_look: int
) -> int:
    """Return the longest window, up to `longest`, in which there is as much work as it lasts; work grows with it."""
    window = longest
    while window > 0:
        spend(terms_per_look)
        work = work_within(window)
        if work >= window:
            break
        window = max(work, 0)
    return window


def find_core_waits(
    system: TimingSystem,
    resource: ProcessingResource,
    event_models: EventModels,
    reader_ids: Iterable[str],
    budget: SearchBudget,
) -> dict[str, WorstResponse]:
    """Return the waits on one core on which nothing fires anything else, or on cores that are joined."""
    threads = [build_thread(system, unit, event_models) for unit in (*resource.units, *resource.foreign_units)]
    if len(threads) > 1 or len(threads[0].unit) > 1:  # one activity alone waits for nobody's threads
        threads = lower_crowded_threads(system, threads, event_models)
    thread_of = {name: thread for thread in threads for name in thread.unit}
    reader_list = list(reader_ids)
    if resource.missing:
        return {name: _leave_wait_open(resource, threads, thread_of[name]) for name in reader_list}
    core = _SearchedCore(system, threads, budget)
    # By falling priority: what is found for one level is where the search of the next begins.
    ranked_readers = sorted(reader_list, key=lambda name: urgency_of(thread_of[name].lowest_priority), reverse=True)
    waits = {name: core.find_wait(thread_of[name], name) for name in ranked_readers}
    return {name: waits[name] for name in reader_list}


def _leave_wait_open(resource: ProcessingResource, threads: Iterable[ThreadWork], thread: ThreadWork) -> WorstResponse:
    """Return that a wait is unknown, as nobody wrote how many cores there are."""
    causes = _list_causes(threads, thread.lowest_priority)
    return WorstResponse(None, "unknown", unite_causes((*causes, UnknownCause(resource.missing))))


def _list_causes(threads: Iterable[ThreadWork], level: int | None) -> list[UnknownCause]:
    """Return what is missing of the threads that count at a level."""
    return [
        each.cause
        for each in threads
        if each.cause and (level is None or (each.highest_priority is not None and each.highest_priority >= level))
    ]


class _SearchedCore:
    """A core of which waits are found, those of urgent threads first."""

    def __init__(self, system: TimingSystem, threads: Sequence[ThreadWork], budget: SearchBudget) -> None:
        self.system, self.threads, self.budget = system, threads, budget
        self.ranked = RankedThreads(threads)
        self.longest_wait = 0

    def find_wait(self, thread: ThreadWork, name: str) -> WorstResponse:
        """Return the wait of a reader, which is not less urgent than those before."""
        level, ranked = thread.lowest_priority, self.ranked
        if level is None:
            share = sum_fractions([each.share for each in self.threads])
            demand = GrowingLoad([work for each in self.threads for work in each.works]).demand_function()
        else:
            count = ranked.count_down_to(level)
            share, demand = ranked.share_of_first(count), ranked.demand_of_first(count)
        if share > 1:
            return WorstResponse(None, "host", OVERLOAD_CAUSE)
        causes = _list_causes(self.threads, level)
        if causes:
            return WorstResponse(None, "host", unite_causes(causes))
        own_work = thread.works[thread.unit.index(name)]
        try:
            self.longest_wait = longest_wait_for_turn(demand, self.budget, self.longest_wait)
            if may_skip_ticks(self.system, self.system.activities[name], self.longest_wait):
                # It is stored within the busy time, and the job before that does not read it has ended then.
                return WorstResponse(self.longest_wait - own_work.cost, "host")
            hold = hold_before_activation(demand, own_work.cost, own_work.streams, self.longest_wait, self.budget)
        except DivergedError:
            return WorstResponse(None, "host", OVERLOAD_CAUSE if share == 1 else DIVERGED_CAUSE)
        return WorstResponse(hold, "host")
