"""Response times on one resource, by tier: any scheduler, fixed priorities, executor, several cores.

A utilisation of one or more on a core is overload; with fixed priorities exactly one is bearable where everything is
strictly periodic (Burns and Wellings' process set C). No result rests on a figure that nobody wrote.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import accumulate
from math import lcm
from typing import NamedTuple

from archgen.timing.analysis import Tier
from archgen.timing.placement import Resource
from archgen.timing.several import several
from archgen.timing.system import System
from archgen.timing.threads import (
    DIVERGED,
    OVERLOAD,
    UNBOUNDED,
    Events,
    Found,
    Thread,
    crowded,
    thread_of,
    utilisation,
    work_of,
)
from archgen.timing.value import Cause, added, united
from archgen.timing.windows import (
    NO_DEMAND,
    Budget,
    Demand,
    DivergedError,
    Load,
    busy,
    together,
    without,
    worst,
)


class Effort(NamedTuple):
    """How much may still be computed, and for whom.

    `stale_ids` are those whose event models have changed, None at first. `previous_threads` holds the threads of
    several cores as they were when responses were last found; `find_responses` writes to it.
    """

    budget: Budget
    stale: frozenset[str] | None = None
    before: list[Thread] | None = None


def alone(system: System, name: str, events: Events, budget: Budget) -> Found:
    """Return the response of an activity without a host: its own queue, on a core of its own."""
    activity = system.activities[name]
    if activity.response is not None:
        return Found(activity.response, "declared")
    works = work_of(system, name, events, {})
    if isinstance(works, Cause):
        return Found(None, "dedicated" if activity.wcet is not None else "unknown", works)
    if utilisation(works.cost, works.streams) >= 1:
        return Found(None, "dedicated", OVERLOAD)
    try:
        return Found(worst(works, NO_DEMAND, budget), "dedicated")
    except DivergedError:
        return Found(None, "dedicated", DIVERGED)


_MOST_JOBS = 20_000
"""Most jobs in the hyperperiod of a core that is busy all the time."""
_Threads = tuple[Sequence[Thread], Sequence[Thread]]
"""The threads of a resource, and the foreign ones."""


def responses(
    system: System,
    resource: Resource,
    events: Events,
    known: Mapping[str, Found],
    effort: Effort,
) -> dict[str, Found]:
    """Return the responses of what a resource runs.

    `known_responses` are those found so far; they matter on several cores. What has a higher priority than everything
    stale is left out, and so is everything where nothing changed that counts.
    """
    budget, stale, before = effort
    made = [thread_of(system, unit, events, known) for unit in (*resource.units, *resource.foreign)]
    made = crowded(system, made, events)
    # On several cores each response rests on all others; if no thread differs from last time, neither does any
    # response.
    if before is not None and resource.cores > 1:
        if before == made:
            return {}
        before[:] = made
    threads, foreign = made[: len(resource.units)], made[len(resource.units) :]
    one_core = resource.cores == 1 or resource.joined
    # On one core only what is as urgent or more can interfere: threads above the most urgent stale one keep their
    # response. Threads without a priority (low None) always wait for everything.
    if stale is not None and one_core:
        touched = max(
            (_high(thread) for thread in (*threads, *foreign) if not stale.isdisjoint(thread.unit)), default=-1
        )
        wanted = [thread for thread in threads if thread.low is None or thread.low <= touched]
    else:
        wanted = threads
    # Joined cores: while one of their threads waits, one of the cores works. That is one core with all the work.
    solve = _one_core if one_core else several
    found: dict[str, Found] = {}
    solved = solve(system, resource, (threads, foreign), wanted, budget)
    for thread, response in map(_of_several, solved) if resource.joined else solved:
        for name in thread.unit:
            # A declared response is taken as it is, whatever the rest of the thread does; its work still interferes
            # with others.
            declared = system.activities[name].response
            found[name] = response if declared is None else Found(declared, "declared")
            if declared is None and system.activities[name].wcet is None:
                found[name] = Found(None, "unknown", united((Cause((name,)), response.cause)))
    return found


def _of_several(one: tuple[Thread, Found]) -> tuple[Thread, Found]:
    """Replace overload by unbounded: all of the joined cores may bear what is too much for one."""
    thread, response = one
    return thread, response._replace(cause=UNBOUNDED) if response.cause == OVERLOAD else response


def _high(thread: Thread) -> int:
    """Return the greatest priority of a thread, -1 where it has none."""
    return -1 if thread.high is None else thread.high


def _one_core(
    _: System, __: Resource, threads: _Threads, wanted: Sequence[Thread], budget: Budget
) -> Iterable[tuple[Thread, Found]]:
    """Yield the responses of the wanted threads on one core."""
    everything = (*threads[0], *threads[1])
    ranked = _Ranked(everything)
    whole = _any_order(everything, budget) if any(thread.low is None for thread in wanted) else None
    for thread in wanted:
        if whole is not None and thread.low is None:
            only = len(everything) == 1 and len(thread.unit) > 1
            # What works only once, at the start, has no events and interferes with nobody, but still takes its own
            # time.
            once = sum(work.cost for work in thread.works if not work.streams)
            found = _any_order(everything, budget, once) if once and whole.value is not None else whole
            yield thread, found._replace(tier="executor") if only else found
    above: Found | None = None
    # By falling priority: `_RankedThreads` builds each level's load and busy period on the one before.
    for thread in sorted((t for t in wanted if t.low is not None), key=lambda t: -(t.low or 0)):
        above = _by_priority(thread, ranked, budget, above)
        yield thread, above


class _Ranked:
    """Threads by falling priority, with the share of a core that each takes together with all above it.

    `cause_of_first` and `busy_period_of_first` must be asked in order of growing counts: they keep what they have added
    up.
    """

    def __init__(self, threads: Iterable[Thread]) -> None:
        self.threads = sorted((t for t in threads if t.high is not None), key=_rank)
        pairs = [thread.share.as_integer_ratio() for thread in self.threads]
        self._whole = lcm(*[denominator for _, denominator in pairs])
        self._shares = tuple(accumulate((above * (self._whole // below) for above, below in pairs), initial=0))
        self.load = Load()
        self._laid = self._busy = 0
        self._causes: list[Cause] = []
        self._asked = 0

    def down_to(self, priority: int) -> int:
        """Return how many threads may have this priority or a higher one."""
        return bisect_right(self.threads, -priority, key=_rank)

    def share(self, count: int) -> Fraction:
        """Return the share of a core that the first threads take."""
        return Fraction(self._shares[count], self._whole)

    def cause(self, count: int) -> Cause | None:
        """Return what is missing of the first threads, None where nothing is."""
        added = [thread.cause for thread in self.threads[self._asked : count] if thread.cause]
        self._asked = max(count, self._asked)
        if added:
            self._causes = [united((*self._causes, *added))]
        return self._causes[0] if self._causes else None

    def busy(self, count: int, budget: Budget) -> int:
        """Return the busy period of the first threads. The last one is a lower bound, where the search begins."""
        if self._laid < count:
            for thread in self.threads[self._laid : count]:
                self.load.add(thread.works)
            self._laid = count
            self._busy = busy(self.load.demand(), budget, self._busy)
        return self._busy


def _rank(thread: Thread) -> int:
    """Sort key: threads by falling greatest priority."""
    return -(thread.high or 0)


def _any_order(threads: Sequence[Thread], budget: Budget, once: int = 0) -> Found:
    """Bound the response under any work-conserving scheduler: the longest busy period, with `once_cost` on top."""
    if added(thread.share for thread in threads) >= 1:
        return Found(None, "host", OVERLOAD)
    causes = [thread.cause for thread in threads if thread.cause]
    if causes:
        return Found(None, "host", united(causes))
    try:
        whole = Load(work for thread in threads for work in thread.works)
        return Found(busy(together(whole.demand(), Demand(lambda _: once)), budget, once), "host")
    except DivergedError:
        return Found(None, "host", DIVERGED)


def _by_priority(thread: Thread, ranked: _Ranked, budget: Budget, above: Found | None) -> Found:
    """Bound the response of a thread below all that may have its priority or a higher one.

    Where the search for the previous, more urgent one did not end, this one, with more work in it, is not begun.
    """
    # A thread competes at its least priority, and others interfere at their greatest: members of one thread wait for
    # one another, so that any of them may be held up at the level of the least urgent.
    count = ranked.down_to(thread.low or 0)
    tier: Tier = "priorities" if len(thread.unit) == 1 else "executor"
    share = ranked.share(count)
    if share > 1 or (share == 1 and not _comes_to_rest(ranked.threads[:count])):
        return Found(None, tier, OVERLOAD)
    cause = ranked.cause(count)
    if cause is not None:
        return Found(None, tier, cause)
    if above is not None and above.cause == DIVERGED:
        return Found(None, tier, DIVERGED)
    try:
        whole = ranked.busy(count, budget)
        # Activation by activation, only for a single activity; for an executor the whole busy period is the bound,
        # since its callbacks may run in any order.
        if len(thread.works) == 1:
            others = without(ranked.load.demand(), Load(thread.works).demand())
            whole = worst(thread.works[0], others, budget, whole)
        return Found(whole, tier)
    except DivergedError:
        return Found(None, tier, DIVERGED)


def _comes_to_rest(level: Iterable[Thread]) -> bool:
    """Whether work that fills a core is sure to be done at the end of each hyperperiod."""
    works = [work for thread in level for work in thread.works if work.cost]
    streams = [stream for work in works for stream in work.streams]
    if any(stream.jitter or stream.distance or stream.number != 1 for stream in streams):
        return False
    # Strictly periodic work with a load of exactly 1 is done at each common multiple of the periods. Any jitter would
    # let the busy period go on for ever.
    whole = lcm(*(stream.period for stream in streams))
    # A longer hyperperiod would not be searched to its end within the budget.
    return sum(whole // stream.period for stream in streams) <= _MOST_JOBS
