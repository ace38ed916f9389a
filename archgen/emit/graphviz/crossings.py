"""Count where arrows cross, and measure how far they run: what layouts are chosen by."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from archgen.emit.graphviz.labels import along
from archgen.emit.graphviz.scene import Line, Point, Rectangle, meet

Segment = tuple[Point, Point]


def crossings(lines: Sequence[Line]) -> int:
    """Count the crossings of all pairs of lines."""
    paths = [_segments(line) for line in lines]
    spans = [_span(path) for path in paths]
    return sum(
        _count(paths[at], paths[to], spans[at], spans[to])
        for at in range(len(paths))
        for to in range(at + 1, len(paths))
        if meet(spans[at], spans[to])
    )


def _count(one: Sequence[Segment], other: Sequence[Segment], span: Rectangle, other_span: Rectangle) -> int:
    """Count the crossings of two lines; only what lies near the other one is looked at."""
    near = [each for each in one if meet(_span([each]), other_span)]
    rest = [each for each in other if meet(_span([each]), span)] if near else []
    return sum(_cross(each, to) for each in near for to in rest)


def _span(path: Sequence[Segment]) -> Rectangle:
    xs = [point[0] for segment in path for point in segment] or [0.0]
    ys = [point[1] for segment in path for point in segment] or [0.0]
    return (min(xs), min(ys), max(xs), max(ys))


def length(line: Line) -> float:
    """Measure a line in points."""
    return sum(math.dist(one, other) for one, other in _segments(line))


def _segments(line: Line) -> list[Segment]:
    return list(pairwise(along(line, 3)))


def _cross(one: Segment, other: Segment) -> bool:
    (a, b), (c, d) = one, other
    if max(a[0], b[0]) < min(c[0], d[0]) or max(c[0], d[0]) < min(a[0], b[0]):
        return False
    if max(a[1], b[1]) < min(c[1], d[1]) or max(c[1], d[1]) < min(a[1], b[1]):
        return False
    return _side(a, b, c) * _side(a, b, d) < 0 and _side(c, d, a) * _side(c, d, b) < 0


def _side(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
