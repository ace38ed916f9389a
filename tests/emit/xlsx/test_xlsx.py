"""The workbook of all tables: text stays text, the bytes are the same each time, names are such as Excel allows."""

from __future__ import annotations

import io
import re
import sys
import zipfile

import pytest

from archgen.emit.own_file_marks import name_written_format
from archgen.emit.xlsx import XlsxWriterError, collect_sheets, write_workbook
from archgen.views.shapes import Column, Facts, Outline, Section, Table, Text


def _outline(*cells: str, anchor: str = "table:ports/a") -> Outline:
    columns = (Column("Port"), Column("Rate", 1, "right"))
    table = Table(anchor, "Ports", columns, tuple(((Text(cell),), (Text("10"),)) for cell in cells))
    return Outline("T", sections=(Section("s", "Arm", (Facts((("Owner", (Text("A"),)),)), table)),))


def test_tables_of_one_kind_share_a_sheet_and_name_their_section() -> None:
    one, two = _outline("x").sections[0], _outline("y", anchor="table:ports/b").sections[0]
    sheets = collect_sheets(Outline("T", sections=(one, two)))
    assert [sheet.title for sheet in sheets] == ["Facts", "Ports"]
    assert [row["Section"] for row in sheets[1].rows] == ["Arm", "Arm"]


def test_without_the_library_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xlsxwriter", None)
    with pytest.raises(XlsxWriterError, match=re.escape("pip install XlsxWriter")):
        write_workbook(_outline("x"))


def test_what_looks_as_a_formula_is_text() -> None:
    pytest.importorskip("xlsxwriter")
    cells = ("=1+1", "+1", "-1", "@SUM(A1)", '=HYPERLINK("https://example.org")', "https://example.org", "\x01")
    data = write_workbook(_outline(*cells))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        sheet = archive.read("xl/worksheets/sheet2.xml").decode()
        strings = archive.read("xl/sharedStrings.xml").decode()
        assert not [name for name in archive.namelist() if "rels" in name and b"hyperlink" in archive.read(name)]
    assert "<f>" not in sheet
    assert all(text in strings for text in ("=1+1", "@SUM(A1)", "https://example.org", "\ufffd"))
    assert sheet.count('t="s"') == 2 * len(cells) + 3  # a section and a port in each row, below three headings
    assert "<v>10</v>" in sheet


def test_the_same_tables_give_the_same_bytes_and_archgen_knows_them_again() -> None:
    pytest.importorskip("xlsxwriter")
    data = write_workbook(_outline("x"))
    assert data == write_workbook(_outline("x"))
    assert name_written_format(io.BytesIO(data)) == "workbook"
