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

from archgen.frozen import NamedTuple
from archgen.timing.system.timing_system import Activity

MAX_STREAMS = 8
"""Streams of one activity that are kept apart; more are collapsed into one that never has fewer events."""
_MAX_JOBS_IN_ROUND = 20_000
"""Most events in the hyperperiod of a core that is busy all the time: a longer one would not be searched to its end."""


class EventStream(NamedTuple):
    """Batches of events: `events_per_period` batches of `batch_size` events at once in each `period`.

    They are shifted by at most `jitter`, and no two batches are closer than `distance`; all in ticks.
    """

    period: int
    jitter: int = 0
    distance: int = 0
    events_per_period: int = 1
    batch_size: int = 1

    @property
    def max_rate(self) -> Fraction:
        """Return the most events per tick in the long run."""
        return Fraction(*self.max_rate_ratio)

    @property
    def max_rate_ratio(self) -> tuple[int, int]:
        """Return the same as numerator and denominator, which may have common factors."""
        # The distance caps the rate where it allows less than the period does: a throttled stream.
        if self.events_per_period * self.distance > self.period:
            return self.batch_size, self.distance
        return self.batch_size * self.events_per_period, self.period

    def earliest_time(self, k: int) -> int:
        """Return when the k-th batch (from 0) comes at the earliest, if the first one comes at 0 (delta-minus)."""
        return max(k * self.period // self.events_per_period - self.jitter, k * self.distance, 0)

    @property
    def min_spacing(self) -> int:
        """Return the smallest distance between two events."""
        # Only a plain period bounds it: several batches in a period may lie anywhere in it, events of one batch come at
        # once.
        period_spacing = self.period - self.jitter if self.batch_size == self.events_per_period == 1 else 0
        return max(period_spacing, self.distance if self.batch_size == 1 else 0, 0)


EventStreams = tuple[EventStream, ...]


def max_arrivals(streams: Iterable[EventStream], window: int, delay: int = 0) -> int:
    """Return the most events in any half-open window longer than nothing (eta-plus), if each may come `delay` later.

    It is min(ceil((t + J) / P), ceil(t / d)) for each stream, with J increased and d reduced by the delay.
    """
    event_count = 0
    # Unpacked into locals, for this is an inner loop of all searches.
    for period, jitter, distance, per_period, batch in streams:
        batches = -(-(window + jitter + delay) * per_period // period)
        if distance > delay:
            batches = min(batches, -(-window // (distance - delay)))
        event_count += batch * batches
    return event_count


def earliest_arrivals(streams: EventStreams) -> Iterator[int]:
    """Yield the earliest times of the first, second, third ... event, when all come as early as they can."""
    if len(streams) == 1:
        return _earliest_of_stream(streams[0])
    return merge(*(_earliest_of_stream(stream) for stream in streams))


def _earliest_of_stream(stream: EventStream) -> Iterator[int]:
    """Yield the earliest times of one stream's events, without end."""
    period, jitter, distance, per_period, batch = stream
    for k in count():
        time = max(k * period // per_period - jitter, k * distance, 0)
        for _ in range(batch):
            yield time


def delay_streams(streams: EventStreams, delay: int) -> EventStreams:
    """Let each event come up to `delay` later: jitter grows, and the smallest distance shrinks by as much."""
    if not delay:
        return streams
    return tuple(
        [
            EventStream(period, jitter + delay, distance - delay if distance > delay else 0, per_period, batch)
            for period, jitter, distance, per_period, batch in streams
        ]
    )


def keep_events_apart(streams: EventStreams, min_gap: int) -> EventStreams:
    """Keep events apart that could come together: an activity takes at least its best case from one end to the next."""
    # Only where nothing else keeps them apart: a distance that is known already is not replaced by another one.
    if not min_gap or len(streams) != 1 or streams[0].min_spacing or streams[0].batch_size != 1:
        return streams
    return (streams[0]._replace(distance=min_gap),)


def merge_streams(streams: Iterable[EventStream]) -> EventStreams:
    """Put streams side by side, merging equal ones if there are too many, and collapsing all if there still are."""
    stream_list = tuple(streams)
    if len(stream_list) <= MAX_STREAMS:
        return stream_list
    counts: dict[EventStream, int] = {}
    for stream in stream_list:
        counts[stream] = counts.get(stream, 0) + 1
    stream_list = tuple(
        stream._replace(batch_size=stream.batch_size * multiplicity) for stream, multiplicity in counts.items()
    )
    return stream_list if len(stream_list) <= MAX_STREAMS else (collapse_streams(stream_list),)


def collapse_streams(streams: EventStreams) -> EventStream:
    """Return one stream that never has fewer events in a window than all of these together.

    ceil(x) < x + 1 for each stream, so that the ceiling of the sum of all (t + J) / P + 1 is enough.
    """
    if len(streams) == 1 and streams[0].batch_size == 1:
        return streams[0]
    # With W the common period this sum is (t * event_count + offset) / W: a stream of `event_count` events each W, with
    # a jitter of offset / event_count. The + 1 of each stream becomes jitter.
    common_period = lcm(*(stream.period for stream in streams))
    event_count = sum(
        stream.batch_size * stream.events_per_period * (common_period // stream.period) for stream in streams
    )
    offset = sum(
        item.batch_size * (item.events_per_period * item.jitter * (common_period // item.period) + common_period)
        for item in streams
    )
    return EventStream(common_period, -(-offset // event_count), 0, event_count)


def combine_all_of(inputs: Sequence[EventStreams], *, complete: bool) -> EventStreams:
    """Fire when each input has a new event.

    Between two firings each input has one, and the input that completed the first firing has one more. So there are at
    most as many firings as events of the liveliest input, and one more than of the calmest. The latter holds for known
    inputs even where others are unknown (`complete` False).
    """
    collapsed = [collapse_streams(streams) for streams in inputs]
    calmest = min(collapsed, key=lambda stream: (stream.max_rate, stream.jitter))
    if complete and len(collapsed) == 1:
        return (collapsed[0],)
    # Equal periods: each firing uses up one event of each input and comes with the latest of them, so that the period
    # stays and only the largest jitter counts. The distance is lost: two firings may complete right after one another.
    if (
        complete
        and len({(stream.period, stream.events_per_period, stream.batch_size) for stream in collapsed}) == 1
        and all(stream.distance <= stream.period for stream in collapsed)
    ):
        return (calmest._replace(jitter=max(stream.jitter for stream in collapsed), distance=0),)
    # One more event in every window: as jitter, that is one more distance between events.
    extra_jitter = -(-calmest.period // calmest.events_per_period)
    min_distance = min(stream.min_spacing for stream in collapsed) if complete else 0
    return (calmest._replace(jitter=calmest.jitter + extra_jitter, distance=min_distance),)


def take_every_nth(streams: EventStreams, nth: int) -> EventStreams:
    """Fire at each n-th event."""
    if nth == 1:
        return streams
    stream = collapse_streams(streams)
    # The smallest distance is left as it is, though n events are farther apart: too small is safe.
    return (stream._replace(period=stream.period * nth),)


def throttle_streams(streams: EventStreams, gap: int) -> EventStreams:
    """Drop what comes sooner than `gap` after the last event let through."""
    if not gap:
        return streams
    stream = collapse_streams(streams)
    period_count = -(-gap * stream.events_per_period // stream.period)
    # If the event before the n-th (n = period_count) is too soon even when late, at most each n-th passes: a longer
    # period. Otherwise jitter may let an earlier one through, and only the distance is sure.
    is_regular = stream.events_per_period == 1 and (period_count - 1) * stream.period + stream.jitter < gap
    period = stream.period * period_count if is_regular else stream.period
    return (stream._replace(period=period, distance=max(stream.distance, gap)),)


def streams_of_calls(streams: EventStreams, calls: Fraction) -> EventStreams:
    """Return the calls that activations make: whole numbers at once, fractions evenly spread."""
    if calls <= 0:
        return ()
    if calls.denominator == 1:
        return tuple(stream._replace(batch_size=stream.batch_size * calls.numerator) for stream in streams)
    return tuple(_spread_calls(collapse_streams((stream,)), calls) for stream in streams)


def _spread_calls(stream: EventStream, calls: Fraction) -> EventStream:
    # Which activations make the call is not known: that is one more period of the caller as jitter.
    jitter = stream.jitter + -(-stream.period // stream.events_per_period)
    period, number = stream.period * calls.denominator, stream.events_per_period * calls.numerator
    return stream._replace(period=period, events_per_period=number, jitter=jitter, distance=0)


def written_streams(activity: Activity) -> EventStreams | None:
    """Return the event model of an activity that states its period itself, None for any other."""
    # No events: everything here holds from when the start is over (docs/timing.md, "Response times").
    if activity.behaviour == "once":
        return ()
    return None if activity.period is None else (EventStream(activity.period, activity.jitter),)


def settles_at_full_load(streams: Sequence[EventStream]) -> bool:
    """Whether work on these events that fills a core is sure to be done at the end of each hyperperiod."""
    if any(stream.jitter or stream.distance or stream.events_per_period != 1 for stream in streams):
        return False
    # Strictly periodic work with a load of exactly 1 is done at each common multiple of the periods. Any jitter would
    # let the busy period go on for ever.
    hyperperiod = lcm(*(stream.period for stream in streams))
    return sum(hyperperiod // stream.period for stream in streams) <= _MAX_JOBS_IN_ROUND
