"""Busy windows: how long work can hold a processor, in integers.

`busy` is the longest busy period of any work-conserving scheduler. `worst` is response-time analysis over all activations
of a busy period (Lehoczky 1990, with jitter as in Tindell, Burns and Wellings 1994), from the activation itself (the jitter
before it is the event model's). `shared` bounds the interference of other work on several cores.

The least t with C + W(t) <= t is found by repetition from below. Since eta+(t) >= (t + J)/P for each stream, no t below
(C + sum of u J)/(1 - sum of u) can be it: there the repetition begins, as far ahead as the average says (M. Sjodin and
H. Hansson, "Improved Response-Time Analysis Calculations", RTSS 1998, begin so without jitter). Equal streams are one term.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from archgen.timing.streams import Stream, Streams, arrivals, eta

_STEPS = 40_000_000
"""Terms that one analysis may look at, some seconds' worth."""
_ONE_SEARCH = 6_000_000
"""Terms that one search may look at: what one of them wastes is not taken from all others."""
_ACTIVATION = 8
"""To look at one more activation takes as long as so many terms."""
_SHIFT = 64
_WHOLE = 1 << _SHIFT
"""Shares of a processor are counted in so many parts, rounded down."""


class DivergedError(Exception):
    """The cap of steps was reached: nothing can be said."""


class Budget:
    """How many terms one analysis may still look at."""

    def __init__(self, steps: int = _STEPS) -> None:
        """Start with all of them."""
        self._left = steps

    def search(self) -> Callable[[int], None]:
        """Begin a search; the answer counts its steps, and stops it where they have been too many."""
        least = max(self._left - _ONE_SEARCH, 0)

        def spend(steps: int) -> None:
            self._left -= steps
            if self._left < least:
                raise DivergedError

        return spend


class Work(NamedTuple):
    """What one activity asks of a processor: execution time and event model, and its worst response as far as known."""

    cost: int
    streams: Streams
    response: int = 0


def noted(cost: int, streams: Streams, response: int) -> Work:
    """Note work with its response where that says anything: a job that is done before the next comes is carried in alone."""
    if len(streams) == 1 and response <= _between(streams[0]):
        return Work(cost, streams)
    return Work(cost, streams, response)


