"""Event models: how many activations can fall into any window of a length, in ticks.

The functions follow Richter's standard event models (period, jitter, smallest distance), kept as a sum of streams where
several inputs fire one activity.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from heapq import merge
from itertools import count
from math import lcm
from typing import NamedTuple

from archgen.timing.system import Activity

MOST = 8
"""Streams of one activity that are kept apart; more are laid together into one that is never less."""


class Stream(NamedTuple):
    """`number` events each `period`, shifted by at most `jitter`, no two closer than `distance`; each of them `size` at once."""

    period: int
    jitter: int = 0
    distance: int = 0
    number: int = 1
    size: int = 1

    @property
    def rate(self) -> Fraction:
        """Give the events a tick, at most."""
        return Fraction(*self.ratio)

    @property
    def ratio(self) -> tuple[int, int]:
        """Give the same as numerator and denominator, which may have common factors."""
        if self.number * self.distance > self.period:
            return self.size, self.distance
        return self.size * self.number, self.period

    def time_of(self, k: int) -> int:
        """Give when the k-th event (from 0) comes at the earliest, if the first comes at 0."""
        return max(k * self.period // self.number - self.jitter, k * self.distance, 0)

    @property
    def spacing(self) -> int:
        """Give the smallest distance of two events."""
        own = self.period - self.jitter if self.size == self.number == 1 else 0
        return max(own, self.distance if self.size == 1 else 0, 0)


Streams = tuple[Stream, ...]


def eta(streams: Iterable[Stream], window: int, later: int = 0) -> int:
    """Give the most events in any half-open window longer than nothing, where each may come `later` than it would."""
    total = 0
    for period, jitter, distance, number, size in streams:
        most = -(-(window + jitter + later) * number // period)
        if distance > later:
            most = min(most, -(-window // (distance - later)))
        total += size * most
    return total


def arrivals(streams: Streams) -> Iterator[int]:
    """Give the earliest times of the first, second, third ... event, when all come as early as they can."""
    if len(streams) == 1:
        return _earliest(streams[0])
    return merge(*(_earliest(stream) for stream in streams))


def _earliest(stream: Stream) -> Iterator[int]:
    period, jitter, distance, number, size = stream
    for k in count():
        at = max(k * period // number - jitter, k * distance, 0)
        for _ in range(size):
            yield at


def late(streams: Streams, more: int) -> Streams:
    """Let each event come up to `more` later than it would."""
    if not more:
        return streams
    return tuple(
        [
            Stream(period, jitter + more, distance - more if distance > more else 0, number, size)
            for period, jitter, distance, number, size in streams
        ]
    )


def apart(streams: Streams, least: int) -> Streams:
    """Keep events apart that would come together: an activity takes its best case at least from one end to the next."""
    if not least or len(streams) != 1 or streams[0].spacing or streams[0].size != 1:
        return streams
    return (streams[0]._replace(distance=least),)


def together(streams: Iterable[Stream]) -> Streams:
    """Lay streams beside one another; too many are made one."""
    found = tuple(streams)
    if len(found) <= MOST:
        return found
    counted: dict[Stream, int] = {}
    for stream in found:
        counted[stream] = counted.get(stream, 0) + 1
    found = tuple(stream._replace(size=stream.size * times) for stream, times in counted.items())
    return found if len(found) <= MOST else (single(found),)


def single(streams: Streams) -> Stream:
    """Give one stream with never fewer events in a window than all of these together.

    ceil(x) < x + 1 for each stream, so that the ceiling of the sum of all (t + J)/P + 1 is enough.
    """
    if len(streams) == 1 and streams[0].size == 1:
        return streams[0]
    whole = lcm(*(stream.period for stream in streams))
    number = sum(stream.size * stream.number * (whole // stream.period) for stream in streams)
    ahead = sum(s.size * (s.number * s.jitter * (whole // s.period) + whole) for s in streams)
    return Stream(whole, -(-ahead // number), 0, number)


def all_of(inputs: Sequence[Streams], *, complete: bool) -> Streams:
    """Fire when each input has a new event.

    Between two firings each input has one; and the input that completed the first firing has one more. So there are at
    most as many firings as events of the liveliest input, and one more than of the calmest. The second holds for those
    that are known, even where others are not (`complete` False).
    """
    ones = [single(streams) for streams in inputs]
    calmest = min(ones, key=lambda one: (one.rate, one.jitter))
    if complete and len(ones) == 1:
        return (ones[0],)
    if (
        complete
        and len({(one.period, one.number, one.size) for one in ones}) == 1
        and all(one.distance <= one.period for one in ones)
    ):
        return (calmest._replace(jitter=max(one.jitter for one in ones), distance=0),)
    extra = -(-calmest.period // calmest.number)
    spacing = min(one.spacing for one in ones) if complete else 0
    return (calmest._replace(jitter=calmest.jitter + extra, distance=spacing),)


def every(streams: Streams, number: int) -> Streams:
    """Fire at each n-th event."""
    if number == 1:
        return streams
    one = single(streams)
    return (one._replace(period=one.period * number),)


def throttled(streams: Streams, gap: int) -> Streams:
    """Drop what comes sooner than `gap` after what was let through."""
    if not gap:
        return streams
    one = single(streams)
    steps = -(-gap * one.number // one.period)
    regular = one.number == 1 and (steps - 1) * one.period + one.jitter < gap
    period = one.period * steps if regular else one.period
    return (one._replace(period=period, distance=max(one.distance, gap)),)


def called(streams: Streams, calls: Fraction) -> Streams:
    """Give the calls that activations make: whole numbers at once, fractions evenly spread."""
    if calls <= 0:
        return ()
    if calls.denominator == 1:
        return tuple(stream._replace(size=stream.size * calls.numerator) for stream in streams)
    return tuple(_spread(single((stream,)), calls) for stream in streams)


def _spread(one: Stream, calls: Fraction) -> Stream:
    jitter = one.jitter + -(-one.period // one.number)
    period, number = one.period * calls.denominator, one.number * calls.numerator
    return one._replace(period=period, number=number, jitter=jitter, distance=0)


def written(activity: Activity) -> Streams | None:
    """Give the event model of what states its period itself; None where it does not."""
    if activity.behaviour == "once":
        return ()
    return None if activity.period is None else (Stream(activity.period, activity.jitter),)
