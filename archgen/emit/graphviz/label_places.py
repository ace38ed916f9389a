"""Find places for labels: none may touch a box, a title or another label."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.emit.graphviz.placed_scene import Rectangle, Scene, SceneLine, ScenePart, ScenePoint, rectangles_meet

_LABEL_GAP = 1.0


def declutter_labels(scene: Scene) -> Scene:
    """Move each label that touches something along its arrow, to the nearest free place.

    A label that finds none is left out of the picture; the arrow's tooltip and the tables still have it.
    """
    # First come, first served: labels keep the order of their arrows, so the result does not depend on chance.
    occupied = [part.rectangle for part in scene.parts if part.kind in {"box", "title"}]
    line_of_label = {f"l{edge}": line for edge, line in _lines_by_edge(scene)}
    kept_parts = []
    for part in scene.parts:
        if part.kind != "label":
            kept_parts.append(part)
            continue
        spot = next((at for at in _candidate_spots(part, line_of_label.get(part.name)) if _is_free(at, occupied)), None)
        if spot is not None:
            kept_parts.append(spot)
            occupied.append(spot.rectangle)
    return replace(scene, parts=tuple(kept_parts))


def _lines_by_edge(scene: Scene) -> Iterator[tuple[str, SceneLine]]:
    for line in scene.lines:
        yield line.edge, line


def _is_free(part: ScenePart, occupied: list[Rectangle]) -> bool:
    return not any(rectangles_meet(part.rectangle, other, _LABEL_GAP) for other in occupied)


def _candidate_spots(part: ScenePart, line: SceneLine | None) -> Iterator[ScenePart]:
    """Yield the label where it is, then at all places on and beside its arrow, the nearest first."""
    yield part
    if line is None:
        return
    # On the line, close above and below it, and one more label's height away.
    sides = (0.0, part.height * 0.6, -part.height * 0.6, part.height * 1.4, -part.height * 1.4)
    points = list(sample_line(line))
    points_beside = [(x, y + side) for x, y in points for side in sides]
    # The point itself breaks ties, so that every machine takes the same place.
    points_beside.sort(key=lambda spot: (abs(spot[0] - part.x) + abs(spot[1] - part.y), spot))
    for x, y in points_beside:
        yield replace(part, x=x, y=y)


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
