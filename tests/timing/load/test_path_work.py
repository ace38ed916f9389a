"""What comes of others while a path runs: lanes that are as wide as several cores, and how long no more comes than at once."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.path_work import _find_calm_time as find_calm_time
from archgen.timing.load.path_work import split_lanes


@pytest.mark.parametrize(
    ("stream", "window"),
    [
        (EventStream(100), 100),
        (EventStream(100, 30), 70),
        # Two come at once: the next two after a period.
        (EventStream(100, 0, 0, 1, 2), 100),
        (EventStream(100, 30, 0, 1, 2), 70),
        # Three in a period of 100: one each 33.
        (EventStream(100, 0, 0, 3), 33),
        # Its jitter lets three come at once, and then one each 100; or they keep a distance.
        (EventStream(100, 250), 50),
        (EventStream(100, 250, 40), 40),
        (EventStream(100, 80, 60), 60),
    ],
)
def test_the_longest_window_in_which_no_more_comes_than_at_once(stream: EventStream, window: int) -> None:
    assert find_calm_time(stream) == window


@pytest.mark.parametrize(
    ("widths", "works", "lanes"),
    [
        ((), (5, 7), (5, 7)),
        ((1, 1), (5, 7), (5, 7)),
        ((2, 1), (5, 7), [3, 3, 7]),
        ((1, 3), (5, 7), [5, 3, 3, 3]),
        ((2, 2), (4, 0), [2, 2, 0, 0]),
    ],
)
def test_what_is_reentrant_counts_as_several_lanes(
    widths: tuple[int, ...], works: tuple[int, ...], lanes: Sequence[int]
) -> None:
    path: Any = SimpleNamespace(lane_widths=widths)
    assert split_lanes(path, works) == lanes
