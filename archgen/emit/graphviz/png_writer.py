"""Render PNGs with a palette: all colours of the drawing exactly, and few steps between them where edges are smoothed.

Graphviz's gd writer makes a palette by itself, in little time. Of pictures with many hues it takes two pale fills for
one; those are rendered as plain pixels and get their palette here. Where gd is not built in, cairo writes 24 bits.
"""

from __future__ import annotations

import math
import re
import struct
import zlib
from array import array
from collections import Counter
from collections.abc import Collection, Iterator

from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.placed_scene import DotAttributes, Scene

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_INDEXED = 3
_MAX_COLOURS = 256
_GD_HEADER_SIZE = 11
"""Bytes before the pixels of a gd file: 2 of signature, 2 each of width and height, 1 for true colours, 4 of the
transparent colour.
"""
_FEW_COLOURS = 16
_MAX_OWN_COLOURS = 12
"""Of 16 colours so many may be the drawing's own."""
_HIGH_HALVES = bytes((index << 4) & 0xFF for index in range(256))
_COMPRESSION = 8
"""Of zlib's levels: 9 takes three times as long, a fifth of drawing a picture, for files that are 1.2 % smaller."""
_STEP_BITS = 5
"""Colours that agree in all but this many bits of red, green and blue are one, unless the drawing has them."""


def _correct_palette(data: bytes, colours: Collection[bytes], fills: Collection[bytes]) -> bytes | None:
    """Return a PNG of gd's with the drawing's colours made exact; None if a fill is not in its palette.

    gd counts colours in cells of 8 by 4 by 8 values, and gives each the colour in the middle of its cell. Colours of
    thin lines may be missing: no pixel may be of a line alone.
    """
    chunks = dict(_read_chunks(data))
    width, height, depth, kind = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    entries = [chunks.get(b"PLTE", b"")[at : at + 3] for at in range(0, len(chunks.get(b"PLTE", b"")), 3)]
    exact_colours = {_middle_of_cell(colour): colour for colour in colours}
    if (depth, kind) != (8, _INDEXED) or len(exact_colours) < len(colours):
        return None
    if not {_middle_of_cell(fill) for fill in fills} <= set(entries):
        return None
    table = _ColourTable(colours)
    indices = [table[_pixel_value(exact_colours.get(entry, entry))] for entry in entries]
    # Rows have no filter (a zero before each): indices can be replaced in all of the data at once, but for those zeros.
    pixels = zlib.decompress(chunks[b"IDAT"])
    rows = [pixels[at + 1 : at + 1 + width] for at in range(0, height * (width + 1), width + 1)]
    if any(pixels[at] for at in range(0, height * (width + 1), width + 1)):
        return None
    translation = bytes(indices) + bytes(_MAX_COLOURS - len(indices))
    return _write_png(width, [row.translate(translation) for row in rows], table)


def index_pixels(data: bytes, colours: Collection[bytes]) -> bytes | None:
    """Return a gd file of true colours as a PNG with a palette; None if 256 colours are not enough."""
    width, height = struct.unpack(">HH", data[2:6])
    table = _ColourTable(colours)
    index_of_pixel = table.__getitem__
    # Many rows are the same (empty ones, sides of frames), and each costs some 40 ns a pixel.
    row_cache: dict[bytes, bytes] = {}
    rows = []
    try:
        for at in range(_GD_HEADER_SIZE, _GD_HEADER_SIZE + 4 * width * height, 4 * width):
            row = data[at : at + 4 * width]
            if row not in row_cache:
                row_cache[row] = bytes(map(index_of_pixel, array("I", row)))
            rows.append(row_cache[row])
    except ValueError:  # an index above 255 is no byte
        return None
    return _write_png(width, rows, table)


