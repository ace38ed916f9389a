"""Event models: the most activations that can fall into any window of a given length, in ticks.

They are Richter's standard event models (period, jitter, smallest distance), kept as a sum of streams where several
inputs fire one activity. Every function here errs to the safe side: its result never has fewer events in a window than
can really come.
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
"""Streams of one activity that are kept apart; more are collapsed into one that never has fewer events."""


class Stream(NamedTuple):
    """Batches of events: `events_per_period` batches of `batch_size` events at once in each `period`.

    They are shifted by at most `jitter`, and no two batches are closer than `distance`; all in ticks.
    """

    period: int
    jitter: int = 0
    distance: int = 0
    number: int = 1
    size: int = 1

    @property
    def rate(self) -> Fraction:
        """Return the most events per tick in the long run."""
        return Fraction(*self.ratio)

    @property
    def ratio(self) -> tuple[int, int]:
        """Return the same as numerator and denominator, which may have common factors."""
        # The distance caps the rate where it allows less than the period does: a throttled stream.
        if self.number * self.distance > self.period:
            return self.size, self.distance
        return self.size * self.number, self.period

    def time_of(self, k: int) -> int:
        """Return when the k-th batch (from 0) comes at the earliest, if the first one comes at 0 (delta-minus)."""
        return max(k * self.period // self.number - self.jitter, k * self.distance, 0)

    @property
    def spacing(self) -> int:
        """Return the smallest distance between two events."""
        # Only a plain period bounds it: several batches in a period may lie anywhere in it, events of one batch come at
        # once.
        own = self.period - self.jitter if self.size == self.number == 1 else 0
        return max(own, self.distance if self.size == 1 else 0, 0)


Streams = tuple[Stream, ...]


def eta(streams: Iterable[Stream], window: int, later: int = 0) -> int:
    """Return the most events in any half-open window longer than nothing (eta-plus), if each may come `delay` later.

    It is min(ceil((t + J) / P), ceil(t / d)) for each stream, with J increased and d reduced by the delay.
    """
    total = 0
    # Unpacked into locals, for this is an inner loop of all searches.
    for period, jitter, distance, number, size in streams:
        most = -(-(window + jitter + later) * number // period)
        if distance > later:
            most = min(most, -(-window // (distance - later)))
        total += size * most
    return total


def arrivals(streams: Streams) -> Iterator[int]:
    """Yield the earliest times of the first, second, third ... event, when all come as early as they can."""
    if len(streams) == 1:
        return _earliest(streams[0])
    return merge(*(_earliest(stream) for stream in streams))


def _earliest(stream: Stream) -> Iterator[int]:
    """Yield the earliest times of one stream's events, without end."""
    period, jitter, distance, number, size = stream
    for k in count():
        at = max(k * period // number - jitter, k * distance, 0)
        for _ in range(size):
            yield at


def late(streams: Streams, more: int) -> Streams:
    """Let each event come up to `delay` later: jitter grows, and the smallest distance shrinks by as much."""
    if not more:
        return streams
    return tuple(
        [
            Stream(period, jitter + more, distance - more if distance > more else 0, number, size)
            for period, jitter, distance, number, size in streams
        ]
    )


def apart(streams: Streams, least: int) -> Streams:
    """Keep events apart that could come together: an activity takes at least its best case from one end to the next."""
    # Only where nothing else keeps them apart: a distance that is known already is not replaced by another one.
    if not least or len(streams) != 1 or streams[0].spacing or streams[0].size != 1:
        return streams
    return (streams[0]._replace(distance=least),)


def together(streams: Iterable[Stream]) -> Streams:
    """Put streams side by side, merging equal ones if there are too many, and collapsing all if there still are."""
    found = tuple(streams)
    if len(found) <= MOST:
        return found
    counted: dict[Stream, int] = {}
    for stream in found:
        counted[stream] = counted.get(stream, 0) + 1
    found = tuple(stream._replace(size=stream.size * times) for stream, times in counted.items())
    return found if len(found) <= MOST else (single(found),)


def single(streams: Streams) -> Stream:
    """Return one stream that never has fewer events in a window than all of these together.

    ceil(x) < x + 1 for each stream, so that the ceiling of the sum of all (t + J) / P + 1 is enough.
    """
    if len(streams) == 1 and streams[0].size == 1:
        return streams[0]
    # With W the common period this sum is (t * event_count + offset) / W: a stream of `event_count` events each W, with
    # a jitter of offset / event_count. The + 1 of each stream becomes jitter.
    whole = lcm(*(stream.period for stream in streams))
    number = sum(stream.size * stream.number * (whole // stream.period) for stream in streams)
    ahead = sum(s.size * (s.number * s.jitter * (whole // s.period) + whole) for s in streams)
    return Stream(whole, -(-ahead // number), 0, number)


def all_of(inputs: Sequence[Streams], *, complete: bool) -> Streams:
    """Fire when each input has a new event.

    Between two firings each input has one, and the input that completed the first firing has one more. So there are at
    most as many firings as events of the liveliest input, and one more than of the calmest. The latter holds for known
    inputs even where others are unknown (`complete` False).
    """
    ones = [single(streams) for streams in inputs]
    calmest = min(ones, key=lambda one: (one.rate, one.jitter))
    if complete and len(ones) == 1:
        return (ones[0],)
    # Equal periods: each firing uses up one event of each input and comes with the latest of them, so that the period
    # stays and only the largest jitter counts. The distance is lost: two firings may complete right after one another.
    if (
        complete
        and len({(one.period, one.number, one.size) for one in ones}) == 1
        and all(one.distance <= one.period for one in ones)
    ):
        return (calmest._replace(jitter=max(one.jitter for one in ones), distance=0),)
    # One more event in every window: as jitter, that is one more distance between events.
    extra = -(-calmest.period // calmest.number)
    spacing = min(one.spacing for one in ones) if complete else 0
    return (calmest._replace(jitter=calmest.jitter + extra, distance=spacing),)


def every(streams: Streams, number: int) -> Streams:
    """Fire at each n-th event."""
    if number == 1:
        return streams
    one = single(streams)
    # The smallest distance is left as it is, though n events are farther apart: too small is safe.
    return (one._replace(period=one.period * number),)


def throttled(streams: Streams, gap: int) -> Streams:
    """Drop what comes sooner than `gap` after the last event let through."""
    if not gap:
        return streams
    one = single(streams)
    steps = -(-gap * one.number // one.period)
    # If the event before the n-th (n = period_count) is too soon even when late, at most each n-th passes: a longer
    # period. Otherwise jitter may let an earlier one through, and only the distance is sure.
    regular = one.number == 1 and (steps - 1) * one.period + one.jitter < gap
    period = one.period * steps if regular else one.period
    return (one._replace(period=period, distance=max(one.distance, gap)),)


def called(streams: Streams, calls: Fraction) -> Streams:
    """Return the calls that activations make: whole numbers at once, fractions evenly spread."""
    if calls <= 0:
        return ()
    if calls.denominator == 1:
        return tuple(stream._replace(size=stream.size * calls.numerator) for stream in streams)
    return tuple(_spread(single((stream,)), calls) for stream in streams)


def _spread(one: Stream, calls: Fraction) -> Stream:
    # Which activations make the call is not known: that is one more period of the caller as jitter.
    jitter = one.jitter + -(-one.period // one.number)
    period, number = one.period * calls.denominator, one.number * calls.numerator
    return one._replace(period=period, number=number, jitter=jitter, distance=0)


def written(activity: Activity) -> Streams | None:
    """Return the event model of an activity that states its period itself, None for any other."""
    # No events: everything here holds from when the start is over (docs/timing.md, "Response times").
    if activity.behaviour == "once":
        return ()
    return None if activity.period is None else (Stream(activity.period, activity.jitter),)
