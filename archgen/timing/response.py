"""Response times on one resource, by the tiers: any scheduler, fixed priorities, executor, several cores.

Utilisation of one or more on a core is overload; with fixed priorities exactly one is bearable where all is strictly
periodic (Burns and Wellings' process set C). Nothing is ever given that rests on a figure nobody wrote.
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
    """How much may still be computed, and for whom: `stale` are those whose event models have changed, None at first.

    `before` holds the threads of several cores as they were when their responses were found last.
    """

    budget: Budget
    stale: frozenset[str] | None = None
    before: list[Thread] | None = None


def alone(system: System, name: str, events: Events, budget: Budget) -> Found:
    """Find the response of what has no host: its own queue, on a core of its own."""
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
"""Jobs in one round of a core that is busy all the time."""
_Threads = tuple[Sequence[Thread], Sequence[Thread]]
"""Those of a resource, and the foreign ones."""


def responses(
    system: System,
    resource: Resource,
    events: Events,
    known: Mapping[str, Found],
    effort: Effort,
) -> dict[str, Found]:
    """Find the responses of what a resource runs; `known` are those found so far (they matter on several cores).

    What has a higher priority than all that is stale is left out, and so is all where nothing changed that counts.
    """
    budget, stale, before = effort
    made = [thread_of(system, unit, events, known) for unit in (*resource.units, *resource.foreign)]
    made = crowded(system, made, events)
    if before is not None and resource.cores > 1:
        if before == made:
            return {}
        before[:] = made
    threads, foreign = made[: len(resource.units)], made[len(resource.units) :]
    one_core = resource.cores == 1 or resource.joined
    if stale is not None and one_core:
        touched = max(
            (_high(thread) for thread in (*threads, *foreign) if not stale.isdisjoint(thread.unit)), default=-1
        )
        wanted = [thread for thread in threads if thread.low is None or thread.low <= touched]
    else:
        wanted = threads
    solve = _one_core if one_core else several
    found: dict[str, Found] = {}
    solved = solve(system, resource, (threads, foreign), wanted, budget)
    for thread, response in map(_of_several, solved) if resource.joined else solved:
        for name in thread.unit:
            declared = system.activities[name].response
            found[name] = response if declared is None else Found(declared, "declared")
            if declared is None and system.activities[name].wcet is None:
                found[name] = Found(None, "unknown", united((Cause((name,)), response.cause)))
    return found


def _of_several(one: tuple[Thread, Found]) -> tuple[Thread, Found]:
    """Call what is too much for one of several joined cores no overload: all of them may bear it."""
    thread, response = one
    return thread, response._replace(cause=UNBOUNDED) if response.cause == OVERLOAD else response


def _high(thread: Thread) -> int:
    return -1 if thread.high is None else thread.high


def _one_core(
    _: System, __: Resource, threads: _Threads, wanted: Sequence[Thread], budget: Budget
) -> Iterable[tuple[Thread, Found]]:
    everything = (*threads[0], *threads[1])
    ranked = _Ranked(everything)
    whole = _any_order(everything, budget) if any(thread.low is None for thread in wanted) else None
    for thread in wanted:
        if whole is not None and thread.low is None:
            only = len(everything) == 1 and len(thread.unit) > 1
            once = sum(work.cost for work in thread.works if not work.streams)
            found = _any_order(everything, budget, once) if once and whole.value is not None else whole
            yield thread, found._replace(tier="executor") if only else found
    above: Found | None = None
    for thread in sorted((t for t in wanted if t.low is not None), key=lambda t: -(t.low or 0)):
        above = _by_priority(thread, ranked, budget, above)
        yield thread, above


class _Ranked:
    """Threads by falling priority, with the share of a core that each takes together with all above it."""

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
        """Count the threads that may have this priority or a higher one."""
        return bisect_right(self.threads, -priority, key=_rank)

    def share(self, count: int) -> Fraction:
        """Give the share of a core that so many threads take."""
        return Fraction(self._shares[count], self._whole)

    def cause(self, count: int) -> Cause | None:
        """Say what is missing of so many threads; asked for in order of size."""
        added = [thread.cause for thread in self.threads[self._asked : count] if thread.cause]
        self._asked = max(count, self._asked)
        if added:
            self._causes = [united((*self._causes, *added))]
        return self._causes[0] if self._causes else None

    def busy(self, count: int, budget: Budget) -> int:
        """Give the busy period of so many threads: asked for in order of size, each is at least the one before."""
        if self._laid < count:
            for thread in self.threads[self._laid : count]:
                self.load.add(thread.works)
            self._laid = count
            self._busy = busy(self.load.demand(), budget, self._busy)
        return self._busy


def _rank(thread: Thread) -> int:
    return -(thread.high or 0)


def _any_order(threads: Sequence[Thread], budget: Budget, once: int = 0) -> Found:
    """Bound the response under any scheduler that never idles: the longest busy period, with what works `once` on top."""
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
    """Analyse one thread below all that may have its priority or a higher one.

    Where the search for what is `above` did not end, this one, with more work in it, is not begun.
    """
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
        if len(thread.works) == 1:
            others = without(ranked.load.demand(), Load(thread.works).demand())
            whole = worst(thread.works[0], others, budget, whole)
        return Found(whole, tier)
    except DivergedError:
        return Found(None, tier, DIVERGED)


def _comes_to_rest(level: Iterable[Thread]) -> bool:
    """Say whether work that takes all of a core is done at the end of each common multiple of the periods, and when."""
    works = [work for thread in level for work in thread.works if work.cost]
    streams = [stream for work in works for stream in work.streams]
    if any(stream.jitter or stream.distance or stream.number != 1 for stream in streams):
        return False
    whole = lcm(*(stream.period for stream in streams))
    return sum(whole // stream.period for stream in streams) <= _MOST_JOBS
