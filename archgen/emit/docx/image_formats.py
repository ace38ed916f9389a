"""Pictures' bytes from strangers: which format they are, how large they want to be, and a stand-in for what cannot be shown.

python-docx's `Image` knows no SVG, and raises UnrecognizedImageError for JPEG files without a JFIF or Exif header.
"""

from __future__ import annotations

import re
import struct
import zlib
from dataclasses import dataclass
from typing import Literal

from lxml import etree

_SCREEN_DPI = 96.0
_POINTS_PER_INCH = 72.0
_MIN_DPI, _MAX_DPI = 30.0, 2400.0
"""Resolutions outside of these are mistakes of the program that wrote the file."""
_JPEG_FRAMES = frozenset({0xC0, 0xC1, 0xC2, 0xC3, 0xC5, 0xC6, 0xC7, 0xC9, 0xCA, 0xCB, 0xCD, 0xCE, 0xCF})
"""Markers of segments that hold the size."""
_UNIT_POINTS = {"": 0.75, "px": 0.75, "pt": 1.0, "mm": 72 / 25.4, "cm": 72 / 2.54, "in": 72.0, "pc": 12.0}
_LENGTH = re.compile(r"\s*+((?:[0-9]*+\.)?[0-9]++(?:e[0-9]++)?)\s*+(px|pt|mm|cm|in|pc|)\s*+\Z", re.IGNORECASE)
_MAX_SIDE = 1_000_000.0
_DEFAULT_SIDES = (300.0, 150.0)
"""What browsers take for an SVG without a size."""
_STAND_IN_WIDTH = 200


@dataclass(frozen=True, slots=True)
class ImageFormat:
    """The format of a picture, and its size in points."""

    kind: Literal["png", "jpeg", "gif", "svg"]
    width: float
    height: float


def recognise_image(data: bytes) -> ImageFormat | None:
    """Return what a picture is by its first bytes; None for what Word cannot show."""
    try:
        image = _read_png(data) or _read_gif(data) or _read_jpeg(data) or _read_svg(data)
    except (struct.error, IndexError, OverflowError):
        return None
    return image if image and 0 < image.width < _MAX_SIDE and 0 < image.height < _MAX_SIDE else None


def draw_stand_in(width: float, height: float) -> bytes:
    """Return a PNG that is an empty frame of a picture's shape, for programs that cannot show the picture itself."""
    wide = _STAND_IN_WIDTH
    high = max(4, min(2000, round(wide * height / width)))
    edge = bytes([0]) + b"\xa9\xb4\xbd" * wide
    inner = bytes([0]) + b"\xa9\xb4\xbd" + b"\xf3\xf5\xf7" * (wide - 2) + b"\xa9\xb4\xbd"
    data = zlib.compress(edge + inner * (high - 2) + edge, 9)
    header = struct.pack(">IIBBBBB", wide, high, 8, 2, 0, 0, 0)
    chunks = (_pack_chunk(b"IHDR", header), _pack_chunk(b"IDAT", data), _pack_chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def _pack_chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _create_raster(
    kind: Literal["png", "jpeg", "gif"], pixels: tuple[int, int], dpi: tuple[float, float] = (_SCREEN_DPI, _SCREEN_DPI)
) -> ImageFormat:
    across, down = (value if _MIN_DPI <= value <= _MAX_DPI else _SCREEN_DPI for value in dpi)
    return ImageFormat(kind, pixels[0] * _POINTS_PER_INCH / across, pixels[1] * _POINTS_PER_INCH / down)


def _read_png(data: bytes) -> ImageFormat | None:
    if not data.startswith(b"\x89PNG\r\n\x1a\n") or data[12:16] != b"IHDR":
        return None
    pixels = struct.unpack(">II", data[16:24])
    # The chunk stands before the pixels, in which these letters may mean anything.
    place = data.find(b"pHYs", 0, 4096)
    if place > 0 and data[place + 12] == 1:  # pixels per metre
        across, down = struct.unpack(">II", data[place + 4 : place + 12])
        return _create_raster("png", pixels, (across * 0.0254, down * 0.0254))
    return _create_raster("png", pixels)


def _read_gif(data: bytes) -> ImageFormat | None:
    return _create_raster("gif", struct.unpack("<HH", data[6:10])) if data[:6] in {b"GIF87a", b"GIF89a"} else None


def _read_jpeg(data: bytes) -> ImageFormat | None:
    if not data.startswith(b"\xff\xd8\xff"):
        return None
    place, dpi = 2, (_SCREEN_DPI, _SCREEN_DPI)
    while data[place] == 0xFF:  # noqa: PLR2004 - every segment begins with it
        marker, length = data[place + 1], struct.unpack(">H", data[place + 2 : place + 4])[0]
        if marker in _JPEG_FRAMES:
            height, width = struct.unpack(">HH", data[place + 5 : place + 9])
            return _create_raster("jpeg", (width, height), dpi)
        if marker == 0xE0 and data[place + 4 : place + 8] == b"JFIF" and data[place + 11] in {1, 2}:  # noqa: PLR2004 - APP0
            scale = 1 if data[place + 11] == 1 else 2.54  # per inch, per centimetre
            across, down = struct.unpack(">HH", data[place + 12 : place + 16])
            dpi = (across * scale, down * scale)
        place += 2 + length
    return None


def _read_svg(data: bytes) -> ImageFormat | None:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError):
        return None
    # A picture that declares entities may grow to any size in the program that shows it.
    if etree.QName(root).localname != "svg" or b"<!ENTITY" in data:
        return None
    box = re.split(r"[\s,]+", root.get("viewBox", "").strip())
    sides = [_read_length(root.get(name, "")) for name in ("width", "height")]
    if not all(sides) and len(box) == 4:  # noqa: PLR2004 - x, y, width, height
        sides = [_read_length(box[2]), _read_length(box[3])]
    return ImageFormat("svg", sides[0] or _DEFAULT_SIDES[0], sides[1] or _DEFAULT_SIDES[1])


def _read_length(text: str) -> float:
    """Return a length of SVG in points, 0 for a share of the page and for what is no length."""
    match = _LENGTH.match(text)
    return float(match[1]) * _UNIT_POINTS[match[2].lower()] if match else 0.0
