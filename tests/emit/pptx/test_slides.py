"""Slides: every text in its place, nothing beyond the edge, the same bytes each time, text of strangers stays text."""

from __future__ import annotations

import io
import re
import sys
import zipfile

import pytest

from archgen.emit.office_package import STAMP
from archgen.emit.own_file_marks import name_written_format
from archgen.emit.picture import Picture
from archgen.emit.pptx import PythonPptxError, write_slides
from archgen.emit.pptx.slide_flow import BODY_BOTTOM, PlacedTable, PlacedText, flow_section
from archgen.views.shapes import Bullets, Column, Figure, Inlines, Outline, Paragraph, Section, Table, Text
from tests.emit.docx import sample

COLUMNS = (Column("Who", 1), Column("What", 3), Column("Used", 1))


def _table(rows: int, words: str = "gives skeletons") -> Table:
    cells = tuple(((Text(f"r{at}", strong=True),), (Text(words),), ()) for at in range(rows))
    return Table("table:t", "Rows", COLUMNS, cells)


def _outline(*sections: Section, title: str = "Lamp") -> Outline:
    return Outline(title, "Software architecture", (("Version", (Text("1"),)),), sections=sections)


def _read(data: bytes) -> list[str]:
    """Return the text of each slide, words of a run together."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        count = sum(bool(re.fullmatch(r"ppt/slides/slide\d+\.xml", name)) for name in archive.namelist())
        slides = [archive.read(f"ppt/slides/slide{at}.xml").decode() for at in range(1, count + 1)]
    return [" ".join(re.findall(r"<a:t>([^<]*)</a:t>", slide)) for slide in slides]


def test_without_the_library_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [each for each in sys.modules if each == "archgen.emit.pptx.slide_drawing" or each.startswith("pptx")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pptx", None)
    with pytest.raises(PythonPptxError, match=re.escape("pip install python-pptx")):
        write_slides(_outline(), {})


@pytest.mark.parametrize("words", ["short", "a long sentence that wraps " * 30, "x" * 5000, "", "漢字" * 900])
@pytest.mark.parametrize("rows", [1, 7, 90])
def test_a_long_table_goes_on_and_nothing_leaves_the_slide(words: str, rows: int) -> None:
    lead = Paragraph((Text(words),))
    for section in (
        Section("s", "All", (lead, _table(rows, words))),
        Section(
            "s",
            "Sides",
            (),
            (Section("l", "", (_table(rows, words),)), Section("r", "", (Bullets((lead.inlines,) * 40),))),
        ),
        Section("s", "Below", (_table(rows, words),), (Section("l", "", (lead,)), Section("r", "", (lead,)))),
    ):
        sheets = flow_section(section, {})
        shown = [
            row[0][0].text
            for sheet in sheets
            for each in sheet
            if isinstance(each, PlacedTable)
            for row in each.table.rows
        ]
        assert shown == [f"r{at}" for at in range(rows)]
        for each in (placed for sheet in sheets for placed in sheet):
            assert each.place.top + each.place.height <= BODY_BOTTOM + 1e-6


def test_a_few_rows_are_set_larger_than_many() -> None:
    def size(rows: int) -> float:
        (each, *_) = flow_section(Section("s", "All", (_table(rows),)), {})[0]
        assert isinstance(each, PlacedTable)
        return each.size

    assert size(3) > size(18) > size(200)


def test_texts_of_strangers_stay_texts() -> None:
    pytest.importorskip("pptx")
    evil: Inlines = (Text("=1+1 <a:t>&\x00\x0b\ud800\r\n" + "w" * 9000),)
    data = write_slides(
        _outline(Section("s", "T\x01<" * 300, (Paragraph(evil), _table(2, evil[0].text))), title="\x02" * 700), {}
    )
    texts = _read(data)
    assert len(texts) == 2
    assert "=1+1 &lt;a:t&gt;&amp;\ufffd" in texts[1]
    assert "…" in texts[1]


def test_the_same_outline_gives_the_same_bytes_with_pictures_that_are_described() -> None:
    pytest.importorskip("pptx")
    picture = sample.drawn("p", "digraph { a -> b }")
    figure = Figure("figure:p", "p", "A picture", "Two boxes & a line")
    missing = Figure("figure:q", "q", "Another", "Nobody drew it")
    outline = _outline(Section("s", "Pictures", (figure, missing)), Section("t", "Many rows", (_table(60),)))
    data = write_slides(outline, {"p": picture})
    assert data == write_slides(outline, {"p": picture})
    assert name_written_format(io.BytesIO(data)) == "presentation"
    texts = _read(data)
    assert "This picture could not be drawn. Nobody drew it" in texts[1]
    assert "Many rows   1 of" in texts[2]
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert b'descr="Two boxes &amp; a line"' in archive.read("ppt/slides/slide2.xml")
        assert archive.read("ppt/media/drawing1.svg") == picture.svg_outlines
        assert {info.date_time for info in archive.infolist()} == {STAMP}
        assert not [name for name in archive.namelist() if "thumbnail" in name]
        slide = archive.read("ppt/presentation.xml").decode()
    assert 'cx="12192000" cy="6858000"' in slide


def test_paragraphs_in_a_row_are_one_text_that_people_edit() -> None:
    lines = Section("s", "Lines", (Paragraph((Text("one"),)), Paragraph((Text("two"),)), _table(1)))
    text, table = flow_section(lines, {})[0]
    assert isinstance(text, PlacedText)
    assert [run.text for runs in text.paragraphs for run in runs] == ["one", "two"]
    assert table.place.top > text.place.top + 2 * text.size


def _widths(*cells: Inlines, titles: tuple[str, ...]) -> list[float]:
    """Return the widths of a table's columns, all of the same weight, in a row of so many cells."""
    columns = tuple(Column(title, 1) for title in titles)
    (table,) = flow_section(Section("s", "Places", (Table("table:t", "Places", columns, (cells,)),)), {})[0]
    assert isinstance(table, PlacedTable)
    return list(table.widths)


