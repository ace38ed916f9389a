"""Scenes: drawings whose parts have their places. Layouts make them, and they are rendered without moving anything.

Edges are drawn over frames, and everything else over edges, so that a text is never crossed by a line. Coordinates are
in points, y upwards. Labels of edges and titles of frames are parts of their own (`ScenePart.kind`), because Graphviz
draws its own below the edges and lets them overlap.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Literal

from archgen.emit.graphviz.dot_text import quote_value
from archgen.frozen import dataclass, replace

DotAttributes = dict[str, str]
"""DOT attributes as they are written: values quoted, or html-like in angle brackets."""
ScenePoint = tuple[float, float]
Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top; in points."""

FONT_NAME = "Inter,Arial,Liberation Sans,Helvetica,DejaVu Sans,sans-serif"
"""Inter as in the site; DejaVu Sans has the letters and signs that it lacks, and both ship with archgen. Where a picture is opened without
them, those between are no wider than Inter, so that text stays in its box; DejaVu Sans is wider by an eighth.
"""
DOT_DEFAULTS = (
    f'node [fontname="{FONT_NAME}" fontsize="9" fontcolor="#1b2127"]; edge [fontname="{FONT_NAME}" fontsize="8"];'
)
_SPLINE_POINT = re.compile(
    r"(?P<mark>[se],)?(?<![0-9.])(?P<x>-?[0-9.]++(?:e[-+]?[0-9]++)?),(?P<y>-?[0-9.]++(?:e[-+]?[0-9]++)?)"
)


@dataclass(frozen=True, slots=True)
class ScenePart:
    """Something with a middle and a size. A `mark` decorates a box and may overlap it."""

    name: str
    attributes: DotAttributes
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

    def moved_to(self, x: float, y: float) -> ScenePart:
        """Return the part with its middle elsewhere. `replace` takes four times as long."""
        return ScenePart(self.name, self.attributes, x, y, self.width, self.height, self.kind)


@dataclass(frozen=True, slots=True)
class SceneLine:
    """An edge with its spline as Graphviz writes it. `edge` is its number in the graph, `arrow` the id of the graph's
    arrow.
    """

    edge: str
    arrow: str
    tail: str
    head: str
    attributes: DotAttributes
    spline: str

    @property
    def curve(self) -> tuple[ScenePoint, ...]:
        """The points of the Bézier curves, without the tips of arrow heads."""
        return _read_curve(self.spline)

    @property
    def points(self) -> tuple[ScenePoint, ...]:
        """The points of the spline and the tips of its arrow heads, in no particular order."""
        return tuple([point for _, point in _read_spline(self.spline)])

    @property
    def bounds(self) -> Rectangle | None:
        """The rectangle round these points; None where there are none."""
        return _bound_spline(self.spline)


# Layouts ask for the same splines again and again.
@lru_cache(8192)
def _read_spline(spline: str) -> tuple[tuple[str, ScenePoint], ...]:
    """Parse a spline: its points, with `s,` or `e,` for the tips of arrow heads."""
    return tuple([(mark, (float(x), float(y))) for mark, x, y in _SPLINE_POINT.findall(spline)])


@lru_cache(8192)
def _read_curve(spline: str) -> tuple[ScenePoint, ...]:
    return tuple([point for mark, point in _read_spline(spline) if not mark])


@lru_cache(8192)
def _bound_spline(spline: str) -> Rectangle | None:
    points = [point for _, point in _read_spline(spline)]
    if not points:
        return None
    xs, ys = zip(*points, strict=True)
    return (min(xs), min(ys), max(xs), max(ys))


@dataclass(frozen=True, slots=True)
class SceneFrame:
    """A rectangle behind everything: a cluster's frame."""

    name: str
    attributes: DotAttributes
    rectangle: Rectangle


