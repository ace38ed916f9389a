"""Response times on one resource, by the tiers: any scheduler, fixed priorities, executor, several cores.

Utilisation of one or more on a core is overload. Nothing is ever given that rests on a figure nobody wrote.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from typing import NamedTuple

from archgen.timing.analysis import Tier
from archgen.timing.placement import Resource, Unit
from archgen.timing.streams import Streams
from archgen.timing.system import System
from archgen.timing.value import Cause, united
from archgen.timing.windows import Budget, Demand, DivergedError, Work, busy, carried, demand, shared, worst

_NO_DEMAND: tuple[Demand, int] = (lambda _: 0, 0)


class Found(NamedTuple):
    """A worst response in ticks, or why there is none."""

    value: int | None
    tier: Tier
    cause: Cause = Cause()


class Effort(NamedTuple):
    """How much may still be computed, and for whom: `stale` are those whose event models have changed, None at first."""

    budget: Budget
    stale: frozenset[str] | None = None


Events = Mapping[str, Streams | Cause]
OVERLOAD, UNBOUNDED, DIVERGED = Cause(notes=("overload",)), Cause(notes=("unbounded",)), Cause(notes=("diverged",))


def utilisation(cost: int, streams: Streams) -> Fraction:
    """Give the share of a core that an activity takes."""
    return sum((stream.rate for stream in streams), Fraction(0)) * cost


def alone(system: System, name: str, events: Events, budget: Budget) -> Found:
    """Find the response of what has no host: its own queue, on a core of its own."""
    activity = system.activities[name]
    if activity.response is not None:
        return Found(activity.response, "declared")
    works = _work(system, name, events, {})
    if isinstance(works, Cause):
        return Found(None, "dedicated" if activity.wcet is not None else "unknown", works)
    if utilisation(works.cost, works.streams) >= 1:
        return Found(None, "dedicated", OVERLOAD)
    try:
        return Found(worst(works, *_NO_DEMAND, budget), "dedicated")
    except DivergedError:
        return Found(None, "dedicated", DIVERGED)


def _work(system: System, name: str, events: Events, known: Mapping[str, Found]) -> Work | Cause:
    cost, streams = system.activities[name].wcet, events[name]
    if cost == 0:
        return Work(0, () if isinstance(streams, Cause) else streams)
    if cost is None or isinstance(streams, Cause):
        unwritten = Cause((name,)) if cost is None else Cause()
        return united((unwritten, streams)) if isinstance(streams, Cause) else unwritten
    found = known.get(name)
    return Work(cost, streams, (found.value or 0) if found else 0)


@dataclass(frozen=True, slots=True)
class _Thread:
    """A unit with its work: `low` and `high` are the least and greatest priority of its members, None for ordinary ones.

    Where the container has fewer threads than members, `low` is the least of all of these.
    """

    unit: Unit
    works: tuple[Work, ...]
    cause: Cause | None
    low: int | None
    high: int | None
    share: Fraction
    container: str | None


_Threads = tuple[Sequence[_Thread], Sequence[_Thread]]
"""Those of a resource, and the foreign ones."""


def _lows(system: System, units: Iterable[Unit], events: Events) -> dict[str, int | None]:
    """Give the least priority in each container with fewer threads than members: who waits for a thread waits for it too."""
    members: dict[str, list[str]] = {}
    for unit in units:
        container = system.activities[unit[0]].container
        if container is not None and (system.threads.get(container) or 1) > 1:
            members.setdefault(container, []).extend(name for name in unit if events[name] != ())
    return {
        container: _least(system, names)
        for container, names in members.items()
        if len(names) > (system.threads[container] or len(names))
    }


def _least(system: System, names: Iterable[str]) -> int | None:
    priorities = [system.activities[name].priority for name in names]
    written = [one for one in priorities if one is not None]
    return min(written) if len(written) == len(priorities) else None


def _thread(
    system: System, unit: Unit, events: Events, known: Mapping[str, Found], lows: Mapping[str, int | None]
) -> _Thread:
    found = [_work(system, name, events, known) for name in unit]
    causes = [one for one in found if isinstance(one, Cause)]
    works = tuple(one for one in found if isinstance(one, Work))
    container = system.activities[unit[0]].container
    written = [one for name in unit if (one := system.activities[name].priority) is not None]
    return _Thread(
        unit,
        works,
        united(causes) if causes else None,
        lows[container] if container is not None and container in lows else _least(system, unit),
        max(written, default=None),
        sum((utilisation(work.cost, work.streams) for work in works), Fraction(0)),
        container,
    )


def responses(
    system: System,
    resource: Resource,
    events: Events,
    known: Mapping[str, Found],
    effort: Effort,
) -> dict[str, Found]:
    """Find the responses of what a resource runs; `known` are those found so far (they matter on several cores).

    What has a higher priority than all that is stale is left out.
    """
    budget, stale = effort
    lows = _lows(system, (*resource.units, *resource.foreign), events)
    threads = [_thread(system, unit, events, known, lows) for unit in resource.units]
    foreign = [_thread(system, unit, events, known, lows) for unit in resource.foreign]
    if stale is not None and resource.cores == 1:
        touched = max(
            (_high(thread) for thread in (*threads, *foreign) if not stale.isdisjoint(thread.unit)), default=-1
        )
        wanted = [thread for thread in threads if thread.low is None or thread.low <= touched]
    else:
        wanted = threads
    solve = _one_core if resource.cores == 1 else _several
    found: dict[str, Found] = {}
    for thread, response in solve(system, resource, (threads, foreign), wanted, budget):
        for name in thread.unit:
            declared = system.activities[name].response
            found[name] = response if declared is None else Found(declared, "declared")
            if declared is None and system.activities[name].wcet is None:
                found[name] = Found(None, "unknown", united((Cause((name,)), response.cause)))
    return found


def _high(thread: _Thread) -> int:
    return -1 if thread.high is None else thread.high


def _one_core(
    _: System, __: Resource, threads: _Threads, wanted: Sequence[_Thread], budget: Budget
) -> Iterable[tuple[_Thread, Found]]:
    everything = (*threads[0], *threads[1])
    ranked = _Ranked(everything)
    whole = _any_order(everything, budget) if any(thread.low is None for thread in wanted) else None
    for thread in wanted:
        if whole is not None and thread.low is None:
            only = len(everything) == 1 and len(thread.unit) > 1
            yield thread, whole._replace(tier="executor") if only else whole
        else:
            yield thread, _by_priority(thread, ranked, budget)


class _Ranked:
    """Threads by falling priority, with the share of a core that each takes together with all above it."""

    def __init__(self, threads: Iterable[_Thread]) -> None:
        self.threads = sorted((t for t in threads if t.high is not None), key=_rank)
        self.shares = tuple(accumulate((thread.share for thread in self.threads), initial=Fraction(0)))

    def down_to(self, priority: int) -> int:
        """Count the threads that may have this priority or a higher one."""
        return bisect_right(self.threads, -priority, key=_rank)


def _rank(thread: _Thread) -> int:
    return -(thread.high or 0)


def _any_order(threads: Sequence[_Thread], budget: Budget) -> Found:
    """Bound the response under any scheduler that never idles: the longest busy period."""
    if sum((thread.share for thread in threads), Fraction(0)) >= 1:
        return Found(None, "host", OVERLOAD)
    causes = [thread.cause for thread in threads if thread.cause]
    if causes:
        return Found(None, "host", united(causes))
    try:
        return Found(busy([work for thread in threads for work in thread.works], budget), "host")
    except DivergedError:
        return Found(None, "host", DIVERGED)


def _by_priority(thread: _Thread, ranked: _Ranked, budget: Budget) -> Found:
    """Analyse one thread below all that may have its priority or a higher one."""
    count = ranked.down_to(thread.low or 0)
    tier: Tier = "priorities" if len(thread.unit) == 1 else "executor"
    if ranked.shares[count] >= 1:
        return Found(None, tier, OVERLOAD)
    level = ranked.threads[:count]
    causes = [one.cause for one in level if one.cause]
    if causes:
        return Found(None, tier, united(causes))
    others, steps = demand(work for other in level if other is not thread for work in other.works)
    try:
        if len(thread.works) == 1:
            return Found(worst(thread.works[0], others, steps, budget), tier)
        return Found(busy(thread.works, budget, others, steps), tier)
    except DivergedError:
        return Found(None, tier, DIVERGED)


def _several(
    system: System, resource: Resource, threads: _Threads, wanted: Sequence[_Thread], budget: Budget
) -> Iterable[tuple[_Thread, Found]]:
    everything = (*threads[0], *threads[1])
    total = sum((thread.share for thread in everything), Fraction(0))
    causes = [thread.cause for thread in everything if thread.cause]
    for thread in wanted:
        if total >= resource.cores or thread.share >= 1:
            yield thread, Found(None, "cores", OVERLOAD)
        elif causes:
            yield thread, Found(None, "cores", united(causes))
        else:
            try:
                yield thread, _global(system, resource, thread, everything, budget)
            except DivergedError:
                yield thread, Found(None, "cores", DIVERGED)


def _undisturbed(thread: _Thread, budget: Budget) -> Found:
    """Bound the response where there are no more threads than cores: nobody waits for anybody else."""
    if len(thread.works) == 1:
        return Found(worst(thread.works[0], *_NO_DEMAND, budget), "cores")
    return Found(busy(thread.works, budget), "executor")


def _global(
    system: System, resource: Resource, thread: _Thread, everything: Sequence[_Thread], budget: Budget
) -> Found:
    """Bound the response on several cores: while a job waits, all cores (or its container's threads) do other work."""
    threads = system.threads.get(thread.container) if thread.container else None
    narrow = min(threads, resource.cores) if threads else resource.cores
    beside = [t for t in everything if t is not thread and t.container == thread.container and threads]
    if len(everything) <= resource.cores and len(beside) < (threads or resource.cores):
        return _undisturbed(thread, budget)
    rest = [t for t in everything if t is not thread and t not in beside]
    share = thread.share + sum((t.share for t in beside), Fraction(0)) / narrow
    if share + sum((t.share for t in rest), Fraction(0)) / resource.cores >= 1:
        return Found(None, "cores", UNBOUNDED)
    near, near_steps = carried(work for t in beside for work in t.works)
    far, far_steps = carried(work for t in rest for work in t.works)
    others, steps = shared(((near, narrow), (far, resource.cores))), near_steps + far_steps
    if len(thread.works) == 1:
        return Found(worst(thread.works[0], others, steps, budget), "cores")
    return Found(busy(thread.works, budget, others, steps), "cores" if rest else "executor")
