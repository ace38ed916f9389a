"""Bars in the text are as long as what they stand for, and never longer than their place."""

from __future__ import annotations

import io
import re
import zipfile

import pytest

from archgen.emit.docx import write
from archgen.emit.docx.text_pieces import format_bar
from archgen.views.shapes import Column, Meter, Outline, Section, Table, Text, WaterfallPiece


def document(data: bytes) -> str:
    return zipfile.ZipFile(io.BytesIO(data)).read("word/document.xml").decode()


def report(outline: Outline) -> bytes:
    return write(outline, {}, chapter_files=lambda _path: None)[0]


def test_a_bar_is_as_long_as_its_share() -> None:
    cells = tuple(((Text("", meter=Meter(share, "met")),),) for share in (0.0, 0.25, 1.0, 3.0))
    xml = document(report(Outline("T", sections=(Section("a", "A", (Table("t", "T", (Column("Used"),), cells),)),))))
    bars = [
        [len(found) for found in re.findall(r'w:fill="1C6B3C"/></w:rPr><w:t [^>]*>(\u00a0+)<', row)]
        for row in xml.split("<w:tr>")[2:]
    ]
    whole = bars[2][0]
    assert bars == [[], [round(whole / 4)], [whole], [whole]]


def _list_stretches(text: Text, width: float = 0) -> list[tuple[str, int]]:
    found = re.findall(r"<w:rPr>(.*?)</w:rPr><w:t [^>]*>(\u00a0+)<", format_bar(text, width))
    return [((re.findall(r'w:fill="(\w+)"', properties) or [""])[0], len(blanks)) for properties, blanks in found]


def test_stretches_stand_where_they_are_on_the_axis() -> None:
    pieces = (WaterfallPiece("sampling", 0.25, 0.5), WaterfallPiece("response", 0.5, 1.0))
    (gap, wait, work) = _list_stretches(Text("", pieces=pieces))
    assert [colour for colour, _ in (gap, wait, work)] == ["", "9CC5DF", "1F6FB5"]
    assert abs(gap[1] - wait[1]) <= 1
    assert abs(work[1] - 2 * wait[1]) <= 1


def test_what_takes_hardly_any_time_is_seen() -> None:
    pieces = (WaterfallPiece("sampling", 0.0, 0.0001), WaterfallPiece("response", 0.0001, 0.0002))
    assert [size for _, size in _list_stretches(Text("", pieces=pieces))] == [1, 1]


def test_a_cut_piece_has_a_gap_and_an_unknown_one_is_hatched() -> None:
    (first, gap, second) = _list_stretches(Text("", pieces=(WaterfallPiece("sampling", 0.0, 0.5, is_cut=True),)))
    assert (first[0], gap, second[0]) == ("9CC5DF", ("", 1), "9CC5DF")
    assert "diagStripe" in format_bar(Text("", pieces=(WaterfallPiece("unknown", 0.0, 1.0),)), 0)


@pytest.mark.parametrize("width", [20.0, 60.0, 400.0])
def test_a_bar_is_never_longer_than_its_place(width: float) -> None:
    text = Text("", meter=Meter(1, "met"), pieces=(WaterfallPiece("link", 0.0, 0.5),))
    assert sum(size for _, size in _list_stretches(text, width)) * 0.226 * 5 <= width
