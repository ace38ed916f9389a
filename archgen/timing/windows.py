"""Busy windows: how long work can hold a processor, in integers.

`busy` is the longest busy period of any work-conserving scheduler. `worst` is response-time analysis over all activations
of a busy period (Lehoczky 1990, with jitter as in Tindell, Burns and Wellings 1994), from the activation itself (the jitter
before it is the event model's). `shared` bounds the interference of other work on several cores.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from archgen.timing.streams import Streams, arrivals, eta

_STEPS = 6_000_000


class DivergedError(Exception):
    """The cap of steps was reached: nothing can be said."""


class Budget:
    """How many evaluations of event models one analysis may still make."""

    def __init__(self, steps: int = _STEPS) -> None:
        """Start with all of them."""
        self._left = steps

    def spend(self, steps: int) -> None:
        """Count, and stop where it has been too much."""
        self._left -= steps
        if self._left < 0:
            raise DivergedError


class Work(NamedTuple):
    """What one activity asks of a processor: execution time and event model, and its worst response as far as known."""

    cost: int
    streams: Streams
    response: int = 0


Demand = Callable[[int], int]
"""The most work that others put into a window of a length."""


def demand(works: Iterable[Work]) -> tuple[Demand, int]:
    """Give the work in a window, sum of eta+(t) C, and the number of its streams."""
    plain: list[tuple[int, int, int]] = []
    special: list[tuple[int, Streams]] = []
    for cost, streams, _ in works:
        if not cost:
            continue
        for stream in streams:
            if stream.distance or stream.number != 1:
                special.append((cost, (stream,)))
            else:
                plain.append((stream.period, stream.jitter, cost * stream.size))

    def within(window: int) -> int:
        total = 0
        for period, jitter, cost in plain:
            total -= -(window + jitter) // period * cost
        for cost, streams in special:
            total += cost * eta(streams, window)
        return total

    return within, len(plain) + 4 * len(special) + 1


def busy(works: Sequence[Work], budget: Budget, others: Demand | None = None, size: int = 0) -> int:
    """Give the least t > 0 in which all the work that came is done; `others` is what interferes besides."""
    own, steps = demand(works)
    both = own if others is None else _sum(own, others)
    return _settle(0, both, steps + size, budget)


def _sum(one: Demand, other: Demand) -> Demand:
    return lambda window: one(window) + other(window)


def worst(own: Work, others: Demand, size: int, budget: Budget) -> int:
    """Give the worst response over all activations of the busy period."""
    times = arrivals(own.streams)
    arrived, longest, done, finish = next(times, 0), 0, 0, 0
    while True:
        done += own.cost
        finish = _settle(done, others, size, budget, start=finish)
        longest = max(longest, finish - arrived)
        following = next(times, None)
        if following is None or finish <= following:
            return longest
        arrived = following


def carried(works: Iterable[Work]) -> tuple[Demand, int]:
    """Give the work in a window that may begin with one job of each carried in.

    More can be carried in only where responses are longer than periods: then all that came since then counts.
    """
    known = tuple(work for work in works if work.cost and work.streams)

    def within(window: int) -> int:
        total = 0
        for cost, streams, response in known:
            once = eta(streams, window) + max(stream.size for stream in streams)
            total += cost * max(once, eta(streams, window + response))
        return total

    return within, 4 * sum(len(work.streams) for work in known) + 1


def shared(parts: Iterable[tuple[Demand, int]]) -> Demand:
    """Divide each part of the others' work by the number of cores (or threads) that it must hold to get in the way."""
    fixed = tuple(parts)
    return lambda window: sum(-(-within(window) // cores) for within, cores in fixed)


def _settle(fixed: int, others: Demand, size: int, budget: Budget, *, start: int = 0) -> int:
    """Find the least t with fixed + others(t) <= t. A window just longer than nothing has all first jobs in it."""
    window = max(start, fixed, 1)
    while True:
        budget.spend(size)
        needed = fixed + others(window)
        if needed <= window:
            return needed if window == 1 else window
        window = needed
