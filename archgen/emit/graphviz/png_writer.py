"""Render small PNGs quickly: Graphviz's gd writer, with a palette, takes a third of the time and bytes of cairo's.

Its palette is a little off (white comes out as 252, 254, 252): the entries next to one of our colours are corrected. In
pictures of many hues it would take two pale fills for one, so cairo writes those itself, as it does where gd is not
built in.
"""

from __future__ import annotations

import math
import struct
import zlib

from archgen.emit.graphviz import layout_engine, palette
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene

_PNG_WRITERS = ("png:cairo", "png")
_QUICK_WRITER = "png:cairo:gd"
_PAGE_WIDTH = 700.0
"""The width of pictures on a landscape page, in points."""
_GD_MASKS = (0xFC, 0xFE, 0xFC)
"""The bits of red, green and blue that gd's palette keeps."""


def render_png(scene: Scene, name: str, graph_attributes: DotAttributes, *, quick: bool) -> bytes:
    """Render a scene at 150 dots per inch. One that is wider than a page, and will be shown smaller, gets 110."""
    left, bottom, right, top = scene.bounds()
    dpi = 150 if right - left <= _PAGE_WIDTH else 110
    # A viewport of whole pixels. 14 points are the padding at both sides (`pad`, 0.08 inch each) and a little more.
    width, height = (math.ceil((size + 14) * dpi / 72) * 72 / dpi for size in (right - left, top - bottom))
    dot = scene.to_dot(name, {**graph_attributes, "viewport": f'"{width:.4f},{height:.4f}"'}, dpi)
    for writer in (*([_QUICK_WRITER] if quick else []), *_PNG_WRITERS[:-1]):
        try:
            data = layout_engine.render_dot(dot, (writer,))[0]
        except layout_engine.LayoutError:
            continue
        return snap_palette(data) if writer == _QUICK_WRITER else data
    return layout_engine.render_dot(dot, _PNG_WRITERS[-1:])[0]


def snap_palette(data: bytes) -> bytes:
    """Replace palette entries that are nearly one of our colours by that colour."""
    # A PNG chunk is length, type, data, CRC of type and data. PLTE comes before the image data, so the first hit is it.
    offset = data.find(b"PLTE")
    if offset < 0:
        return data
    (length,) = struct.unpack(">I", data[offset - 4 : offset])
    entries = data[offset + 4 : offset + 4 + length]
    triples = (entries[each : each + 3] for each in range(0, length, 3))
    exact_entries = b"".join(_EXACT_COLOURS.get(triple, triple) for triple in triples)
    checksum = struct.pack(">I", zlib.crc32(b"PLTE" + exact_entries))
    return data[: offset + 4] + exact_entries + checksum + data[offset + 8 + length :]


def _mask_colour(colour: bytes) -> bytes:
    """Return a colour without the bits that gd's palette leaves out."""
    return bytes(part & mask for part, mask in zip(colour, _GD_MASKS, strict=True))


_EXACT_COLOURS = {
    _mask_colour(colour): colour for colour in (bytes.fromhex(light[1:]) for light, _ in palette.dark_pairs())
}
