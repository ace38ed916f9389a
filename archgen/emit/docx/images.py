"""Pictures' bytes from strangers: which format they are, how large they want to be, and a stand-in for what cannot be shown."""

from __future__ import annotations

import re
import struct
import zlib
from dataclasses import dataclass

from lxml import etree

_SCREEN = 96.0
_POINTS = 72.0
_LEAST_DPI, _MOST_DPI = 30.0, 2400.0
_FRAMES = frozenset({0xC0, 0xC1, 0xC2, 0xC3, 0xC5, 0xC6, 0xC7, 0xC9, 0xCA, 0xCB, 0xCD, 0xCE, 0xCF})
_UNITS = {"": 0.75, "px": 0.75, "pt": 1.0, "mm": 72 / 25.4, "cm": 72 / 2.54, "in": 72.0, "pc": 12.0}
_LENGTH = re.compile(r"\s*([0-9]*\.?[0-9]+(?:e[0-9]+)?)\s*(px|pt|mm|cm|in|pc|)\s*\Z", re.IGNORECASE)
_LARGEST = 1_000_000.0
_NO_SIZE = (300.0, 150.0)


@dataclass(frozen=True, slots=True)
class Image:
    """A picture as it came: its format (png, jpeg, gif, svg) and its size in points."""

    kind: str
    width: float
    height: float


def recognise(data: bytes) -> Image | None:
    """Tell what a picture is by its first bytes; None for what Word cannot show."""
    try:
        found = _png(data) or _gif(data) or _jpeg(data) or _svg(data)
    except (struct.error, IndexError, OverflowError):
        return None
    return found if found and 0 < found.width < _LARGEST and 0 < found.height < _LARGEST else None


def stand_in(width: float, height: float) -> bytes:
    """Make a PNG that is an empty frame of a picture's shape, for programs that cannot show the picture itself."""
    wide = 200
    high = max(4, min(2000, round(wide * height / width)))
    edge = bytes([0]) + b"\xa9\xb4\xbd" * wide
    inner = bytes([0]) + b"\xa9\xb4\xbd" + b"\xf3\xf5\xf7" * (wide - 2) + b"\xa9\xb4\xbd"
    data = zlib.compress(edge + inner * (high - 2) + edge, 9)
    header = struct.pack(">IIBBBBB", wide, high, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _image(kind: str, size: tuple[int, int], dpi: tuple[float, float] = (_SCREEN, _SCREEN)) -> Image:
    across, down = (value if _LEAST_DPI <= value <= _MOST_DPI else _SCREEN for value in dpi)
    return Image(kind, size[0] * _POINTS / across, size[1] * _POINTS / down)


def _png(data: bytes) -> Image | None:
    if not data.startswith(b"\x89PNG\r\n\x1a\n") or data[12:16] != b"IHDR":
        return None
    size = struct.unpack(">II", data[16:24])
    place = data.find(b"pHYs", 0, 4096)
    if place > 0 and data[place + 12] == 1:
        across, down = struct.unpack(">II", data[place + 4 : place + 12])
        return _image("png", size, (across * 0.0254, down * 0.0254))
    return _image("png", size)


def _gif(data: bytes) -> Image | None:
    return _image("gif", struct.unpack("<HH", data[6:10])) if data[:6] in {b"GIF87a", b"GIF89a"} else None


def _jpeg(data: bytes) -> Image | None:
    if not data.startswith(b"\xff\xd8\xff"):
        return None
    place, dpi = 2, (_SCREEN, _SCREEN)
    while data[place] == 0xFF:  # noqa: PLR2004 - every segment begins with it
        marker, length = data[place + 1], struct.unpack(">H", data[place + 2 : place + 4])[0]
        if marker in _FRAMES:
            height, width = struct.unpack(">HH", data[place + 5 : place + 9])
            return _image("jpeg", (width, height), dpi)
        if marker == 0xE0 and data[place + 4 : place + 8] == b"JFIF" and data[place + 11] in {1, 2}:  # noqa: PLR2004 - APP0
            scale = 1 if data[place + 11] == 1 else 2.54
            across, down = struct.unpack(">HH", data[place + 12 : place + 16])
            dpi = (across * scale, down * scale)
        place += 2 + length
    return None


def _svg(data: bytes) -> Image | None:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError):
        return None
    if etree.QName(root).localname != "svg" or b"<!ENTITY" in data:
        return None
    box = re.split(r"[\s,]+", root.get("viewBox", "").strip())
    sides = [_length(root.get(name, "")) for name in ("width", "height")]
    if not all(sides) and len(box) == 4:  # noqa: PLR2004 - x, y, width, height
        sides = [_length(box[2]), _length(box[3])]
    return Image("svg", sides[0] or _NO_SIZE[0], sides[1] or _NO_SIZE[1])


def _length(text: str) -> float:
    match = _LENGTH.match(text)
    return float(match[1]) * _UNITS[match[2].lower()] if match else 0.0
