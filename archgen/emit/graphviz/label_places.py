"""Find places for labels: on their own arrows, touching no box, title, other label or foreign arrow."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from archgen.emit.graphviz.placed_scene import Rectangle, Scene, SceneLine, ScenePart, ScenePoint, rectangles_meet

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
    paths = {line.edge: list(sample_line(line, _STEPS)) for line in scene.lines}
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
    placed = {}
    for part in labels:
        own_path = paths.get(part.name[1:], [])
        left, bottom, right, top = _reach_of(part, own_path)
        foreign_points = [
            (x, y)
            for edge, path in paths.items()
            if edge != part.name[1:]
            for x, y in path
            if left < x < right and bottom < y < top
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
    best, fewest = None, math.inf
    for spot in _candidate_spots(part, path):
        if not _is_free(spot, occupied):
            continue
        foreign = sum(
            abs(x - spot.x) < spot.width / 2 + _LINE_GAP and abs(y - spot.y) < spot.height / 2 + _LINE_GAP
            for x, y in foreign_points
        )
        # A place that is far from where the layout put the label may be beside another box: near ones come first.
        cost = foreign + (math.dist((spot.x, spot.y), (part.x, part.y)) / reach) * 0.01
        if foreign == 0:
            return spot
        if cost < fewest:
            best, fewest = spot, cost
    return best


def _is_free(part: ScenePart, occupied: list[Rectangle]) -> bool:
    return not any(rectangles_meet(part.rectangle, other, _LABEL_GAP) for other in occupied)


def _candidate_spots(part: ScenePart, path: Sequence[ScenePoint]) -> Iterator[ScenePart]:
    """Yield all places of a label: on its arrow, the nearest first, then where it is, then beside its arrow."""
    # The point itself breaks ties, so that every machine takes the same place.
    points = sorted(path, key=lambda spot: (abs(spot[0] - part.x) + abs(spot[1] - part.y), spot))
    yield from (replace(part, x=x, y=y) for x, y in points)
    yield part
    # Close above and below the arrow, beside it, then one and two more label's heights away.
    aside = part.width / 2 + _LINE_GAP
    for dx, dy in ((0, 0.6), (0, -0.6), (aside, 0), (-aside, 0), (0, 1.4), (0, -1.4), (0, 2.4), (0, -2.4)):
        yield from (replace(part, x=x + dx, y=y + dy * part.height) for x, y in points)


def sample_line(line: SceneLine, steps: int = 8) -> Iterator[ScenePoint]:
    """Yield points on the Bézier curves of a line, `steps` for each curve, and its end."""
    points = line.curve
    # Each curve shares its end with the next one's start: 3n + 1 points are n curves.
    for at in range(0, len(points) - 3, 3):
        one, two, three, four = points[at : at + 4]
        for step in range(steps):
            t = step / steps
            a, b, c, d = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
            yield (
                a * one[0] + b * two[0] + c * three[0] + d * four[0],
                a * one[1] + b * two[1] + c * three[1] + d * four[1],
            )
    if points:
        yield points[-1]
