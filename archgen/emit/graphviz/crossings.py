"""Count crossings of arrows and measure their length: layouts are chosen by both."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from archgen.emit.graphviz.labels import along
from archgen.emit.graphviz.scene import Line, Point, Rectangle, meet

Segment = tuple[Point, Point]


class _Path(NamedTuple):
    """A line's straight segments, each with its bounding rectangle, and the rectangle round them all."""

    segments: Sequence[tuple[Segment, Rectangle]]
    span: Rectangle


def crossings(lines: Sequence[Line]) -> int:
    """Count the crossings of all pairs of lines. A pair may cross more than once."""
    paths = [_path(line) for line in lines]
    return sum(
        _count(one, other) for at, one in enumerate(paths) for other in paths[at + 1 :] if meet(one.span, other.span)
    )


def _path(line: Line) -> _Path:
    segments = _segments(line)
    return _Path([(segment, _span(segment)) for segment in segments], _span([p for each in segments for p in each]))


def _count(one: _Path, other: _Path) -> int:
    """Count the crossings of two lines. Only segments near the other line are compared."""
    # Rectangles first: pictures of hundreds of arrows have tens of thousands of pairs, of which few are near one
    # another.
    near = [each for each in one.segments if meet(each[1], other.span)]
    rest = [each for each in other.segments if meet(each[1], one.span)] if near else []
    return sum(_cross(segment, to) for segment, span in near for to, box in rest if meet(span, box))


def _span(points: Sequence[Point]) -> Rectangle:
    xs, ys = [x for x, _ in points] or [0.0], [y for _, y in points] or [0.0]
    return (min(xs), min(ys), max(xs), max(ys))


def length(line: Line) -> float:
    """Measure the length of a line, in points."""
    return sum(math.dist(one, other) for one, other in _segments(line))


def _segments(line: Line) -> list[Segment]:
    # Three straight pieces for each Bézier curve are enough to count crossings; labels need more (`sample_line`).
    return list(pairwise(along(line, 3)))


def _cross(one: Segment, other: Segment) -> bool:
    (a, b), (c, d) = one, other
    # Proper crossings only: arrows that share an end, or touch, do not cross.
    return _side(a, b, c) * _side(a, b, d) < 0 and _side(c, d, a) * _side(c, d, b) < 0


def _side(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
