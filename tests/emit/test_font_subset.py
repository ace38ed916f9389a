"""Fonts inside of pictures: the letters that they show, and no others."""

from __future__ import annotations

import re
import struct
import zlib
from base64 import b64decode

import pytest

from archgen.emit import picture_files
from archgen.emit.graphviz.font_config import FONT_FOLDER
from archgen.emit.picture import Picture
from archgen.emit.picture_files import build_picture_tree, embed_fonts, subset_font

INTER = (FONT_FOLDER / "Inter-Regular.ttf").read_bytes()


def open_woff(data: bytes) -> dict[bytes, bytes]:
    """Return the tables of a WOFF file; its directory says how long they are."""
    assert data[:4] == b"wOFF"
    length, count = struct.unpack_from(">IH", data, 8)
    assert length == len(data)
    tables = {}
    for at in range(count):
        tag, start, packed, whole, _ = struct.unpack_from(">4sIIII", data, 44 + 20 * at)
        block = data[start : start + packed]
        tables[tag] = zlib.decompress(block) if packed < whole else block
        assert len(tables[tag]) == whole
    return tables


def find_outline(tables: dict[bytes, bytes], character: str) -> bytes:
    glyph = picture_files._find_glyph(tables[b"cmap"], ord(character))  # noqa: SLF001 - as a browser finds it
    offsets = picture_files._read_offsets(tables[b"loca"], tables[b"head"])  # noqa: SLF001
    return tables[b"glyf"][offsets[glyph] : offsets[glyph + 1]]


def test_letters_keep_their_outlines_and_others_have_none() -> None:
    whole, small = dict(picture_files._read_tables(INTER)), open_woff(subset_font(INTER, "AgÉ≤→"))  # noqa: SLF001
    for character in "AgÉ≤→":
        outline = find_outline(whole, character)
        assert outline
        assert find_outline(small, character).rstrip(b"\0") == outline.rstrip(b"\0")
    assert picture_files._find_glyph(small[b"cmap"], ord("B")) == 0  # noqa: SLF001
    assert len(small[b"glyf"]) < len(whole[b"glyf"]) / 50
    assert small[b"hmtx"] == whole[b"hmtx"]


@pytest.mark.parametrize("characters", ["", "🤖机\x00\u202e", "\uffff"])
def test_what_the_font_lacks_is_left_out(characters: str) -> None:
    assert open_woff(subset_font(INTER, characters))[b"cmap"]


def test_all_pictures_of_a_folder_bring_the_letters_of_all() -> None:
    pictures = {
        name: Picture(name, 1, 1, f'<svg xmlns="http://www.w3.org/2000/svg"><text>{text}</text></svg>'.encode())
        for name, text in {"a": "One &amp; x", "b": "Zwei"}.items()
    }
    files = build_picture_tree(pictures, ("svg",)).files
    styles = {re.findall(r"<style>(.*)</style>", data.decode())[0] for data in files.values()}
    assert styles == {embed_fonts(picture.svg or b"" for picture in pictures.values())}
    fonts = [b64decode(font) for font in re.findall(r"base64,([^)]*)", styles.pop())]
    assert len(fonts) == 2
    for font in fonts:
        tables = open_woff(font)
        assert all(picture_files._find_glyph(tables[b"cmap"], ord(letter)) for letter in "One&xZwi")  # noqa: SLF001
        assert not picture_files._find_glyph(tables[b"cmap"], ord("q"))  # noqa: SLF001
        assert len(font) < 12_000
