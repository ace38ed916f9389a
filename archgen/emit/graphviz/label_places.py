"""Find places for labels: on their own arrows, touching no box, title, other label or foreign arrow. Crossings are counted."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, lru_cache
from itertools import pairwise

from archgen.emit.graphviz.placed_scene import Rectangle, Scene, SceneLine, ScenePart, ScenePoint
from archgen.frozen import NamedTuple, replace

_STEP = 6.0
"""How far apart the places that are tried for a title are, in points."""
_SAMPLES = 24
_TITLE_GAP = 2.0
"""How near a line may come to a title, in points."""


def clear_titles(scene: Scene) -> Scene:
    """Return a scene whose titles stand where the fewest lines pass: at the left of their frames where that is as good."""
    frames = {frame.name[1:]: frame.rectangle for frame in scene.frames}
    titles = [part for part in scene.parts if part.kind == "title"]
    if not titles:
        return scene
    points = _sample_lines(scene)
    moved = {part.name: _find_place(part, frames[part.name[1:]], points) for part in titles if part.name[1:] in frames}
    return replace(scene, parts=tuple(moved.get(part.name, part) for part in scene.parts))


def count_cut_titles(scene: Scene) -> int:
    """Return how many titles stand on a line."""
    points = _sample_lines(scene)
    rectangles = [part.rectangle for part in scene.parts if part.kind == "title"]
    return len(
        [
            rectangle
            for rectangle in rectangles
            if any(rectangle[0] < x < rectangle[2] and rectangle[1] < y < rectangle[3] for x, y in points)
        ]
    )


def _sample_lines(scene: Scene) -> list[ScenePoint]:
    return [point for line in scene.lines for point in sample_line(line, _SAMPLES)]


def _find_place(title: ScenePart, frame: Rectangle, points: Sequence[ScenePoint]) -> ScenePart:
    """Return a title at the first place in its strip below which no line passes, else the fewest."""
    top = title.y + title.height / 2 + _TITLE_GAP
    near_points = [(x, y) for x, y in points if top - title.height - 2 * _TITLE_GAP < y < top]
    # `min` returns the first of equals.
    return min(_list_places(title, frame), key=lambda place: _count_points(place, near_points))


def _list_places(title: ScenePart, frame: Rectangle) -> Iterator[ScenePart]:
    """Yield the places for a title beside its own, which keeps its distance from the frame's left side."""
    yield title
    gap = title.rectangle[0] - frame[0]
    last = frame[2] - gap - title.width / 2
    x = title.x + _STEP
    while x <= last:
        yield title.moved_to(x, title.y)
        x += _STEP


def _count_points(title: ScenePart, points: Sequence[ScenePoint]) -> int:
    reach = title.width / 2 + _TITLE_GAP
    return sum(abs(x - title.x) < reach for x, _ in points)


_LABEL_GAP = 1.0
_LINE_GAP = 3.0
"""How near another arrow may come to a label, in points."""
_STEPS = 16
_MAX_ROUNDS = 4


def declutter_labels(scene: Scene) -> Scene:
    """Move labels so that none touches a box, a title or another label, and each is seen to belong to its own arrow.

    A label stands on its arrow where no other arrow passes below it, else beside it. One that finds no free place is
    left out of the picture; the arrow's tooltip and the tables still have it.
    """
    paths = {line.edge: sample_line(line, _STEPS) for line in scene.lines}
    labels = [part for part in scene.parts if part.kind == "label"]
    order = list(labels)
    placed: dict[str, ScenePart] = {}
    for _ in range(_MAX_ROUNDS):
        attempt = _place_labels(scene, order, paths)
        if len(attempt) > len(placed) or not placed:
            placed = attempt
        if len(placed) == len(labels):
            break
        # First come, first served: those that found no place are served first in the next round.
        order = sorted(order, key=lambda part: part.name in attempt)
    return replace(
        scene,
        parts=tuple(placed.get(part.name, part) for part in scene.parts if part.kind != "label" or part.name in placed),
    )


def _place_labels(
    scene: Scene, labels: Sequence[ScenePart], paths: Mapping[str, Sequence[ScenePoint]]
) -> dict[str, ScenePart]:
    """Place labels one after the other. Return those that found a place, by their names."""
    occupied = [part.rectangle for part in scene.parts if part.kind in {"box", "title"}]
    # From left to right, so that those within reach of a label are found by their sides.
    all_points = sorted([(x, y, edge) for edge, path in paths.items() for x, y in path])
    x_values = [x for x, _, _ in all_points]
    placed = {}
    for part in labels:
        own_path = paths.get(part.name[1:], [])
        left, bottom, right, top = _reach_of(part, own_path)
        foreign_points = [
            (x, y)
            for x, y, edge in all_points[bisect_right(x_values, left) : bisect_left(x_values, right)]
            if bottom < y < top and edge != part.name[1:]
        ]
        spot = _find_spot(part, own_path, occupied, foreign_points)
        if spot is not None:
            placed[part.name] = spot
            occupied.append(spot.rectangle)
    return placed


