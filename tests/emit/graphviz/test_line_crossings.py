"""Crossings and lengths of lines, by which layouts are chosen."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from archgen.emit.graphviz.label_places import count_crossings, line_length
from archgen.emit.graphviz.placed_scene import SceneLine, ScenePoint


def _line(*points: ScenePoint) -> SceneLine:
    """Make a straight Bézier curve from each point to the next."""
    controls = [points[0]]
    for (x, y), (to_x, to_y) in pairwise(points):
        controls += [
            (x + (to_x - x) / 3, y + (to_y - y) / 3),
            (x + 2 * (to_x - x) / 3, y + 2 * (to_y - y) / 3),
            (to_x, to_y),
        ]
    spline = " ".join(f"{x},{y}" for x, y in controls)
    return SceneLine("e0", "a", "n0", "n1", {}, spline)


@pytest.mark.parametrize(
    ("lines", "crossings"),
    [
        ([_line((0, 0), (10, 10)), _line((0, 10), (10, 0))], 1),
        ([_line((0, 0), (10, 0)), _line((0, 5), (10, 5))], 0),
        ([_line((0, 0), (10, 10)), _line((0, 0), (10, 0))], 0),  # they share an end
        ([_line((0, 0), (10, 0)), _line((5, 0), (5, 9))], 0),  # they touch
        ([_line((0, 5), (30, 5.5)), _line((1, 0), (6, 10), (12, 0), (17, 10))], 3),
        ([_line((0, 0), (10, 10)), _line((0, 10), (10, 0)), _line((5, -5), (5.5, 20))], 3),
        ([], 0),
    ],
)
def test_only_lines_that_go_through_one_another_cross(lines: list[SceneLine], crossings: int) -> None:
    assert count_crossings(lines) == crossings


def test_a_line_is_as_long_as_its_pieces() -> None:
    assert math.isclose(line_length(_line((0, 0), (3, 4), (3, 10))), 11)