def _between(stream: Stream) -> int:
    return min(stream.period // stream.number, stream.distance or stream.period)


class Demand(NamedTuple):
    """The most work that comes in a window of a length; how many terms that takes; at least `rate` t + `ahead` of it comes."""

    within: Callable[[int], int]
    size: int = 0
    rate: int = 0
    ahead: int = 0


NO_DEMAND = Demand(lambda _: 0)


class Load:
    """The work of activities in a window, sum of eta+(t) C. It grows: equal streams are laid together."""

    def __init__(self, works: Iterable[Work] = ()) -> None:
        """Begin with some."""
        self._plain: dict[tuple[int, int], int] = {}
        self._special: dict[tuple[int, int, int, int], int] = {}
        self._late: list[Work] = []
        self._once = self._rate = self._ahead = 0
        self.add(works)

    def add(self, works: Iterable[Work]) -> None:
        """Lay more work to it."""
        for cost, streams, _ in works:
            for stream in streams if cost else ():
                self._note(stream, cost)
                period, jitter, distance, number, size = stream
                if distance or number != 1:
                    key = (period, jitter, distance, number)
                    self._special[key] = self._special.get(key, 0) + cost * size
                else:
                    self._plain[period, jitter] = self._plain.get((period, jitter), 0) + cost * size

    def add_carried(self, works: Iterable[Work]) -> None:
        """Lay work to it of which one job may be carried into the window.

        More can be carried in only where responses are longer than what lies between two jobs: then all that came since
        then counts.
        """
        for work in works:
            if work.cost and work.streams:
                first = work.streams[0]
                if len(work.streams) == 1 and work.response <= _between(first):
                    self.add((work,))
                    self._once += work.cost * first.size
                else:
                    self._late.append(work)
                    for stream in work.streams:
                        self._note(stream, work.cost)

    def _note(self, stream: Stream, cost: int) -> None:
        rate, ahead = _least(stream, cost)
        self._rate, self._ahead = self._rate + rate, self._ahead + ahead

    def demand(self) -> Demand:
        """Give the work; it goes on growing with the load."""
        size = len(self._plain) + 2 * len(self._special) + 12 * sum(len(work.streams) for work in self._late) + 1
        return Demand(self._within, size, self._rate, self._ahead + (self._once << _SHIFT))

    def _within(self, window: int) -> int:
        total = self._once
        for (period, jitter), cost in self._plain.items():
            total -= -(window + jitter) // period * cost
        for (period, jitter, distance, number), cost in self._special.items():
            most = -(-(window + jitter) * number // period)
            if distance:
                most = min(most, -(-window // distance))
            total += most * cost
        for cost, streams, response in self._late:
            once = eta(streams, window) + max(stream.size for stream in streams)
            total += cost * max(once, eta(streams, window + response))
        return total


def _least(stream: Stream, cost: int) -> tuple[int, int]:
    """Give what surely comes of a stream in a window t, as rate and offset: rate t + offset, both rounded down."""
    period, jitter, distance, number, size = stream
    rate = (cost * size * number << _SHIFT) // period
    if distance:
        return min(rate, (cost * size << _SHIFT) // distance), 0
    return rate, rate * jitter


def without(whole: Demand, part: Demand) -> Demand:
    """Leave a part of some work out."""
    rest = (whole.size + part.size, whole.rate - part.rate, whole.ahead - part.ahead)
    of_whole, of_part = whole.within, part.within
    return Demand(lambda window: of_whole(window) - of_part(window), *rest)


def together(one: Demand, other: Demand) -> Demand:
    """Lay work together."""
    rest = (one.size + other.size, one.rate + other.rate, one.ahead + other.ahead)
    return Demand(lambda window: one.within(window) + other.within(window), *rest)


def busy(whole: Demand, budget: Budget, least: int = 0) -> int:
    """Give the least t > 0 in which all the work that came is done, where it is known to be `least` at least."""
    return _settle(0, whole, budget.search(), start=least)


def worst(own: Work, others: Demand, budget: Budget, whole: int = 0) -> int:
    """Give the worst response over all activations of the busy period.

    Where the busy period of all work together is known (`whole`), no job is done before it ends, unless another one has
    come by then.
    """
    times, spend = arrivals(own.streams), budget.search()
    arrived, longest, done, finish = next(times, 0), 0, 0, 0
    while True:
        spend(_ACTIVATION)
        done += own.cost
        following = next(times, None)
        least = whole if following is None else min(whole, following + 1)
        finish = _settle(done, others, spend, start=max(finish, least))
        longest = max(longest, finish - arrived)
        if following is None or finish <= following:
            return longest
        arrived = following


def shared(parts: Iterable[tuple[Demand, int]]) -> Demand:
    """Divide each part of the others' work by the number of cores (or threads) that it must hold to get in the way."""
    fixed = tuple(parts)
    if len(fixed) == 1:
        (within, size, rate, ahead), only = fixed[0][0], fixed[0][1]
        return Demand(lambda window: -(-within(window) // only), size, rate // only, ahead // only)
    return Demand(
        lambda window: sum(-(-demand.within(window) // cores) for demand, cores in fixed),
        sum(demand.size for demand, _ in fixed),
        sum(demand.rate // cores for demand, cores in fixed),
        sum(demand.ahead // cores for demand, cores in fixed),
    )


def _settle(fixed: int, others: Demand, spend: Callable[[int], None], *, start: int = 0) -> int:
    """Find the least t with fixed + others(t) <= t. A window just longer than nothing has all first jobs in it."""
    within, size, rate, ahead = others
    least = ((fixed << _SHIFT) + ahead) // (_WHOLE - rate) if rate < _WHOLE else 0
    window = max(start, fixed, least, 1)
    while True:
        spend(size + 1)
        needed = fixed + within(window)
        if needed <= window:
            return needed if window == 1 else window
        window = needed