class _ColourTable(dict[int, int]):
    """Maps pixels, as the numbers that they are in memory, to indices of a palette that grows with them."""

    def __init__(self, colours: Collection[bytes]) -> None:
        super().__init__()
        self.palette: list[bytes] = []
        self.exact_colours = colours
        self._steps: dict[bytes, int] = {}

    def __missing__(self, pixel: int) -> int:
        colour = struct.pack("=I", pixel)[1:]
        step = colour if colour in self.exact_colours else bytes((0, *(part >> _STEP_BITS for part in colour)))
        if step not in self._steps:
            self._steps[step] = len(self.palette)
            self.palette.append(colour)
        self[pixel] = self._steps[step]
        return self[pixel]


def _pixel_value(colour: bytes) -> int:
    """Return a colour as the number that its pixel in a gd file is in memory: a zero before red, green and blue."""
    (value,) = struct.unpack("=I", b"\0" + colour)
    return int(value)


def _middle_of_cell(colour: bytes) -> bytes:
    return bytes(((colour[0] & 0xF8) + 4, (colour[1] & 0xFC) + 2, (colour[2] & 0xF8) + 4))


def _read_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield type and content of each chunk of a PNG; pieces of the image data as one."""
    pieces, offset = [], len(_SIGNATURE)
    while offset < len(data):
        (length,) = struct.unpack(">I", data[offset : offset + 4])
        name, content = data[offset + 4 : offset + 8], data[offset + 8 : offset + 8 + length]
        if name == b"IDAT":
            pieces.append(content)
        else:
            yield name, content
        offset += length + 12
    yield b"IDAT", b"".join(pieces)


def _write_png(width: int, rows: list[bytes], table: _ColourTable) -> bytes:
    """Return a PNG of rows of indices, without filters: these do not help where neighbours are not near in value."""
    palette, depth = table.palette, 8
    few_colours = _choose_few_colours(rows, table)
    if few_colours:
        nearest = bytes(
            min(range(len(few_colours)), key=lambda at: math.dist(colour, few_colours[at])) for colour in palette
        )
        translation = nearest + bytes(_MAX_COLOURS - len(nearest))
        rows = [_pack_halves(row.translate(translation)) for row in rows]
        palette, depth = few_colours, 4
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", width, len(rows), depth, _INDEXED, 0, 0, 0)),
        (b"PLTE", b"".join(palette)),
        (b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), _COMPRESSION)),
        (b"IEND", b""),
    )
    return _SIGNATURE + b"".join(
        struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
        for name, content in chunks
    )


def _choose_few_colours(rows: list[bytes], table: _ColourTable) -> list[bytes]:
    """Return 16 colours with which two pixels fit into a byte: the drawing's own, then the most frequent shades.

    Empty where so many are the drawing's own that edges of letters would be lost. Files are a fifth smaller.
    """
    # A seventh of the rows tells the frequent from the rare.
    counts = Counter(b"".join(rows[::7]))
    indices = range(len(table.palette))
    own = [index for index in indices if table.palette[index] in table.exact_colours]
    shades = sorted((index for index in indices if index not in own), key=lambda index: -counts[index])
    if len(own) > _MAX_OWN_COLOURS:
        return []
    return [table.palette[index] for index in (*own, *shades)][:_FEW_COLOURS]


def _pack_halves(pixels: bytes) -> bytes:
    even = pixels + bytes(len(pixels) % 2)
    high, low = even[0::2].translate(_HIGH_HALVES), even[1::2]
    return (int.from_bytes(high) | int.from_bytes(low)).to_bytes(len(high))


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
        return _correct_palette(layout_engine.render_dot(dot, (_PALETTE_WRITER,))[0], colours, fills)
    except layout_engine.LayoutError:
        return None


def _render_exactly(dot: str, colours: frozenset[bytes]) -> bytes | None:
    """Render pixels and give them a palette, or return None where gd is missing or the colours are too many for one."""
    try:
        return index_pixels(layout_engine.render_to_file(dot, _PIXEL_WRITER), colours)
    except layout_engine.LayoutError:
        return None


def _render_true_colours(dot: str) -> bytes:
    try:
        return layout_engine.render_dot(dot, (_TRUE_COLOUR_WRITER,))[0]
    except layout_engine.LayoutError:
        return layout_engine.render_dot(dot, (_LAST_WRITER,))[0]