def _reach_of(part: ScenePart, path: Sequence[ScenePoint]) -> Rectangle:
    """Return the rectangle round all places where a label may stand."""
    xs, ys = [part.x, *(x for x, _ in path)], [part.y, *(y for _, y in path)]
    aside = part.width + 2 * _LINE_GAP, 3 * part.height + _LINE_GAP
    return (min(xs) - aside[0], min(ys) - aside[1], max(xs) + aside[0], max(ys) + aside[1])


def _find_spot(
    part: ScenePart, path: Sequence[ScenePoint], occupied: list[Rectangle], foreign_points: Sequence[ScenePoint]
) -> ScenePart | None:
    """Return the label at the nearest free place on its arrow with no other arrow near, else at the free place with the
    fewest points of other arrows below it.
    """
    reach = part.width + part.height
    aside, above = part.width / 2 + _LINE_GAP, part.height / 2 + _LINE_GAP
    best, fewest = None, math.inf
    for spot_x, spot_y in _candidate_spots(part, path):
        if not _is_free(part.moved_to(spot_x, spot_y).rectangle, occupied):
            continue
        # A list: `sum` of a generator takes twice as long, and this is where the time goes.
        foreign = len([1 for x, y in foreign_points if abs(x - spot_x) < aside and abs(y - spot_y) < above])
        # A place that is far from where the layout put the label may be beside another box: near ones come first.
        cost = foreign + (math.dist((spot_x, spot_y), (part.x, part.y)) / reach) * 0.01
        if foreign == 0:
            return part.moved_to(spot_x, spot_y)
        if cost < fewest:
            best, fewest = part.moved_to(spot_x, spot_y), cost
    return best


def _is_free(rectangle: Rectangle, occupied: list[Rectangle]) -> bool:
    """Whether a rectangle is no nearer than a gap to any of the others."""
    # Written out: calls of a function took half of the time.
    left, bottom, right, top = rectangle
    for other_left, other_bottom, other_right, other_top in occupied:
        if (
            left < other_right + _LABEL_GAP
            and other_left < right + _LABEL_GAP
            and bottom < other_top + _LABEL_GAP
            and other_bottom < top + _LABEL_GAP
        ):
            return False
    return True


def _candidate_spots(part: ScenePart, path: Sequence[ScenePoint]) -> Iterator[ScenePoint]:
    """Yield all places of a label: on its arrow, the nearest first, then where it is, then beside its arrow."""
    # The point itself breaks ties, so that every machine takes the same place.
    points = sorted(path, key=lambda spot: (abs(spot[0] - part.x) + abs(spot[1] - part.y), spot))
    yield from points
    yield part.x, part.y
    # Close above and below the arrow, beside it, then one and two more label's heights away.
    aside = part.width / 2 + _LINE_GAP
    for dx, dy in ((0, 0.6), (0, -0.6), (aside, 0), (-aside, 0), (0, 1.4), (0, -1.4), (0, 2.4), (0, -2.4)):
        yield from ((x + dx, y + dy * part.height) for x, y in points)


def sample_line(line: SceneLine, steps: int = 8) -> Sequence[ScenePoint]:
    """Return points on the Bézier curves of a line, `steps` for each curve, and its end."""
    return _sample_curve(line.curve, steps)


@lru_cache(8192)
def _sample_curve(points: tuple[ScenePoint, ...], steps: int) -> Sequence[ScenePoint]:
    """Return points on Bézier curves that follow each other, `steps` for each of them, and the end."""
    weights = _weigh_ends(steps)
    samples = []
    # Each curve shares its end with the next one's start: 3n + 1 points are n curves.
    for at in range(0, len(points) - 3, 3):
        (x1, y1), (x2, y2), (x3, y3), (x4, y4) = points[at : at + 4]
        samples += [(a * x1 + b * x2 + c * x3 + d * x4, a * y1 + b * y2 + c * y3 + d * y4) for a, b, c, d in weights]
    return (*samples, *points[-1:])


@cache
def _weigh_ends(steps: int) -> Sequence[tuple[float, float, float, float]]:
    """Return the weights of the four points of a Bézier curve at each of so many steps along it."""
    shares = [step / steps for step in range(steps)]
    return [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3) for t in shares]


_LineSegment = tuple[ScenePoint, ScenePoint]


class _SegmentedLine(NamedTuple):
    """A line's straight segments, each with left, bottom, right and top, and the rectangle round them all."""

    segments: Sequence[tuple[_LineSegment, float, float, float, float]]
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


def _split_into_segments(curve: tuple[ScenePoint, ...]) -> list[_LineSegment]:
    # Three straight pieces for each Bézier curve are enough to count crossings; labels need more.
    return list(pairwise(_sample_curve(curve, 3)))


def _segments_cross(first: _LineSegment, second: _LineSegment) -> bool:
    (a, b), (c, d) = first, second
    # Proper crossings only: arrows that share an end, or touch, do not cross.
    return _side_of_line(a, b, c) * _side_of_line(a, b, d) < 0 and _side_of_line(c, d, a) * _side_of_line(c, d, b) < 0


def _side_of_line(a: ScenePoint, b: ScenePoint, c: ScenePoint) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