@dataclass(frozen=True, slots=True)
class Scene:
    """A drawing whose parts have their places."""

    frames: tuple[SceneFrame, ...] = ()
    lines: tuple[SceneLine, ...] = ()
    parts: tuple[ScenePart, ...] = ()

    def bounds(self) -> Rectangle:
        """Return the rectangle round everything."""
        rectangles = [frame.rectangle for frame in self.frames] + [part.rectangle for part in self.parts]
        rectangles += [bounds for line in self.lines if (bounds := line.bounds)]
        if not rectangles:
            return (0.0, 0.0, 0.0, 0.0)
        left, bottom, right, top = zip(*rectangles, strict=True)
        return (min(left), min(bottom), max(right), max(top))

    def moved(self, dx: float, dy: float) -> Scene:
        """Return the scene shifted."""
        return Scene(
            tuple(replace(frame, rectangle=_shift_rectangle(frame.rectangle, dx, dy)) for frame in self.frames),
            tuple(replace(line, spline=_shift_spline(line.spline, dx, dy)) for line in self.lines),
            tuple([part.moved_to(part.x + dx, part.y + dy) for part in self.parts]),
        )

    def joined(self, *others: Scene) -> Scene:
        """Return this scene with others laid over it."""
        scenes = (self, *others)
        return Scene(
            tuple(frame for scene in scenes for frame in scene.frames),
            tuple(line for scene in scenes for line in scene.lines),
            tuple(part for scene in scenes for part in scene.parts),
        )

    def to_dot(self, name: str, attributes: DotAttributes, dpi: int | None = None) -> str:
        """Return the scene as DOT with positions (`neato -n2` draws it as well)."""
        graph_attributes = {**attributes, **({"dpi": str(dpi)} if dpi else {})}
        # edgesfirst: Graphviz draws edges before nodes, so a box is never crossed by a line that passes below it.
        lines = [
            f"digraph {quote_value(name)} {{",
            f'graph [outputorder="edgesfirst" {format_attributes(graph_attributes)}];',
            DOT_DEFAULTS,
        ]
        lines += [
            f'subgraph "cluster_{frame.name}" {{ graph [id="{frame.name}" {format_attributes(frame.attributes)} bb="{_format_numbers(*frame.rectangle)}"]; }}'
            for frame in self.frames
        ]
        lines += [
            f'{quote_value(part.name)} [id="{part.name}" {format_attributes(part.attributes)} pos="{_format_numbers(part.x, part.y)}"];'
            for part in self.parts
        ]
        lines += [
            f'{quote_value(line.tail)} -> {quote_value(line.head)} [id="e{line.edge}" {format_attributes(line.attributes)} pos="{line.spline}"];'
            for line in self.lines
        ]
        return "\n".join([*lines, "}", ""])


def read_scene(
    layout: dict[str, Any],
    box_attributes: dict[str, DotAttributes],
    arrow_attributes: dict[str, tuple[str, DotAttributes]],
) -> Scene:
    """Read boxes and arrows back from Graphviz's json. Nodes that are not in `box_attributes` (helpers) are left out.

    `arrow_attributes` has for each edge id of the layout the arrow's id and its attributes.
    """
    objects = layout.get("objects", [])
    names = {item["_gvid"]: item["name"] for item in objects}
    parts = tuple(_read_part(item, box_attributes[item["name"]]) for item in objects if item["name"] in box_attributes)
    lines = tuple(
        SceneLine(
            item["id"][1:],
            arrow_attributes[item["id"]][0],
            names[item["tail"]],
            names[item["head"]],
            arrow_attributes[item["id"]][1],
            item["pos"],
        )
        for item in layout.get("edges", [])
        if item.get("id") in arrow_attributes and "pos" in item
    )
    return Scene(lines=lines, parts=parts)


def _read_part(item: dict[str, Any], attributes: DotAttributes) -> ScenePart:
    x, y = (float(number) for number in item["pos"].split(","))
    return ScenePart(item["name"], attributes, x, y, float(item["width"]) * 72, float(item["height"]) * 72)


def _shift_spline(spline: str, dx: float, dy: float) -> str:
    def shift(match: re.Match[str]) -> str:
        return f"{match['mark'] or ''}{_format_numbers(float(match['x']) + dx, float(match['y']) + dy)}"

    return _SPLINE_POINT.sub(shift, spline)


def _shift_rectangle(rectangle: Rectangle, dx: float, dy: float) -> Rectangle:
    left, bottom, right, top = rectangle
    return (left + dx, bottom + dy, right + dx, top + dy)


def _format_numbers(*values: float) -> str:
    return ",".join(f"{value:.2f}" for value in values)


def format_attributes(attributes: DotAttributes) -> str:
    """Return attributes as DOT writes them."""
    return " ".join(f"{name}={value}" for name, value in attributes.items())