def test_columns_are_as_wide_as_what_stands_in_them() -> None:
    words, place = (Text("word " * 90),), "groups/communication_planner.yaml:102"
    narrow, wide, _ = _widths((Text("7"),), (Text(place, code=True),), words, titles=("No", "Where", "What"))
    assert narrow < 960 / 12
    assert wide > 0.54 * 16 * len(place) * 0.75, "a name is not broken in its middle"
    even = _widths((Text("7"),), (Text("8"),), titles=("No", "Where"))
    assert even[0] == even[1], "as given where all has room"
    bound, _, _ = _widths((Text("~46.4\u00a0ms"),), *(words for _ in range(2)), titles=("", "", "What"))
    assert bound > 14 + 16 * 3.9, "a blank that does not break keeps figure and unit together"
    headed, _ = _widths((Text("7"),), words, titles=("Responds, ms", "What"))
    assert headed > 65, "a heading is broken between its words"


def test_code_takes_more_room_than_text() -> None:
    text, code = (
        _widths((Text("a_long_name_of_one", code=is_code),), (Text("word " * 90),), titles=("Where", "What"))[0]
        for is_code in (False, True)
    )
    assert text < code


@pytest.mark.parametrize("rows", [12, 24, 40])
def test_type_is_as_large_as_it_can_be_on_as_many_slides_and_never_too_small_to_read(rows: int) -> None:
    sides = tuple(Section(name, "", (_table(rows),)) for name in ("l", "r"))
    for section in (Section("s", "All", (_table(rows),)), Section("s", "Both", (), sides)):
        placed = [each for sheet in flow_section(section, {}) for each in sheet if isinstance(each, PlacedTable)]
        assert min(each.size for each in placed) >= 11.5
        assert len({each.size for each in placed}) == 1, "both sides in one size"


def test_a_picture_beside_words_has_more_room_than_words_beside_words() -> None:
    words = Section("r", "", (Paragraph((Text("Met"),)),))
    picture = Section("l", "", (Figure("figure:p", "p", "A", "A"),))
    drawn = {"p": Picture("p", 452, 200, png=b"x")}
    (beside, *_) = flow_section(Section("s", "", (), (picture, words)), drawn)[0]
    (above, *_) = flow_section(Section("s", "", (_table(3),), (picture, words)), drawn)[0]
    assert beside.place.width > 1.2 * 452
    assert above.place.width < beside.place.width


@pytest.mark.parametrize(("width", "is_shown"), [(900.0, True), (1780.0, False)])
def test_a_picture_that_nobody_could_read_is_told(width: float, *, is_shown: bool) -> None:
    section = Section("s", "All", (Figure("figure:p", "p", "All", "Forty groups."),))
    (placed,) = flow_section(section, {"p": Picture("p", width, 400, png=b"x")})[0]
    assert isinstance(placed, PlacedText) != is_shown
    if isinstance(placed, PlacedText):
        (text,) = (run.text for run in placed.paragraphs[0])
        assert text == "This picture is too large for a slide; the site has it. Forty groups."
