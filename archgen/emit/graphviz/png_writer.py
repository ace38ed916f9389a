"""Render PNGs with a palette: all colours of the drawing exactly, and few steps between them where edges are smoothed.

Graphviz's gd writer makes a palette by itself, in little time. Of pictures with many hues it takes two pale fills for
one; those are rendered as plain pixels and get their palette here. Where gd is not built in, cairo writes 24 bits.
"""

from __future__ import annotations

import math
import re

from archgen.emit.graphviz import layout_engine, png_palette
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene

_TRUE_COLOUR_WRITER = "png:cairo"
_LAST_WRITER = "png"
_PALETTE_WRITER = "png:cairo:gd"
_PIXEL_WRITER = "gd:cairo:gd"
_PAGE_WIDTH, _UPRIGHT_WIDTH = 700.0, 480.0
"""The width of pictures on a landscape and on an upright page, in points."""
_COLOUR = re.compile(r'"#([0-9a-f]{6})"')
_FILL_COLOUR = re.compile(r'(?:fillcolor|BGCOLOR|bgcolor)="#([0-9a-f]{6})"')


def render_png(scene: Scene, name: str, graph_attributes: DotAttributes, *, quick: bool) -> bytes:
    """Render a scene at 144 dots per inch, two to a point. One that is wider than a page, and will be shown smaller, gets 110.

    `quick` tries gd's own palette first: worth it where there are few hues.
    """
    left, bottom, right, top = scene.bounds()
    # Pictures of many colours take twice the bytes.
    dpi = 144 if right - left <= (_PAGE_WIDTH if quick else _UPRIGHT_WIDTH) else 110
    # A viewport of whole pixels. 14 points are the padding at both sides (`pad`, 0.08 inch each) and a little more.
    width, height = (math.ceil((size + 14) * dpi / 72) * 72 / dpi for size in (right - left, top - bottom))
    dot = scene.to_dot(name, {**graph_attributes, "viewport": f'"{width:.4f},{height:.4f}"'}, dpi)
    colours, fills = (
        frozenset(bytes.fromhex(colour) for colour in pattern.findall(dot)) for pattern in (_COLOUR, _FILL_COLOUR)
    )
    return (
        (_render_quickly(dot, colours, fills) if quick else None)
        or _render_exactly(dot, colours)
        or _render_true_colours(dot)
    )


def _render_quickly(dot: str, colours: frozenset[bytes], fills: frozenset[bytes]) -> bytes | None:
    """Render with gd's palette, or return None where gd is missing or took two of the drawing's colours for one."""
    try:
        return png_palette.correct_palette(layout_engine.render_dot(dot, (_PALETTE_WRITER,))[0], colours, fills)
    except layout_engine.LayoutError:
        return None


def _render_exactly(dot: str, colours: frozenset[bytes]) -> bytes | None:
    """Render pixels and give them a palette, or return None where gd is missing or the colours are too many for one."""
    try:
        return png_palette.index_pixels(layout_engine.render_to_file(dot, _PIXEL_WRITER), colours)
    except layout_engine.LayoutError:
        return None


def _render_true_colours(dot: str) -> bytes:
    try:
        return layout_engine.render_dot(dot, (_TRUE_COLOUR_WRITER,))[0]
    except layout_engine.LayoutError:
        return layout_engine.render_dot(dot, (_LAST_WRITER,))[0]
