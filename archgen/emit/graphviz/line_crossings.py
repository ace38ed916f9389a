"""Count crossings of arrows and measure their length: layouts are chosen by both."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from archgen.emit.graphviz.label_places import sample_line
from archgen.emit.graphviz.placed_scene import Rectangle, SceneLine, ScenePoint, rectangles_meet

LineSegment = tuple[ScenePoint, ScenePoint]


class _SegmentedLine(NamedTuple):
    """A line's straight segments, each with its bounding rectangle, and the rectangle round them all."""

    segments: Sequence[tuple[LineSegment, Rectangle]]
    bounds: Rectangle


def count_crossings(lines: Sequence[SceneLine]) -> int:
    """Count the crossings of all pairs of lines. A pair may cross more than once."""
    paths = [_split_line(line) for line in lines]
    return sum(
        _count_line_crossings(one, other)
        for at, one in enumerate(paths)
        for other in paths[at + 1 :]
        if rectangles_meet(one.bounds, other.bounds)
    )


def _split_line(line: SceneLine) -> _SegmentedLine:
    segments = _line_segments(line)
    return _SegmentedLine(
        [(segment, _bounds_of(segment)) for segment in segments], _bounds_of([p for each in segments for p in each])
    )


def _count_line_crossings(first: _SegmentedLine, second: _SegmentedLine) -> int:
    """Count the crossings of two lines. Only segments near the other line are compared."""
    # Rectangles first: pictures of hundreds of arrows have tens of thousands of pairs, of which few are near one
    # another.
    near_segments = [each for each in first.segments if rectangles_meet(each[1], second.bounds)]
    facing_segments = (
        [each for each in second.segments if rectangles_meet(each[1], first.bounds)] if near_segments else []
    )
    return sum(
        _segments_cross(segment, to)
        for segment, span in near_segments
        for to, box in facing_segments
        if rectangles_meet(span, box)
    )


def _bounds_of(points: Sequence[ScenePoint]) -> Rectangle:
    xs, ys = [x for x, _ in points] or [0.0], [y for _, y in points] or [0.0]
    return (min(xs), min(ys), max(xs), max(ys))


def line_length(line: SceneLine) -> float:
    """Measure the length of a line, in points."""
    return math.fsum(math.dist(one, other) for one, other in _line_segments(line))


def _line_segments(line: SceneLine) -> list[LineSegment]:
    # Three straight pieces for each Bézier curve are enough to count crossings; labels need more (`sample_line`).
    return list(pairwise(sample_line(line, 3)))


def _segments_cross(first: LineSegment, second: LineSegment) -> bool:
    (a, b), (c, d) = first, second
    # Proper crossings only: arrows that share an end, or touch, do not cross.
    return _side_of_line(a, b, c) * _side_of_line(a, b, d) < 0 and _side_of_line(c, d, a) * _side_of_line(c, d, b) < 0


def _side_of_line(a: ScenePoint, b: ScenePoint, c: ScenePoint) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
