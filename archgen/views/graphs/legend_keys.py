"""Find which forms a picture uses, so that its legend explains these and no others."""

from __future__ import annotations

from typing import get_args

from archgen.frozen import replace
from archgen.views.picture_shapes import Arrow, Box, ElementChange, Graph, PeriodStep

_BADGE_KEYS = ("badge:error", "badge:warning", "badge:note", "badge:inside")
_BOX_KEYS = ("composed", "port", "source", "sink", "reactive", "external", "node", "topic", "fold")
_BOX_KEY_OF_FLOW = {"service": "service-box", "action": "action-box"}
_STATUS_KEYS = ("planned", "adapted")
# The first six of the literals are the steps of the scale; `event` and the others have no period.
_PERIOD_SCALE = get_args(PeriodStep)[:6]
_ARROW_KEYS = ("optional", "made", "physical", "medium", "service", "action", "internal", "link")


def add_legend_keys(graph: Graph, *extra: str) -> Graph:
    """Add the legend keys that a picture needs, in the legend's order."""
    return replace(graph, legend=tuple(dict.fromkeys((*_legend_keys(graph), *extra))))


def _legend_keys(graph: Graph) -> list[str]:
    kinds = {kind for box in graph.boxes for kind in _box_kinds(box)}
    arrow_kinds = {kind for arrow in graph.arrows for kind in _arrow_kinds(arrow)}
    keys = [
        key for key in ("subject", "neighbour", *_BOX_KEYS, *_BOX_KEY_OF_FLOW.values(), *_STATUS_KEYS) if key in kinds
    ]
    keys += [key for key in _BADGE_KEYS if key in kinds]
    keys += _period_keys(graph)
    keys += _change_keys(graph)
    keys += [key for key in _ARROW_KEYS if key in arrow_kinds]
    keys += ["star"] if any(line.startswith("*") for arrow in graph.arrows for line in arrow.label.split("\n")) else []
    # Only these layouts draw the number of flows, as text and as width (`merged` in `style_graph`).
    has_widths = graph.layout in {"two-step", "overview"} and any(arrow.count > 1 for arrow in graph.arrows)
    return [*keys, "count"] if has_widths else keys


def _change_keys(graph: Graph) -> list[str]:
    """Return keys for what happened to boxes and arrows, and for arrows that are as before, where two versions are
    drawn.
    """
    boxes = {"broken" if box.broken else box.change for box in graph.boxes}
    lines = {"broken" if arrow.broken else arrow.change or "same" for arrow in graph.arrows}
    if boxes == {None} and lines <= {"same"}:
        return []
    return [f"change:{kind}" for kind in ("broken", *get_args(ElementChange)) if kind in boxes] + [
        f"line:{kind}" for kind in ("broken", *get_args(ElementChange), "same") if kind in lines
    ]


def _period_keys(graph: Graph) -> list[str]:
    """Return the whole scale of periods where boxes are filled by it, and what else they are filled with."""
    used = {box.fill for box in graph.boxes} - {None}
    return [f"pace:{pace}" for pace in get_args(PeriodStep) if pace in used or pace in _PERIOD_SCALE] if used else []


def _box_kinds(box: Box) -> set[str]:
    kinds = {_BOX_KEY_OF_FLOW.get(box.style, "external" if box.style in {"physical", "partner"} else box.style)}
    kinds |= {f"badge:{box.badge}"} if box.badge else set()
    kinds |= {"badge:inside"} if box.badge_count else set()
    return kinds | {box.emphasis} | ({box.status} if box.status else set())


def _arrow_kinds(arrow: Arrow) -> set[str]:
    return (
        {str(arrow.style)}
        | ({"optional"} if arrow.optional else set())
        | ({"made"} if arrow.is_made else set())
        | ({"medium"} if arrow.medium else set())
    )
