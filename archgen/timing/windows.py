"""Busy windows: how long work can hold a processor, in integer ticks.

`longest_busy_period` holds for any work-conserving scheduler. `worst_response` is response-time analysis over all
activations of a busy period (Lehoczky 1990, with jitter as in Tindell, Burns and Wellings 1994), counted from the
activation itself (the jitter before it belongs to the event model). `divide_demand` bounds the interference of other
work on several cores.

The least t with C + W(t) <= t is found by repetition from below. Since eta+(t) >= (t + J)/P for each stream, no t below
(C + sum of u J)/(1 - sum of u) can be it: the repetition begins there, as far ahead as the average says (M. Sjodin and
H. Hansson, "Improved Response-Time Analysis Calculations", RTSS 1998, begin so without jitter). Streams of equal period
and jitter are one term.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from archgen.timing.streams import Stream, Streams, arrivals, eta

_STEPS = 40_000_000
"""Terms that one analysis may look at: some seconds' worth."""
_ONE_SEARCH = 6_000_000
"""Terms that one search may look at, so that one that does not end leaves most of the budget to all others."""
_ACTIVATION = 8
"""Looking at one more activation takes as long as so many terms."""
# Fixed-point numbers, not Fractions: the start of a search is only a lower bound, so that rounding down is safe.
_SHIFT = 64
_WHOLE = 1 << _SHIFT
"""A whole processor, in the parts that shares are counted in."""


class DivergedError(Exception):
    """The budget is used up: nothing can be said."""


class Budget:
    """How many terms one analysis may still look at: terms and not seconds, so that results can be repeated."""

    def __init__(self, steps: int = _STEPS) -> None:
        """Start with the whole budget."""
        self._left = steps

    def search(self) -> Callable[[int], None]:
        """Begin a search: the returned function spends terms, and raises DivergedError after too many."""
        least = max(self._left - _ONE_SEARCH, 0)

        def spend(steps: int) -> None:
            self._left -= steps
            if self._left < least:
                raise DivergedError

        return spend


class Work(NamedTuple):
    """What one activity asks of a processor: execution time and event model, and its worst response if it matters."""

    cost: int
    streams: Streams
    response: int = 0


def noted(cost: int, streams: Streams, response: int) -> Work:
    """Return work, with its response only where that can have more than one job carried into a window."""
    # Dropping a response that does not matter keeps works equal while the fixed point goes on, and equal threads need
    # no second look (`find_responses`).
    if len(streams) == 1 and response <= _between(streams[0]):
        return Work(cost, streams)
    return Work(cost, streams, response)


