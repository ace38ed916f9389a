"""Count crossings of arrows and measure their length: layouts are chosen by both."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

from archgen.emit.graphviz.label_places import sample_curve
from archgen.emit.graphviz.placed_scene import Rectangle, SceneLine, ScenePoint
from archgen.frozen import NamedTuple

LineSegment = tuple[ScenePoint, ScenePoint]


class _SegmentedLine(NamedTuple):
    """A line's straight segments, each with left, bottom, right and top, and the rectangle round them all."""

    segments: Sequence[tuple[LineSegment, float, float, float, float]]
    bounds: Rectangle


def count_crossings(lines: Sequence[SceneLine], limit: float = math.inf) -> int:
    """Count the crossings of all pairs of lines. A pair may cross more than once.

    Who only asks whether there are fewer than a limit is told any number from there on.
    """
    paths = [_split_curve(line.curve) for line in lines]
    # A sweep from left to right: no line that begins beyond a line's right side can cross it, nor can any after that.
    paths.sort(key=lambda path: path.bounds[0])
    lefts = [path.bounds[0] for path in paths]
    count = 0
    for at, path in enumerate(paths):
        _, bottom, right, top = path.bounds
        for other in paths[at + 1 : bisect_left(lefts, right, at + 1)]:
            # Written out: hundreds of arrows are a hundred thousand pairs, of which few are near.
            if bottom < other.bounds[3] and other.bounds[1] < top and path.bounds[0] < other.bounds[2]:
                count += _count_line_crossings(path, other)
        if count >= limit:
            break
    return count


@lru_cache(8192)
def _split_curve(curve: tuple[ScenePoint, ...]) -> _SegmentedLine:
    segments = _split_into_segments(curve)
    return _SegmentedLine(
        [(((ax, ay), (bx, by)), min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)) for (ax, ay), (bx, by) in segments],
        _bounds_of([p for each in segments for p in each]),
    )


def _count_line_crossings(first: _SegmentedLine, second: _SegmentedLine) -> int:
    """Count the crossings of two lines. Only segments near the other line are compared."""
    # Rectangles first, without a call of a function, which was a third of all the time.
    left, bottom, right, top = second.bounds
    near_segments = [
        each for each in first.segments if each[1] < right and left < each[3] and each[2] < top and bottom < each[4]
    ]
    if not near_segments:
        return 0
    left, bottom, right, top = first.bounds
    facing_segments = [
        each for each in second.segments if each[1] < right and left < each[3] and each[2] < top and bottom < each[4]
    ]
    return sum(
        _segments_cross(segment, to)
        for segment, left, bottom, right, top in near_segments
        for to, to_left, to_bottom, to_right, to_top in facing_segments
        if left < to_right and to_left < right and bottom < to_top and to_bottom < top
    )


def _bounds_of(points: Sequence[ScenePoint]) -> Rectangle:
    xs, ys = [x for x, _ in points] or [0.0], [y for _, y in points] or [0.0]
    return (min(xs), min(ys), max(xs), max(ys))


def line_length(line: SceneLine) -> float:
    """Measure the length of a line, in points."""
    return math.fsum([math.dist(one, other) for one, other in _split_into_segments(line.curve)])


def _split_into_segments(curve: tuple[ScenePoint, ...]) -> list[LineSegment]:
    # Three straight pieces for each Bézier curve are enough to count crossings; labels need more.
    return list(pairwise(sample_curve(curve, 3)))


def _segments_cross(first: LineSegment, second: LineSegment) -> bool:
    (a, b), (c, d) = first, second
    # Proper crossings only: arrows that share an end, or touch, do not cross.
    return _side_of_line(a, b, c) * _side_of_line(a, b, d) < 0 and _side_of_line(c, d, a) * _side_of_line(c, d, b) < 0


def _side_of_line(a: ScenePoint, b: ScenePoint, c: ScenePoint) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
