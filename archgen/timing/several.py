"""Response times on several cores that share their work, under any global work-conserving scheduler."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from archgen.timing.placement import Resource
from archgen.timing.system import System
from archgen.timing.threads import DIVERGED, OVERLOAD, UNBOUNDED, Found, Thread
from archgen.timing.value import added, united
from archgen.timing.windows import (
    NO_DEMAND,
    Budget,
    Demand,
    DivergedError,
    Load,
    busy,
    shared,
    together,
    without,
    worst,
)


def several(
    system: System,
    resource: Resource,
    threads: tuple[Sequence[Thread], Sequence[Thread]],
    wanted: Sequence[Thread],
    budget: Budget,
) -> Iterable[tuple[Thread, Found]]:
    """Yield the responses of the wanted threads, among those of a resource and the foreign ones."""
    everything = (*threads[0], *threads[1])
    total = added(thread.share for thread in everything)
    cause = united(causes) if (causes := [thread.cause for thread in everything if thread.cause]) else None
    carried = _carried(everything)
    whole = _Whole(everything, total, carried)
    for thread in wanted:
        if total >= resource.cores or thread.share >= 1:
            yield thread, Found(None, "cores", OVERLOAD)
        elif cause is not None:
            yield thread, Found(None, "cores", cause)
        else:
            try:
                yield thread, _global(system, resource, thread, whole, budget)
            except DivergedError:
                yield thread, Found(None, "cores", DIVERGED)


class _Whole(NamedTuple):
    """All threads of some cores, their share, and the work that they carry into a window."""

    threads: Sequence[Thread]
    share: Fraction
    carried: Demand


def _carried(threads: Iterable[Thread]) -> Demand:
    """Return the demand of threads, with the jobs that may be carried into the window."""
    load = Load()
    for thread in threads:
        load.add_carried(thread.works)
    return load.demand()


def _undisturbed(thread: Thread, budget: Budget) -> Found:
    """Bound the response where there are no more threads than cores: nobody waits for anybody else."""
    if len(thread.works) == 1:
        return Found(worst(thread.works[0], NO_DEMAND, budget), "cores")
    return Found(busy(Load(thread.works).demand(), budget), "executor")


def _is_unbounded(thread: Thread, beside: Sequence[Thread], narrow: int, whole: tuple[Fraction, int]) -> bool:
    """Whether a thread and its part of all other work fill a core, so that no window is long enough."""
    total, cores = whole
    # share + (total - share) / cores >= 1, multiplied out.
    if not beside:  # in whole numbers: this is asked of each thread
        (share, part), (all_, parts) = thread.share.as_integer_ratio(), total.as_integer_ratio()
        return share * (cores - 1) * parts + all_ * part >= cores * part * parts
    around = added(t.share for t in beside)
    return thread.share + around / narrow + (total - thread.share - around) / cores >= 1


def _global(system: System, resource: Resource, thread: Thread, whole: _Whole, budget: Budget) -> Found:
    """Bound the response on several cores: while a job waits, all cores (or its container's threads) do other work."""
    everything, total, carried = whole
    threads = system.threads.get(thread.container) if thread.container else None
    # Work of the same container interferes by holding its threads: it must be divided by their number, if that is
    # smaller.
    narrow = min(threads, resource.cores) if threads else resource.cores
    beside = [t for t in everything if t is not thread and t.container == thread.container and threads]
    if len(everything) <= resource.cores and len(beside) < (threads or resource.cores):
        return _undisturbed(thread, budget)
    if _is_unbounded(thread, beside, narrow, (total, resource.cores)):
        return Found(None, "cores", UNBOUNDED)
    if any(other.boundless for other in everything if other is not thread):
        return Found(None, "cores", UNBOUNDED)  # what waits of it may be any amount, and comes in the way at last
    own = _carried((thread,))
    if beside:
        near = _carried(beside)
        # The lower bound of the difference needs `own_demand` and `sibling_demand` to be terms of `carried_demand` (see
        # `subtract_demand`): all three are made of the same threads.
        others = shared(((near, narrow), (without(carried, together(own, near)), resource.cores)))
    else:
        others = shared(((without(carried, own), resource.cores),))
    if len(thread.works) == 1:
        return Found(worst(thread.works[0], others, budget), "cores")
    alone_here = len(beside) + 1 == len(everything)
    return Found(busy(together(Load(thread.works).demand(), others), budget), "executor" if alone_here else "cores")
