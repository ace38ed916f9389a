"""Scenes: drawings whose parts have their places. Layouts make them, and they are rendered without moving anything.

Edges are drawn over frames, and everything else over edges, so that a text is never crossed by a line. Coordinates are
in points, y upwards. Labels of edges and titles of frames are parts of their own (`ScenePart.kind`), because Graphviz
draws its own below the edges and lets them overlap.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Literal

from archgen.emit.graphviz.text import quoted

Attributes = dict[str, str]
Point = tuple[float, float]
Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top; in points."""

DEFAULTS = 'node [fontname="DejaVu Sans" fontsize="9" fontcolor="#1b2127"]; edge [fontname="DejaVu Sans" fontsize="8"];'
_POINT = re.compile(r"(?P<mark>[se],)?(?P<x>-?[0-9.]+(?:e[-+]?[0-9]+)?),(?P<y>-?[0-9.]+(?:e[-+]?[0-9]+)?)")


@dataclass(frozen=True, slots=True)
class Part:
    """Something with a middle and a size. A `mark` decorates a box and may overlap it."""

    name: str
    attributes: Attributes
    x: float
    y: float
    width: float
    height: float
    kind: Literal["box", "title", "label", "mark"] = "box"

    @property
    def rectangle(self) -> Rectangle:
        """The rectangle that the part covers."""
        return (
            self.x - self.width / 2,
            self.y - self.height / 2,
            self.x + self.width / 2,
            self.y + self.height / 2,
        )


@dataclass(frozen=True, slots=True)
class Line:
    """An edge with its spline as Graphviz writes it. `edge` is its number in the graph, `arrow` the id of the graph's
    arrow.
    """

    edge: str
    arrow: str
    tail: str
    head: str
    attributes: Attributes
    spline: str

    @property
    def curve(self) -> tuple[Point, ...]:
        """The points of the Bézier curves, without the tips of arrow heads."""
        return tuple(point for mark, point in _read(self.spline) if not mark)

    @property
    def points(self) -> tuple[Point, ...]:
        """The points of the spline and the tips of its arrow heads, in no particular order."""
        return tuple(point for _, point in _read(self.spline))


@lru_cache(8192)
def _read(spline: str) -> tuple[tuple[str, Point], ...]:
    """Parse a spline: its points, with `s,` or `e,` for the tips of arrow heads. Layouts ask for the same ones
    repeatedly.
    """
    return tuple((each["mark"] or "", (float(each["x"]), float(each["y"]))) for each in _POINT.finditer(spline))


@dataclass(frozen=True, slots=True)
class Frame:
    """A rectangle behind everything: a cluster's frame."""

    name: str
    attributes: Attributes
    rectangle: Rectangle


@dataclass(frozen=True, slots=True)
class Scene:
    """A drawing whose parts have their places."""

    frames: tuple[Frame, ...] = ()
    lines: tuple[Line, ...] = ()
    parts: tuple[Part, ...] = ()

    def bounds(self) -> Rectangle:
        """Return the rectangle round everything."""
        rectangles = [frame.rectangle for frame in self.frames] + [part.rectangle for part in self.parts]
        rectangles += [(x, y, x, y) for line in self.lines for x, y in line.points]
        if not rectangles:
            return (0.0, 0.0, 0.0, 0.0)
        left, bottom, right, top = zip(*rectangles, strict=True)
        return (min(left), min(bottom), max(right), max(top))

    def moved(self, dx: float, dy: float) -> Scene:
        """Return the scene shifted."""
        return Scene(
            tuple(replace(frame, rectangle=_shifted(frame.rectangle, dx, dy)) for frame in self.frames),
            tuple(replace(line, spline=_along(line.spline, dx, dy)) for line in self.lines),
            tuple(replace(part, x=part.x + dx, y=part.y + dy) for part in self.parts),
        )

    def joined(self, *others: Scene) -> Scene:
        """Return this scene with others laid over it."""
        scenes = (self, *others)
        return Scene(
            tuple(frame for scene in scenes for frame in scene.frames),
            tuple(line for scene in scenes for line in scene.lines),
            tuple(part for scene in scenes for part in scene.parts),
        )

    def dot(self, name: str, attributes: Attributes, dpi: int | None = None) -> str:
        """Return the scene as DOT with positions (`neato -n2` draws it as well)."""
        extra = {**attributes, **({"dpi": str(dpi)} if dpi else {})}
        # edgesfirst: Graphviz draws edges before nodes, so a box is never crossed by a line that passes below it.
        lines = [f"digraph {quoted(name)} {{", f'graph [outputorder="edgesfirst" {_pairs(extra)}];', DEFAULTS]
        lines += [
            f'subgraph "cluster_{frame.name}" {{ graph [id="{frame.name}" {_pairs(frame.attributes)} bb="{_numbers(*frame.rectangle)}"]; }}'
            for frame in self.frames
        ]
        lines += [
            f'{quoted(part.name)} [id="{part.name}" {_pairs(part.attributes)} pos="{_numbers(part.x, part.y)}"];'
            for part in self.parts
        ]
        lines += [
            f'{quoted(line.tail)} -> {quoted(line.head)} [id="e{line.edge}" {_pairs(line.attributes)} pos="{line.spline}"];'
            for line in self.lines
        ]
        return "\n".join([*lines, "}", ""])


