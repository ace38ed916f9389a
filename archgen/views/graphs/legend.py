"""Find which forms a picture uses, so that its legend explains these and no others."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

from archgen.views.shapes import Arrow, Box, Changed, Graph, Pace

_BOXES = ("source", "sink", "reactive", "external", "node", "topic", "fold")
_BOX_OF_FLOW = {"service": "service-box", "action": "action-box"}
_STATUSES = ("planned", "adapted")
# The first six of the literals are the steps of the scale; `event` and the others have no period.
_SCALE = get_args(Pace)[:6]
_ARROWS = ("optional", "physical", "service", "action", "internal", "link")


def with_legend(graph: Graph, *extra: str) -> Graph:
    """Add the legend keys that a picture needs, in the legend's order."""
    return replace(graph, legend=tuple(dict.fromkeys((*_keys(graph), *extra))))


def _keys(graph: Graph) -> list[str]:
    kinds = {kind for box in graph.boxes for kind in _kinds(box)}
    strokes = {kind for arrow in graph.arrows for kind in _strokes(arrow)}
    keys = [key for key in ("subject", "neighbour", *_BOXES, *_BOX_OF_FLOW.values(), *_STATUSES) if key in kinds]
    keys += _paces(graph)
    keys += _changes(graph)
    keys += [key for key in _ARROWS if key in strokes]
    keys += ["star"] if any(line.startswith("*") for arrow in graph.arrows for line in arrow.label.split("\n")) else []
    # Only these layouts draw the number of flows as width (`merged` in `style_graph`).
    wide = graph.layout in {"two-step", "overview"} and any(arrow.count > 1 for arrow in graph.arrows)
    return [*keys, "width", "count"] if wide else keys


def _changes(graph: Graph) -> list[str]:
    """Return keys for what happened to boxes and arrows, and for arrows that are as before, where two versions are
    drawn.
    """
    boxes = {box.change for box in graph.boxes}
    lines = {arrow.change or "same" for arrow in graph.arrows}
    if boxes == {None} and lines <= {"same"}:
        return []
    return [f"change:{kind}" for kind in get_args(Changed) if kind in boxes] + [
        f"line:{kind}" for kind in (*get_args(Changed), "same") if kind in lines
    ]


def _paces(graph: Graph) -> list[str]:
    """Return the whole scale of periods where boxes are filled by it, and what else they are filled with."""
    used = {box.fill for box in graph.boxes} - {None}
    return [f"pace:{pace}" for pace in get_args(Pace) if pace in used or pace in _SCALE] if used else []


def _kinds(box: Box) -> set[str]:
    kinds = {_BOX_OF_FLOW.get(box.style, "external" if box.style in {"physical", "partner"} else box.style)}
    return kinds | {box.emphasis} | ({box.status} if box.status else set())


def _strokes(arrow: Arrow) -> set[str]:
    return {str(arrow.style)} | ({"optional"} if arrow.optional else set())
