"""Decorate boxes: the heavy side of sources and sinks, the letter of the worst finding."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.emit.graphviz import marks, palette
from archgen.emit.graphviz.scene import Part, Scene
from archgen.views.shapes import Box

_BAR = 3.5
_DISC = 10.0
_LETTERS = {"error": ("E", palette.ERROR), "warning": ("W", palette.WARNING), "note": ("N", palette.NOTE)}


def decorated(scene: Scene, boxes: Mapping[str, Box]) -> Scene:
    """Add the decorations of each box, by the DOT names of the boxes."""
    added = tuple(mark for part in scene.parts if part.name in boxes for mark in _marks(part, boxes[part.name]))
    return replace(scene, parts=scene.parts + added)


def _marks(part: Part, item: Box) -> Iterator[Part]:
    left, _, right, top = part.rectangle
    if item.style in {"source", "sink"}:
        x = right - _BAR / 2 - 0.4 if item.style == "source" else left + _BAR / 2 + 0.4
        # As parts of kind `mark`, since Graphviz has no node with one heavy side; marks may overlap their box.
        yield Part(f"{part.name}bar", _bar(item, part.height), x, part.y, _BAR, part.height, "mark")
    if item.badge:
        yield Part(f"{part.name}badge", _disc(item), right - 3, top - 1, _DISC, _DISC, "mark")


def _bar(item: Box, height: float) -> dict[str, str]:
    frame, _ = marks.colours(item)
    return {
        **_plain(_BAR, max(height - 9, 4)),
        "shape": '"box"',
        "color": f'"{frame}"',
        "fillcolor": f'"{frame}"',
        "penwidth": "0",
        "label": '""',
        "class": '"bar"',
        "tooltip": f'"{item.style}"',
    }


def _disc(item: Box) -> dict[str, str]:
    letter, colour = _LETTERS[item.badge or "note"]
    return {
        **_plain(_DISC, _DISC),
        "shape": '"circle"',
        "color": f'"{palette.PAPER}"',
        "fillcolor": f'"{colour}"',
        "penwidth": "0.6",
        "label": f'<<FONT POINT-SIZE="6.5" COLOR="{palette.PAPER}"><B>{letter}</B></FONT>>',
        "class": f'"badge {item.badge}"',
        "tooltip": f'"has findings, the worst is: {item.badge}"',
    }


def _plain(width: float, height: float) -> dict[str, str]:
    return {
        "style": '"filled"',
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "margin": '"0"',
    }
