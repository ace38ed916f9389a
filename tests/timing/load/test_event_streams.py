"""Event models: Richter's standard ones (period P, jitter J, smallest distance d), by hand and against counting."""

from __future__ import annotations

from fractions import Fraction
from itertools import islice
from random import Random

import pytest

from archgen.timing.load.event_streams import (
    MAX_STREAMS,
    EventStream,
    EventStreams,
    collapse_streams,
    combine_all_of,
    delay_streams,
    earliest_arrivals,
    keep_events_apart,
    max_arrivals,
    merge_streams,
    streams_of_calls,
    take_every_nth,
    throttle_streams,
    written_streams,
)
from archgen.timing.system.timing_system import Activity

PLAIN, LATE, APART = EventStream(10), EventStream(10, 25), EventStream(10, 25, 4)
THREE_IN_TEN, PAIRS = EventStream(10, 0, 0, 3), EventStream(10, 0, 0, 1, 2)


@pytest.mark.parametrize(
    ("stream", "window", "delay", "events"),
    [
        (PLAIN, 1, 0, 1),
        (PLAIN, 10, 0, 1),  # half-open: the event at 10 is outside
        (PLAIN, 11, 0, 2),
        (PLAIN, 10, 1, 2),  # ceil((10 + 1) / 10)
        (LATE, 1, 0, 3),  # ceil(26 / 10)
        (APART, 1, 0, 1),  # ceil(1 / 4)
        (APART, 5, 0, 2),
        (APART, 100, 0, 13),  # ceil(125 / 10), below ceil(100 / 4)
        (APART, 5, 3, 4),  # min(ceil(33 / 10), ceil(5 / 1))
        (APART, 1, 4, 3),  # the delay eats the distance: ceil(30 / 10)
        (APART, 2, 3, 2),
        (THREE_IN_TEN, 1, 0, 1),
        (THREE_IN_TEN, 10, 0, 3),
        (THREE_IN_TEN, 11, 0, 4),
        (PAIRS, 11, 0, 4),
    ],
)
def test_so_many_events_fit_into_a_window(stream: EventStream, window: int, delay: int, events: int) -> None:
    assert max_arrivals((stream,), window, delay) == events
    assert max_arrivals((stream, stream), window, delay) == 2 * events


