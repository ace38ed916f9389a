"""Render small PNGs quickly: Graphviz's gd writer, with a palette, takes a third of the time and bytes of cairo's.

Its palette is a little off (white comes out as 252, 254, 252): the entries next to one of our colours are corrected. In
pictures of many hues it would take two pale fills for one, so cairo writes those itself, as it does where gd is not
built in.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator, Sequence

from archgen.emit.graphviz import layout_engine, palette
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene

_PNG_WRITERS = ("png:cairo", "png")
_QUICK_WRITER = "png:cairo:gd"
_COLOUR_COUNT = 16
_MAX_OWN_COLOURS = 9
"""Of 16 colours so many may be our own: the others are shades at the edges of letters and lines."""
_HIGH_HALVES = bytes((index << 4) & 0xFF for index in range(256))
_PAGE_WIDTH = 700.0
"""The width of pictures on a landscape page, in points."""
_UPRIGHT_WIDTH = 480.0
_GD_MASKS = (0xFC, 0xFE, 0xFC)
"""The bits of red, green and blue that gd's palette keeps."""


def render_png(scene: Scene, name: str, graph_attributes: DotAttributes, *, quick: bool) -> bytes:
    """Render a scene at 150 dots per inch. One that is wider than a page, and will be shown smaller, gets 110.

    A turned page counts for pictures of few colours, an upright one for the others, which take four times the bytes.
    """
    left, bottom, right, top = scene.bounds()
    dpi = 150 if right - left <= (_PAGE_WIDTH if quick else _UPRIGHT_WIDTH) else 110
    # A viewport of whole pixels. 14 points are the padding at both sides (`pad`, 0.08 inch each) and a little more.
    width, height = (math.ceil((size + 14) * dpi / 72) * 72 / dpi for size in (right - left, top - bottom))
    dot = scene.to_dot(name, {**graph_attributes, "viewport": f'"{width:.4f},{height:.4f}"'}, dpi)
    for writer in (*([_QUICK_WRITER] if quick else []), *_PNG_WRITERS[:-1]):
        try:
            data = layout_engine.render_dot(dot, (writer,))[0]
        except layout_engine.LayoutError:
            continue
        return reduce_palette(snap_palette(data)) if writer == _QUICK_WRITER else data
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


def reduce_palette(data: bytes) -> bytes:
    """Return a PNG of 256 colours with 16, two pixels to a byte: a third smaller, and to the eye the same.

    Our own colours come first, then the shades between them that are most frequent; the others become the nearest of these.
    What is no such PNG stays as it is.
    """
    chunks = dict(_list_chunks(data))
    width, height, depth, kind = struct.unpack(">IIBB", chunks.get(b"IHDR", bytes(13))[:10])
    if (depth, kind) != (8, 3):
        return data
    lines = zlib.decompress(b"".join(body for name, body in _list_chunks(data) if name == b"IDAT"))
    if lines[:: width + 1].strip(b"\0"):
        return data  # lines are written as differences to others
    palette_bytes = chunks[b"PLTE"]
    colours = [palette_bytes[each : each + 3] for each in range(0, len(palette_bytes), 3)]
    kept_indices = _choose_colours(colours, lines)
    if not kept_indices:
        return data
    nearest = bytes(
        min(range(len(kept_indices)), key=lambda at: _measure_distance(colour, colours[kept_indices[at]]))
        for colour in colours
    )
    pixels = lines.translate(nearest + bytes(256 - len(nearest)))
    packed_lines = b"".join(
        b"\0" + _pack_line(pixels[start + 1 : start + 1 + width]) for start in range(0, len(pixels), width + 1)
    )
    header = struct.pack(">IIBBBBB", width, height, 4, 3, 0, 0, 0)
    bodies = (
        (b"IHDR", header),
        (b"PLTE", b"".join(colours[index] for index in kept_indices)),
        *(((b"pHYs", chunks[b"pHYs"]),) if b"pHYs" in chunks else ()),
        (b"IDAT", zlib.compress(packed_lines, 9)),
        (b"IEND", b""),
    )
    return data[:8] + b"".join(_write_chunk(name, body) for name, body in bodies)


def _list_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    position = 8
    while position < len(data):
        (length,) = struct.unpack(">I", data[position : position + 4])
        yield data[position + 4 : position + 8], data[position + 8 : position + 8 + length]
        position += length + 12


def _write_chunk(name: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def _choose_colours(colours: Sequence[bytes], lines: bytes) -> list[int]:
    """Return the indices of the colours that stay; empty where so many are our own that shades would be lost."""
    # A seventh of the pixels tells the frequent from the rare; all of them would take longer than the drawing.
    sample = lines[::7]
    counts = [sample.count(index) for index in range(len(colours))]
    own = [index for index, colour in enumerate(colours) if colour in _OWN_COLOURS and counts[index]]
    if len(own) > _MAX_OWN_COLOURS:
        return []
    others = sorted((index for index in range(len(colours)) if index not in own), key=lambda index: -counts[index])
    return [*own, *others][:_COLOUR_COUNT]


def _measure_distance(one: bytes, other: bytes) -> int:
    return sum((first - second) ** 2 for first, second in zip(one, other, strict=True))


def _pack_line(pixels: bytes) -> bytes:
    """Return pixels of a byte each as half a byte each."""
    even = pixels + bytes(len(pixels) % 2)
    high, low = even[0::2].translate(_HIGH_HALVES), even[1::2]
    return (int.from_bytes(high) | int.from_bytes(low)).to_bytes(len(high))


def _mask_colour(colour: bytes) -> bytes:
    """Return a colour without the bits that gd's palette leaves out."""
    return bytes(part & mask for part, mask in zip(colour, _GD_MASKS, strict=True))


_EXACT_COLOURS = {
    _mask_colour(colour): colour for colour in (bytes.fromhex(light[1:]) for light, _ in palette.dark_pairs())
}
_OWN_COLOURS = frozenset(_EXACT_COLOURS.values()) | {b"\xff\xff\xff"}
