"""Move titles of frames aside where lines pass below them: the plate of a title would cut the lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.emit.graphviz.label_places import sample_line
from archgen.emit.graphviz.placed_scene import Rectangle, Scene, ScenePart, ScenePoint
from archgen.frozen import replace

_STEP = 6.0
"""How far apart the places that are tried for a title are, in points."""
_SAMPLES = 24
_LINE_GAP = 2.0
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
    top = title.y + title.height / 2 + _LINE_GAP
    near_points = [(x, y) for x, y in points if top - title.height - 2 * _LINE_GAP < y < top]
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
    reach = title.width / 2 + _LINE_GAP
    return sum(abs(x - title.x) < reach for x, _ in points)
