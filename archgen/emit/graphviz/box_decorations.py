"""Decorate boxes: the heavy side of sources and sinks, the letter of the worst finding."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.emit.graphviz import box_styles, palette
from archgen.emit.graphviz.placed_scene import Scene, ScenePart
from archgen.views.graph_shapes import Box

_BAR_WIDTH = 3.5
_BADGE_DIAMETER = 10.0
_DIGIT_WIDTH = 4.4
_BADGE_LETTERS = {"error": ("E", palette.ERROR), "warning": ("W", palette.WARNING), "note": ("N", palette.NOTE)}


def add_decorations(scene: Scene, boxes: Mapping[str, Box]) -> Scene:
    """Add the decorations of each box, by the DOT names of the boxes."""
    decorations = tuple(
        mark for part in scene.parts if part.name in boxes for mark in _decorate_box(part, boxes[part.name])
    )
    return replace(scene, parts=scene.parts + decorations)


def _decorate_box(part: ScenePart, box: Box) -> Iterator[ScenePart]:
    left, _, right, top = part.rectangle
    if box.style in {"source", "sink"}:
        x = right - _BAR_WIDTH / 2 - 0.4 if box.style == "source" else left + _BAR_WIDTH / 2 + 0.4
        # As parts of kind `mark`, since Graphviz has no node with one heavy side; marks may overlap their box.
        yield ScenePart(
            f"{part.name}bar", _bar_attributes(box, part.height), x, part.y, _BAR_WIDTH, part.height, "mark"
        )
    if box.badge:
        width = _BADGE_DIAMETER + (_DIGIT_WIDTH * (len(str(box.badge_count)) + 0.5) if box.badge_count else 0)
        x = right - 3 - (width - _BADGE_DIAMETER) / 2
        yield ScenePart(f"{part.name}badge", _badge_attributes(box, width), x, top - 1, width, _BADGE_DIAMETER, "mark")


def _bar_attributes(box: Box, height: float) -> dict[str, str]:
    frame, _ = box_styles.box_colours(box)
    return {
        **_fixed_shape(_BAR_WIDTH, max(height - 9, 4)),
        "shape": '"box"',
        "color": f'"{frame}"',
        "fillcolor": f'"{frame}"',
        "penwidth": "0",
        "label": '""',
        "class": '"bar"',
        "tooltip": f'"{box.style}"',
    }


def _badge_attributes(box: Box, width: float) -> dict[str, str]:
    letter, colour = _BADGE_LETTERS[box.badge or "note"]
    text = f"{letter} {box.badge_count}" if box.badge_count else letter
    subject = f"{box.badge_count} finding{'s' * (box.badge_count > 1)} inside" if box.badge_count else "has findings"
    return {
        **_fixed_shape(width, _BADGE_DIAMETER),
        **({"shape": '"box"', "style": '"filled,rounded"'} if box.badge_count else {"shape": '"circle"'}),
        "color": f'"{palette.PAPER}"',
        "fillcolor": f'"{colour}"',
        "penwidth": "0.6",
        "label": f'<<FONT POINT-SIZE="6.5" COLOR="{palette.PAPER}"><B>{text}</B></FONT>>',
        "class": f'"badge {box.badge}"',
        "tooltip": f'"{subject}, the worst is: {box.badge}"',
    }


def _fixed_shape(width: float, height: float) -> dict[str, str]:
    return {
        "style": '"filled"',
        "fixedsize": '"true"',
        "width": f"{width / 72:.4f}",
        "height": f"{height / 72:.4f}",
        "margin": '"0"',
    }
