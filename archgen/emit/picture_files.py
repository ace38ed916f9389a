"""Give pictures the fonts that they name: cut down to the characters that each shows, as WOFF files inside of it."""

from __future__ import annotations

import re
import struct
import zlib
from base64 import b64encode
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import lru_cache
from html import unescape

from archgen.emit import file_tree
from archgen.emit.graphviz.font_config import FONT_FOLDER
from archgen.emit.picture import Picture
from archgen.emit.safe_names import assign_safe_paths, is_safe_path
from archgen.emit.site import page_pictures as drawing
from archgen.views.shapes import split_anchor

_FOLDER_BY_KIND = {"group": "groups", "component": "components", "view": "views", "chain": "chains", "host": "load"}
"""The folder of an element's picture, by the kind of element."""


def build_picture_tree(pictures: Mapping[str, Picture], formats: Sequence[str]) -> file_tree.FileTree:
    """Build the files of all pictures in these formats (`svg`, `png`, `pdf`, `dot`). Formats that were not drawn are
    left out.
    """
    style = embed_fonts(picture.svg for picture in pictures.values() if picture.svg) if "svg" in formats else ""
    paths = _name_files(pictures)
    files = (
        (f"{paths[name]}.{form}", _picture_bytes(picture, form, paths, style))
        for name, picture in pictures.items()
        for form in formats
    )
    return file_tree.make_file_tree((path, data) for path, data in files if data is not None)


def _name_files(names: Collection[str]) -> Mapping[str, str]:
    """Return the paths of pictures without their endings: their names, unless some system would not take one, or two are one to it."""
    if all(map(is_safe_path, names)) and len(set(map(str.casefold, names))) == len(names):
        return {name: name for name in names}
    return assign_safe_paths(names)


def _picture_bytes(picture: Picture, format_name: str, paths: Mapping[str, str], style: str) -> bytes | None:
    if format_name == "dot":
        return picture.dot.encode()
    # The fields of Picture are called as the formats are.
    data: bytes | None = getattr(picture, format_name)
    if format_name != "svg" or data is None:
        return data
    prefix = "../" * picture.id.count("/")

    def href(anchor: str) -> str | None:
        kind, name = split_anchor(anchor)
        target = f"{_FOLDER_BY_KIND.get(kind, kind)}/{name}"
        return f"{prefix}{paths[target]}.svg" if target in paths and target != picture.id else None

    return drawing.standalone_svg(data, href, style)


_FACES = ((400, "Inter-Regular.ttf"), (700, "Inter-Bold.ttf"))
_TEXT = re.compile(r"<text\b[^<>]*+>([^<]*)")
_KEPT_TABLES = ("OS/2", "head", "hhea", "maxp", "name", "post", "hmtx")
_COMPOSITE_WORDS, _COMPOSITE_MORE = 0x0001, 0x0020
_COMPOSITE_SCALES = ((0x0008, 2), (0x0040, 4), (0x0080, 8))
"""Bits of a part of a composed glyph, and how many bytes of scale each brings."""


def embed_fonts(svgs: Iterable[bytes]) -> str:
    """Return the style that brings the faces of pictures with the characters that any of them shows."""
    characters = {
        character for svg in svgs for text in _TEXT.findall(svg.decode("utf-8")) for character in unescape(text)
    }
    return _write_faces("".join(sorted(characters)))


@lru_cache(4)
def _write_faces(characters: str) -> str:
    faces = []
    for weight, file in _FACES:
        data = b64encode(subset_font((FONT_FOLDER / file).read_bytes(), characters)).decode()
        faces.append(f"@font-face{{font-family:Inter;font-weight:{weight};src:url(data:font/woff;base64,{data})}}")
    return "".join(faces)


def subset_font(data: bytes, characters: Collection[str]) -> bytes:
    """Return a font with the glyphs of these characters, as WOFF; those that it lacks are left out.

    Glyphs keep their numbers, and layout tables go: only pairs of letters stand a little wider than in the whole font.
    """
    tables = dict(_read_tables(data))
    glyph_of = {code: glyph for code in sorted(map(ord, characters)) if (glyph := _find_glyph(tables[b"cmap"], code))}
    glyphs, offsets = bytearray(), [0]
    (count,) = struct.unpack_from(">H", tables[b"maxp"], 4)
    loca = _read_offsets(tables[b"loca"], tables[b"head"])
    used_glyphs = _close_glyphs({0, *glyph_of.values()}, tables[b"glyf"], loca)
    for glyph in range(count):
        if glyph in used_glyphs:
            glyphs += tables[b"glyf"][loca[glyph] : loca[glyph + 1]]
            glyphs += bytes(-len(glyphs) % 4)
        offsets.append(len(glyphs))
    head = bytearray(tables[b"head"])
    struct.pack_into(">h", head, 50, 1)  # long offsets
    kept = {name: tables[name.encode()] for name in _KEPT_TABLES} | {
        "head": bytes(head),
        "cmap": _write_cmap(glyph_of),
        "glyf": bytes(glyphs),
        "loca": struct.pack(f">{len(offsets)}I", *offsets),
    }
    return _write_woff(kept)


