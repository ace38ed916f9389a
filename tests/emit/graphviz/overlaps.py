"""What overlaps in a scene."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.emit.graphviz.placed_scene import Rectangle, Scene


def rectangles_meet(first: Rectangle, second: Rectangle, gap: float) -> bool:
    """Return whether two rectangles overlap, or are nearer to each other than a gap."""
    return (
        first[0] < second[2] + gap
        and second[0] < first[2] + gap
        and first[1] < second[3] + gap
        and second[1] < first[3] + gap
    )


def overlapping_parts(scene: Scene) -> Iterable[tuple[str, str]]:
    """Yield each pair of boxes, titles and labels that overlap by more than the rounding of a hairline."""
    parts = [part for part in scene.parts if part.kind != "mark"]
    # A sweep from left to right: nothing that begins beyond a part's right side can overlap it.
    parts.sort(key=lambda part: part.rectangle[0])
    for at, part in enumerate(parts):
        for other in parts[at + 1 :]:
            if other.rectangle[0] >= part.rectangle[2]:
                break
            if rectangles_meet(part.rectangle, other.rectangle, -0.5):
                yield part.name, other.name
