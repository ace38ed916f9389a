"""Sheets of a workbook: each cell's XML beside what is read of it."""

from __future__ import annotations

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError
from archgen.plugins.tables.workbook_sheets import CellFormats, read_workbook
from tests.workbooks import make_workbook, zip_parts

STRINGS = "<si><t>Group</t></si><si><r><t>Com</t></r><r><t>ponent</t></r><rPh><t>x</t></rPh></si>"
STYLES = (
    '<numFmts><numFmt numFmtId="164" formatCode="0&quot; Hz&quot;"/></numFmts>'
    '<cellXfs><xf numFmtId="0"/><xf numFmtId="9"/><xf numFmtId="14"/><xf numFmtId="164"/></cellXfs>'
)


def _read(data: bytes) -> tuple[list[list[str]], list[str]]:
    diagnostics: list[Diagnostic] = []
    (sheet,) = read_workbook("t.xlsx", OfficeFile(data), diagnostics)
    rows = [[f"{cell.span.file.rpartition(' ')[2]} {cell.text}" for cell in row.values()] for row in sheet.rows]
    return rows, [f"{d.span.file}: {d.message}" for d in diagnostics]


@pytest.mark.parametrize(
    ("cell", "text"),
    [
        ('<c r="B3" t="s"><v>1</v></c>', "B3 Component"),
        ('<c r="B3" t="inlineStr"><is><t>in</t></is></c>', "B3 in"),
        ('<c r="B3"><v>12.5</v></c>', "B3 12.5"),
        ('<c r="B3"><v>0.30000000000000004</v></c>', "B3 0.3"),
        ('<c r="B3" s="1"><v>0.95</v></c>', "B3 95 %"),
        ('<c r="B3" s="2"><v>46098</v></c>', "B3 2026-03-17"),
        ('<c r="B3" s="3"><v>30</v></c>', "B3 30 Hz"),
        ('<c r="B3"><f>A1+1</f><v>31</v></c>', "B3 31"),
        ('<c r="B3" t="str"><f>A1</f><v>text</v></c>', "B3 text"),
        ('<c r="B3"><f>A1+1</f><v></v></c>', "B3 =A1+1"),
        ('<c r="B3" t="e"><v>#REF!</v></c>', "B3 #REF!"),
        ('<c r="B3" t="b"><v>1</v></c>', "B3 true"),
        ('<c t="s"><v>0</v></c>', "A3 Group"),
    ],
)
def test_a_cell_has_the_text_that_is_shown(cell: str, text: str) -> None:
    sheet = f'<sheetData><row r="3">{cell}</row></sheetData>'
    assert _read(make_workbook({"S": sheet}, STRINGS, STYLES)) == ([[], [text]], [])


def test_a_merged_cell_stands_in_each_row_below_and_not_beside() -> None:
    sheet = (
        '<sheetData><row r="1"><c r="A1"><v>7</v></c><c r="C1"><v>1</v></c></row><row r="2"><c r="C2"><v>2</v></c></row></sheetData>'
        '<mergeCells><mergeCell ref="A1:B2"/></mergeCells>'
    )
    assert _read(make_workbook({"S": sheet})) == ([["A1 7", "C1 1"], ["C2 2", "A1 7"]], [])


def test_what_is_hidden_is_read_and_told() -> None:
    sheet = (
        '<cols><col min="2" max="3" hidden="1"/></cols><sheetData><row r="1"><c r="B1"><v>1</v></c></row>'
        '<row r="2" hidden="1"><c r="A2"><v>2</v></c></row></sheetData>'
    )
    rows, messages = _read(make_workbook({"S": sheet}, states={"S": 'state="hidden"'}))
    assert rows == [["B1 1"], ["A2 2"]]
    assert messages == [
        "t.xlsx [S]: this sheet is hidden, and read like the others",
        "t.xlsx [S]: row 2 is hidden (perhaps by a filter), and read like the others",
        "t.xlsx [S]: column B is hidden, and read like the others",
    ]


@pytest.mark.parametrize(
    ("number", "code", "text"),
    [
        ("0.5", "hh:mm", "12:00"),
        ("46098.75", "yyyy\\-mm\\-dd hh:mm", "2026-03-17 18:00"),
        ("5", '0 "days"', "5 days"),
        ("5", '"at most "0', "at most 5"),
        ("1234.5", "#,##0.00\\ [$€-407]", "1234.5 €"),
        ("5", "[Red]0.0", "5"),
        ("-1", "dd.mm.yyyy", "1899-12-29"),
        ("1e300", "dd.mm.yyyy", "1e300"),
        ("x", "0", "x"),
    ],
)
def test_a_number_is_shown_as_its_format_says(number: str, code: str, text: str) -> None:
    assert CellFormats({"1": code}).format_number(number, "1") == text


@pytest.mark.parametrize(
    ("parts", "reason"),
    [
        ({"xl/workbook.xml": "<workbook"}, "its part xl/workbook.xml cannot be read"),
        ({"xl/workbook.xml": "<workbook/>"}, "it is no .xlsx"),
        ({}, "it is no .xlsx"),
        (
            {"xl/workbook.xml": '<workbook xmlns="http://purl.oclc.org/ooxml/spreadsheetml/main"/>'},
            "it is of the form `Strict Open XML`",
        ),
    ],
)
def test_what_is_no_workbook_says_why(parts: dict[str, str], reason: str) -> None:
    with pytest.raises(UnreadableOfficeFileError, match=reason):
        read_workbook("t.xlsx", OfficeFile(zip_parts(parts)), [])