def placed(layout: dict[str, Any], boxes: dict[str, Attributes], arrows: dict[str, tuple[str, Attributes]]) -> Scene:
    """Read boxes and arrows back from Graphviz's json. Nodes that are not in `box_attributes` (helpers) are left out.

    `arrow_attributes` has for each edge id of the layout the arrow's id and its attributes.
    """
    objects = layout.get("objects", [])
    names = {item["_gvid"]: item["name"] for item in objects}
    parts = tuple(_part(item, boxes[item["name"]]) for item in objects if item["name"] in boxes)
    lines = tuple(
        Line(
            item["id"][1:],
            arrows[item["id"]][0],
            names[item["tail"]],
            names[item["head"]],
            arrows[item["id"]][1],
            item["pos"],
        )
        for item in layout.get("edges", [])
        if item.get("id") in arrows and "pos" in item
    )
    return Scene(lines=lines, parts=parts)


def _part(item: dict[str, Any], attributes: Attributes) -> Part:
    x, y = (float(number) for number in item["pos"].split(","))
    return Part(item["name"], attributes, x, y, float(item["width"]) * 72, float(item["height"]) * 72)


def _along(spline: str, dx: float, dy: float) -> str:
    def shift(found: re.Match[str]) -> str:
        return f"{found['mark'] or ''}{_numbers(float(found['x']) + dx, float(found['y']) + dy)}"

    return _POINT.sub(shift, spline)


def _shifted(rectangle: Rectangle, dx: float, dy: float) -> Rectangle:
    left, bottom, right, top = rectangle
    return (left + dx, bottom + dy, right + dx, top + dy)


def _numbers(*values: float) -> str:
    return ",".join(f"{value:.2f}" for value in values)


def _pairs(attributes: Attributes) -> str:
    return " ".join(f"{name}={value}" for name, value in attributes.items())


def meet(one: Rectangle, other: Rectangle, gap: float = 0.0) -> bool:
    """Return whether two rectangles overlap, or are nearer to each other than a gap."""
    return one[0] < other[2] + gap and other[0] < one[2] + gap and one[1] < other[3] + gap and other[1] < one[3] + gap


def meetings(scene: Scene) -> Iterable[tuple[str, str]]:
    """Yield each pair of boxes, titles and labels that overlap by more than the rounding of a hairline. For tests."""
    parts = [part for part in scene.parts if part.kind != "mark"]
    # A sweep from left to right: nothing that begins beyond a part's right side can overlap it.
    parts.sort(key=lambda part: part.rectangle[0])
    for at, part in enumerate(parts):
        for other in parts[at + 1 :]:
            if other.rectangle[0] >= part.rectangle[2]:
                break
            if meet(part.rectangle, other.rectangle, -0.5):
                yield part.name, other.name