def _read_tables(data: bytes) -> Iterable[tuple[bytes, bytes]]:
    (count,) = struct.unpack_from(">H", data, 4)
    for at in range(count):
        tag, _, offset, length = struct.unpack_from(">4sIII", data, 12 + 16 * at)
        yield tag, data[offset : offset + length]


def _find_glyph(cmap: bytes, code: int) -> int:
    """Return the glyph of a character by the font's segments (format 4), 0 for one that it lacks."""
    (count,) = struct.unpack_from(">H", cmap, 2)
    starts = (struct.unpack_from(">I", cmap, 8 + 8 * at)[0] for at in range(count))
    table = next((start for start in starts if struct.unpack_from(">H", cmap, start)[0] == 4), None)  # noqa: PLR2004
    if table is None or code > 0xFFFF:  # noqa: PLR2004 - segments hold the basic plane
        return 0
    (double,) = struct.unpack_from(">H", cmap, table + 6)
    for at in range(0, double, 2):
        end, start = (struct.unpack_from(">H", cmap, table + each + at)[0] for each in (14, 16 + double))
        if start <= code <= end:
            (delta,) = struct.unpack_from(">h", cmap, table + 16 + 2 * double + at)
            place = table + 16 + 3 * double + at
            (distance,) = struct.unpack_from(">H", cmap, place)
            glyph = struct.unpack_from(">H", cmap, place + distance + 2 * (code - start))[0] if distance else code
            return int((glyph + delta) % 0x10000 if glyph else 0)
    return 0


def _read_offsets(loca: bytes, head: bytes) -> list[int]:
    (is_long,) = struct.unpack_from(">h", head, 50)
    if is_long:
        return list(struct.unpack(f">{len(loca) // 4}I", loca))
    return [2 * offset for offset in struct.unpack(f">{len(loca) // 2}H", loca)]


def _close_glyphs(glyphs: Collection[int], glyf: bytes, loca: list[int]) -> set[int]:
    """Return glyphs with all that they are composed of."""
    closed, pending = set[int](), list(glyphs)
    while pending:
        glyph = pending.pop()
        if glyph in closed:
            continue
        closed.add(glyph)
        at, end = loca[glyph], loca[glyph + 1]
        if at == end or struct.unpack_from(">h", glyf, at)[0] >= 0:
            continue
        at += 10
        flags = _COMPOSITE_MORE
        while flags & _COMPOSITE_MORE:
            flags, part = struct.unpack_from(">HH", glyf, at)
            pending.append(part)
            scale = next((size for bit, size in _COMPOSITE_SCALES if flags & bit), 0)
            at += 4 + (4 if flags & _COMPOSITE_WORDS else 2) + scale
    return closed


def _write_cmap(glyph_of: Mapping[int, int]) -> bytes:
    """Write a segment for each character; the last one is the end that the format asks for."""
    pairs = [*glyph_of.items(), (0xFFFF, 0)]
    count = len(pairs)
    power = 1 << (count.bit_length() - 1)
    codes = struct.pack(f">{count}H", *(code for code, _ in pairs))
    deltas = struct.pack(f">{count}H", *((glyph - code) % 0x10000 for code, glyph in pairs))
    search = (2 * power, power.bit_length() - 1, 2 * count - 2 * power)
    body = struct.pack(">4H", 2 * count, *search) + codes + bytes(2) + codes + deltas + bytes(2 * count)
    return struct.pack(">HHHHI", 0, 1, 3, 1, 12) + struct.pack(">HHH", 4, len(body) + 6, 0) + body


def _write_woff(tables: Mapping[str, bytes]) -> bytes:
    directory, blocks = bytearray(), bytearray()
    start = 44 + 20 * len(tables)
    for name in sorted(tables):
        data = tables[name]
        packed = zlib.compress(data, 9)
        packed = packed if len(packed) < len(data) else data
        words = struct.unpack(f">{(len(data) + 3) // 4}I", data + bytes(-len(data) % 4))
        entry = (name.encode(), start + len(blocks), len(packed), len(data), sum(words) % (1 << 32))
        directory += struct.pack(">4sIIII", *entry)
        blocks += packed + bytes(-len(packed) % 4)
    whole = 12 + 16 * len(tables) + sum(len(data) + -len(data) % 4 for data in tables.values())
    length = start + len(blocks)
    head = struct.pack(">4sIIHHIHH", b"wOFF", 0x00010000, length, len(tables), 0, whole, 1, 0) + bytes(20)
    return head + bytes(directory) + bytes(blocks)