def _between(stream: Stream) -> int:
    """Return the least time between two jobs of a stream, jitter aside."""
    return min(stream.period // stream.number, stream.distance or stream.period)


class Demand(NamedTuple):
    """The most work that comes in a window of a length (a request bound function).

    `term_count` is the cost of a look; at least `scaled_rate` t + `scaled_offset` of it comes, in 2^-64 ticks.
    """

    within: Callable[[int], int]
    size: int = 0
    rate: int = 0
    ahead: int = 0


NO_DEMAND = Demand(lambda _: 0)


class Load:
    """The work of activities in a window, sum of eta+(t) C; works can be added, and equal streams are one term."""

    def __init__(self, works: Iterable[Work] = ()) -> None:
        """Begin with some work."""
        self._plain: dict[tuple[int, int], int] = {}
        self._special: dict[tuple[int, int, int, int], int] = {}
        self._late: list[Work] = []
        self._once = self._rate = self._ahead = 0
        self.add(works)

    def add(self, works: Iterable[Work]) -> None:
        """Add work."""
        for cost, streams, _ in works:
            for stream in streams if cost else ():
                self._note(stream, cost)
                period, jitter, distance, number, size = stream
                # Two tables, because nearly all streams are plain ones, and their term is a single division.
                if distance or number != 1:
                    key = (period, jitter, distance, number)
                    self._special[key] = self._special.get(key, 0) + cost * size
                else:
                    self._plain[period, jitter] = self._plain.get((period, jitter), 0) + cost * size

    def add_carried(self, works: Iterable[Work]) -> None:
        """Add work of which jobs may be carried into the window: they came before it, and are not done yet.

        One job is, unless responses are longer than the time between two jobs: then everything that came within a
        response counts.
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
        """Add a stream to the lower bound of all demand."""
        rate, ahead = _least(stream, cost)
        self._rate, self._ahead = self._rate + rate, self._ahead + ahead

    def demand(self) -> Demand:
        """Return the demand function. It is a live view: it goes on growing with the load."""
        # What one look costs, by the three kinds of terms in `_demand_within`.
        size = len(self._plain) + 2 * len(self._special) + 12 * sum(len(work.streams) for work in self._late) + 1
        return Demand(self._within, size, self._rate, self._ahead + (self._once << _SHIFT))

    def _within(self, window: int) -> int:
        """Return the most work in a window."""
        total = self._once
        for (period, jitter), cost in self._plain.items():
            total -= -(window + jitter) // period * cost
        for (period, jitter, distance, number), cost in self._special.items():
            most = -(-(window + jitter) * number // period)
            if distance:
                most = min(most, -(-window // distance))
            total += most * cost
        for cost, streams, response in self._late:
            # Never less than one whole batch on top of what comes inside the window.
            once = eta(streams, window) + max(stream.size for stream in streams)
            total += cost * max(once, eta(streams, window + response))
        return total


def _least(stream: Stream, cost: int) -> tuple[int, int]:
    """Return a lower bound of a stream's work in a window t: rate and offset of rate t + offset, both rounded down."""
    period, jitter, distance, number, size = stream
    rate = (cost * size * number << _SHIFT) // period
    if distance:
        # eta-plus is the smaller of (t + J) / P and t / d, of which the second has no offset: only the rate is sure.
        return min(rate, (cost * size << _SHIFT) // distance), 0
    return rate, rate * jitter


def without(whole: Demand, part: Demand) -> Demand:
    """Return what is left of some demand without a part of it.

    The part must be contained in the whole term by term, else the lower bound of the difference is none.
    """
    rest = (whole.size + part.size, whole.rate - part.rate, whole.ahead - part.ahead)
    of_whole, of_part = whole.within, part.within
    return Demand(lambda window: of_whole(window) - of_part(window), *rest)


def together(one: Demand, other: Demand) -> Demand:
    """Return the sum of two demands."""
    rest = (one.size + other.size, one.rate + other.rate, one.ahead + other.ahead)
    return Demand(lambda window: one.within(window) + other.within(window), *rest)


def busy(whole: Demand, budget: Budget, least: int = 0) -> int:
    """Return the least t > 0 in which all work that came is done; `lower_bound` must not be above it."""
    return _settle(0, whole, budget.search(), start=least)


def worst(own: Work, others: Demand, budget: Budget, whole: int = 0) -> int:
    """Return the worst response over all activations of the busy period.

    Where the length of the busy period of all work together is known (`busy_period`), no job ends before it, unless
    another job has come by then.
    """
    times, spend = arrivals(own.streams), budget.search()
    arrived, longest, done, finish = next(times, 0), 0, 0, 0
    while True:
        spend(_ACTIVATION)
        # The q-th job ends at the least t = q C + W(t). The next one matters only if it comes before that: else the
        # busy period of this level is over, and the next job begins a new one that cannot be worse.
        done += own.cost
        following = next(times, None)
        # Must never be above the true end, or the search would step over the least fixed point. If this job ends before
        # the next one comes, its end is the end of the busy period; else it ends after `next_arrival`.
        least = whole if following is None else min(whole, following + 1)
        finish = _settle(done, others, spend, start=max(finish, least))
        longest = max(longest, finish - arrived)
        if following is None or finish <= following:
            return longest
        arrived = following


def shared(parts: Iterable[tuple[Demand, int]]) -> Demand:
    """Divide each part of the other work by the number of cores (or threads) that it must occupy to interfere."""
    fixed = tuple(parts)
    # The common case, without the cost of a loop at each look.
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
    """Return the least t with own work + demand(t) <= t, searching from `start`."""
    within, size, rate, ahead = others
    least = ((fixed << _SHIFT) + ahead) // (_WHOLE - rate) if rate < _WHOLE else 0
    # The smallest window is 1 tick: it stands for one just longer than nothing, in which all first jobs come.
    window = max(start, fixed, least, 1)
    while True:
        spend(size + 1)
        needed = fixed + within(window)
        if needed <= window:
            # At the smallest window the need itself is the answer, which may be 0: work without execution time.
            return needed if window == 1 else window
        window = needed