@pytest.mark.parametrize(
    ("stream", "times"),
    [
        (PLAIN, [0, 10, 20, 30, 40]),
        (LATE, [0, 0, 0, 5, 15]),
        (APART, [0, 4, 8, 12, 16]),
        (THREE_IN_TEN, [0, 3, 6, 10, 13]),
        (PAIRS, [0, 0, 10, 10, 20]),
    ],
)
def test_events_come_as_early_as_they_can(stream: EventStream, times: list[int]) -> None:
    assert list(islice(earliest_arrivals((stream,)), 5)) == times
    assert list(islice(earliest_arrivals((stream, PLAIN)), 7)) == sorted([*times, 0, 10, 20, 30, 40])[:7]
    assert [stream.earliest_time(k) for k in range(5 // stream.batch_size)] == times[:: stream.batch_size][
        : 5 // stream.batch_size
    ]


@pytest.mark.parametrize(
    ("stream", "rate", "spacing"),
    [
        (PLAIN, Fraction(1, 10), 10),
        (EventStream(10, 3), Fraction(1, 10), 7),
        (LATE, Fraction(1, 10), 0),
        (APART, Fraction(1, 10), 4),
        (EventStream(10, 3, 8), Fraction(1, 10), 8),
        (EventStream(10, 3, 30), Fraction(1, 30), 30),
        (EventStream(10, 0, 10), Fraction(1, 10), 10),
        (EventStream(10, 0, 4, 3), Fraction(1, 4), 4),
        (EventStream(10, 0, 3, 3), Fraction(3, 10), 3),
        (EventStream(10, 0, 30, 1, 2), Fraction(1, 15), 0),
        (THREE_IN_TEN, Fraction(3, 10), 0),
        (PAIRS, Fraction(1, 5), 0),
    ],
)
def test_rate_and_smallest_distance(stream: EventStream, rate: Fraction, spacing: int) -> None:
    assert (stream.max_rate, stream.min_spacing) == (rate, spacing)


def test_a_delay_makes_events_burstier() -> None:
    assert delay_streams((PLAIN, APART), 3) == (EventStream(10, 3), EventStream(10, 28, 1))
    assert delay_streams((APART,), 4) == (EventStream(10, 29),)
    assert delay_streams((APART,), 9) == (EventStream(10, 34),)
    assert delay_streams((EventStream(10, 1, 0, 3, 2),), 1) == (EventStream(10, 2, 0, 3, 2),)
    assert delay_streams((APART,), 0) == (APART,)


def test_only_events_that_may_come_together_are_kept_apart() -> None:
    assert keep_events_apart((LATE,), 2) == (EventStream(10, 25, 2),)
    for streams in ((PLAIN,), (APART,), (LATE, LATE), (PAIRS,)):
        assert keep_events_apart(streams, 2) == streams
    assert keep_events_apart((LATE,), 0) == (LATE,)


def test_up_to_eight_streams_are_kept_and_equal_ones_merged() -> None:
    eight = tuple(EventStream(10 + number) for number in range(8))
    assert (MAX_STREAMS, merge_streams(eight)) == (8, eight)
    assert merge_streams((*eight, eight[0])) == (eight[0]._replace(batch_size=2), *eight[1:])
    assert merge_streams([PAIRS] * 9 + [PLAIN]) == (EventStream(10, 0, 0, 1, 18), PLAIN)
    assert len(merge_streams((*eight, LATE))) == 1


def test_a_collapsed_stream_is_computed_by_hand() -> None:
    """ceil(t/10) + ceil((t + 3)/15) < t/10 + 1 + (t + 3)/15 + 1 = (5 t + 66) / 30: five events each 30, 66/5 late."""
    assert collapse_streams((EventStream(10), EventStream(15, 3))) == EventStream(30, 14, 0, 5)
    assert collapse_streams((APART,)) == APART
    # 2 ceil(t/10) < 2 t/10 + 2 = (2 t + 20) / 10.
    assert collapse_streams((PAIRS,)) == EventStream(10, 10, 0, 2)
    # Two at once, three times in ten, four late: 2 (3 (t + 4)/10 + 1) = (6 t + 44) / 10.
    assert collapse_streams((EventStream(10, 4, 0, 3, 2),)) == EventStream(10, 8, 0, 6)


@pytest.mark.parametrize("seed", range(40))
def test_a_collapsed_stream_never_has_fewer_events(seed: int) -> None:
    dice = Random(seed)  # noqa: S311 - a test's dice
    streams = tuple(
        EventStream(
            dice.randint(4, 12), dice.randint(0, 20), dice.choice((0, 2)), dice.randint(1, 3), dice.randint(1, 2)
        )
        for _ in range(dice.randint(1, 3))
    )
    one = (collapse_streams(streams),)
    assert all(max_arrivals(one, window) >= max_arrivals(streams, window) for window in range(1, 200))


@pytest.mark.parametrize(
    ("inputs", "complete", "fired"),
    [
        ([(APART,)], True, APART),
        ([(APART,)], False, EventStream(10, 25 + 10)),  # one more than its events: a period as jitter
        ([(PLAIN,), (EventStream(10, 4),)], True, EventStream(10, 4)),
        ([(EventStream(10, 4, 3),), (PLAIN,)], True, EventStream(10, 4)),
        ([(PLAIN,), (EventStream(10, 4, 12),)], True, EventStream(10, 14, 10)),  # 12 apart is less than one in ten
        ([(PLAIN,), (EventStream(10, 4, 10),)], True, EventStream(10, 4)),
        ([(PLAIN,), (EventStream(30),)], True, EventStream(30, 30, 10)),
        ([(EventStream(30, 2),), (EventStream(10, 3),)], True, EventStream(30, 32, 7)),
        ([(EventStream(30, 2),), (EventStream(10, 3),)], False, EventStream(30, 32)),
        ([(EventStream(30, 5),), (EventStream(30, 2),)], False, EventStream(30, 32)),  # the calmer of equal rates
        ([(PLAIN,), (THREE_IN_TEN,)], True, EventStream(10, 10, 0)),
        ([(EventStream(10, 0, 0, 3),), (EventStream(2),)], True, EventStream(10, 4, 0, 3)),  # ceil(10 / 3) more jitter
        ([(THREE_IN_TEN,), (EventStream(10, 1, 0, 3),)], True, EventStream(10, 1, 0, 3)),
    ],
)
def test_all_of_fires_as_often_as_the_calmest_input(
    inputs: list[EventStreams],
    complete: bool,  # noqa: FBT001 - a column of the table
    fired: EventStream,
) -> None:
    assert combine_all_of(inputs, complete=complete) == (fired,)


def test_each_nth_event_fires() -> None:
    assert take_every_nth((APART, PLAIN), 1) == (APART, PLAIN)
    assert take_every_nth((APART,), 3) == (EventStream(30, 25, 4),)
    assert take_every_nth((PLAIN, PLAIN), 2) == (EventStream(20, 10, 0, 2),)


@pytest.mark.parametrize(
    ("stream", "gap", "passed"),
    [
        (PLAIN, 0, PLAIN),
        (PLAIN, 10, EventStream(10, 0, 10)),
        (PLAIN, 11, EventStream(20, 0, 11)),
        (PLAIN, 30, EventStream(30, 0, 30)),
        (EventStream(10, 4), 15, EventStream(20, 4, 15)),  # the next one comes at 14 at the latest: too soon
        (EventStream(10, 5), 15, EventStream(10, 5, 15)),  # at 15: just late enough
        (EventStream(10, 6), 15, EventStream(10, 6, 15)),
        (APART, 2, EventStream(10, 25, 4)),
        (THREE_IN_TEN, 9, EventStream(10, 0, 9, 3)),
        (EventStream(10, 0, 12), 5, EventStream(10, 0, 12)),
    ],
)
def test_a_throttle_keeps_events_apart(stream: EventStream, gap: int, passed: EventStream) -> None:
    assert throttle_streams((stream,), gap) == (passed,)


def test_a_throttle_acts_on_several_streams_together() -> None:
    assert throttle_streams((PLAIN, PLAIN), 7) == (EventStream(10, 10, 7, 2),)
    assert throttle_streams((PLAIN, PLAIN), 0) == (PLAIN, PLAIN)


def test_calls_are_made_at_once_or_spread() -> None:
    assert streams_of_calls((PLAIN, PAIRS), Fraction(3)) == (PLAIN._replace(batch_size=3), PAIRS._replace(batch_size=6))
    assert streams_of_calls((APART,), Fraction(1)) == (APART,)
    assert streams_of_calls((PLAIN,), Fraction(0)) == ()
    assert streams_of_calls((PLAIN,), Fraction(-1)) == ()
    # Two calls in three activations: two each 30, the caller's period as jitter, and nothing keeps them apart.
    assert streams_of_calls((APART, PLAIN), Fraction(2, 3)) == (EventStream(30, 35, 0, 2), EventStream(30, 10, 0, 2))
    assert streams_of_calls((THREE_IN_TEN,), Fraction(1, 2)) == (EventStream(20, 4, 0, 3),)


def test_a_written_period_is_an_event_model() -> None:
    assert written_streams(Activity("a", "a", None, "periodic", period=10, jitter=2)) == (EventStream(10, 2),)
    assert written_streams(Activity("a", "a", None, "event")) is None
    assert written_streams(Activity("a", "a", None, "once")) == ()
    assert written_streams(Activity("a", "a", None, "once", period=10)) == ()
