"""Render small PNGs quickly: Graphviz's gd writer, with a palette, takes a third of the time and bytes of cairo's.

Its palette is a little off (white comes out as 252, 254, 252): the entries next to one of our colours are corrected. In
pictures of many hues it would take two pale fills for one, so cairo writes those itself, as it does where gd is not
built in.
"""

from __future__ import annotations

import math
import struct
import zlib

from archgen.emit.graphviz import engine, palette
from archgen.emit.graphviz.scene import Attributes, Scene

_WRITERS = ("png:cairo", "png")
_QUICK = "png:cairo:gd"
_PAGE = 700.0
"""The width of pictures on a landscape page, in points."""
_MASKS = (0xFC, 0xFE, 0xFC)
"""The bits of red, green and blue that gd's palette keeps."""


def png(scene: Scene, name: str, look: Attributes, *, quick: bool) -> bytes:
    """Render a scene at 150 dots per inch. One that is wider than a page, and will be shown smaller, gets 110."""
    left, bottom, right, top = scene.bounds()
    dpi = 150 if right - left <= _PAGE else 110
    # A viewport of whole pixels. 14 points are the padding at both sides (`pad`, 0.08 inch each) and a little more.
    width, height = (math.ceil((size + 14) * dpi / 72) * 72 / dpi for size in (right - left, top - bottom))
    dot = scene.dot(name, {**look, "viewport": f'"{width:.4f},{height:.4f}"'}, dpi)
    for writer in (*([_QUICK] if quick else []), *_WRITERS[:-1]):
        try:
            data = engine.render(dot, (writer,))[0]
        except engine.LayoutError:
            continue
        return snapped(data) if writer == _QUICK else data
    return engine.render(dot, _WRITERS[-1:])[0]


def snapped(data: bytes) -> bytes:
    """Replace palette entries that are nearly one of our colours by that colour."""
    # A PNG chunk is length, type, data, CRC of type and data. PLTE comes before the image data, so the first hit is it.
    at = data.find(b"PLTE")
    if at < 0:
        return data
    (length,) = struct.unpack(">I", data[at - 4 : at])
    entries = data[at + 4 : at + 4 + length]
    triples = (entries[each : each + 3] for each in range(0, length, 3))
    exact = b"".join(_OURS.get(triple, triple) for triple in triples)
    check = struct.pack(">I", zlib.crc32(b"PLTE" + exact))
    return data[: at + 4] + exact + check + data[at + 8 + length :]


def _coarse(colour: bytes) -> bytes:
    """Return a colour without the bits that gd's palette leaves out."""
    return bytes(part & mask for part, mask in zip(colour, _MASKS, strict=True))


_OURS = {_coarse(colour): colour for colour in (bytes.fromhex(light[1:]) for light, _ in palette.dark_pairs())}
