"""Read the sheets of a workbook (.xlsx): values as they are shown, merged cells, and what is hidden.

Why openpyxl does not: docs/decisions/0018-workbooks.md.

Numbers of a workbook as their formats show them: percentages, dates, and units that only the format has.
"""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from lxml import etree

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span
from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError
from archgen.plugins.tables.table_cells import MAX_CELLS, TableCell, TableSheet, clean_text

_PERCENT_IDS, _DATE_IDS = (
    frozenset({9, 10}),
    frozenset({*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)}),
)
"""The formats that every workbook knows without writing them down."""
_LITERAL_PATTERN = re.compile(r'"([^"]*)"|\\(.)')
# A format is of 255 characters at most.
_CURRENCY_PATTERN = re.compile(r"\[\$([^\]-]{0,255}+)[^\]]{0,255}+\]")
_CONDITION_PATTERN = re.compile(r"\[[^\]]{0,255}+\]")
_DATE_LETTERS = re.compile(r"[ymdhs]", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class CellFormats:
    """The number formats of a workbook: their codes by the cells' style, and the day on which it begins to count."""

    code_by_style: Mapping[str, str]
    begins_1904: bool = False

    @classmethod
    def read_styles(cls, styles: etree._Element | None, *, begins_1904: bool) -> CellFormats:
        """Read the part with the styles."""
        if styles is None:
            return cls({}, begins_1904)
        written = {
            element.get("numFmtId", ""): element.get("formatCode", "") for element in styles.iter(f"{_MAIN}numFmt")
        }
        used = styles.find(f"{_MAIN}cellXfs")
        style_formats = [] if used is None else [element.get("numFmtId", "0") for element in used.iter(f"{_MAIN}xf")]
        codes = {str(style): written.get(name) or _shipped_code(name) for style, name in enumerate(style_formats)}
        return cls(codes, begins_1904)

    def format_number(self, value: str, style: str) -> str:
        """Return a number as its format shows it, but with all its digits and a decimal point."""
        try:
            number = float(value)
        except ValueError:
            return value
        code = self.code_by_style.get(style, "").split(";")[0]
        # Shown text is taken out first: the letters of `0 "days"` make no date.
        plain_code = _LITERAL_PATTERN.sub("", _CONDITION_PATTERN.sub("", code))
        if _DATE_LETTERS.search(plain_code) and not re.search(r"[0#]", plain_code.replace(".0", "")):
            return _format_date(number, begins_1904=self.begins_1904) or value
        # 15 digits are what a workbook stores faithfully: 0.1 + 0.2 is shown as 0.3.
        if "%" in plain_code:
            return f"{number * 100:.15g} %"
        before, after = _read_literals(code)
        return f"{before}{number:.15g}{after}"


def _shipped_code(name: str) -> str:
    number = int(name) if name.isdecimal() and len(name) < 5 else 0  # noqa: PLR2004 - there are fewer than 200
    return "0%" if number in _PERCENT_IDS else "yyyy-mm-dd" if number in _DATE_IDS else ""


def _read_literals(code: str) -> tuple[str, str]:
    """Return the text that a format shows before and behind the digits: ` Hz` of `0" Hz"`."""
    visible_code = _CONDITION_PATTERN.sub("", _CURRENCY_PATTERN.sub(r'"\1"', code))
    hidden_literals = _LITERAL_PATTERN.sub(lambda match: " " * len(match[0]), visible_code)
    digits = [match.start() for match in re.finditer(r"[0#?]", hidden_literals)]
    if not digits:
        return "", ""
    return _show_literals(visible_code[: digits[0]]), _show_literals(visible_code[digits[-1] + 1 :])


def _show_literals(code: str) -> str:
    """Return what a piece of a format shows: quoted and escaped text, without room and filling."""
    return re.sub(r'"([^"]*)"|\\(.)|[_*].|([,.])', lambda match: match[1] or match[2] or "", code)


def _format_date(number: float, *, begins_1904: bool) -> str:
    """Return a date, a time of day, or both; empty where the number is none."""
    # Excel counts a 29 February 1900 that never was: from March 1900 on, days count from 30 December 1899.
    first_day = dt.datetime(1904, 1, 1) if begins_1904 else dt.datetime(1899, 12, 30)  # noqa: DTZ001 - no time zone
    try:
        moment = first_day + dt.timedelta(seconds=round(number * 86400))
    except (OverflowError, ValueError):
        return ""
    if 0 <= number < 1:
        return f"{moment:%H:%M:%S}".removesuffix(":00")
    return f"{moment:%Y-%m-%d}" if number == int(number) else f"{moment:%Y-%m-%d %H:%M}"


_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_STRICT_MAIN = "http://purl.oclc.org/ooxml/spreadsheetml/main"
_REFERENCE = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"
_WORKBOOK = "xl/workbook.xml"
_ADDRESS_PATTERN = re.compile(r"([A-Z]{1,3})([0-9]{1,7})\Z")


def read_workbook(file: str, workbook: OfficeFile, diagnostics: list[Diagnostic]) -> list[TableSheet]:
    """Read all sheets, hidden ones too, in their order. Raise UnreadableOfficeFileError and TableTooLargeError."""
    root = workbook.read_part(_WORKBOOK)
    if root is None or root.tag != f"{_MAIN}workbook":
        kind = "of the form `Strict Open XML`" if root is not None and _STRICT_MAIN in str(root.tag) else "no .xlsx"
        raise UnreadableOfficeFileError(f"it is {kind}")
    properties = root.find(f"{_MAIN}workbookPr")
    begins_1904 = properties is not None and properties.get("date1904") in {"1", "true"}
    formats = CellFormats.read_styles(workbook.read_part("xl/styles.xml"), begins_1904=begins_1904)
    strings = _read_strings(workbook)
    part_by_id = workbook.targets_of(_WORKBOOK)
    sheets = []
    for entry in root.iter(f"{_MAIN}sheet"):
        part = workbook.read_part(part_by_id.get(entry.get(_REFERENCE, ""), ""))
        # A sheet may also be a chart, which has no cells.
        if part is not None and part.tag == f"{_MAIN}worksheet":
            name = f"{file} [{entry.get('name', '')}]"
            if entry.get("state", "visible") != "visible":
                _add_note(diagnostics, "this sheet is hidden, and read like the others", name)
            sheets.append(_SheetReader(name, strings, formats, diagnostics).read_sheet(part))
    if any(re.match(r"xl/(?:threadedC|c)omments", part_name) for part_name in workbook.names):
        _add_note(diagnostics, "cells of the workbook have comments, which are not read", file)
    return sheets


def _add_note(diagnostics: list[Diagnostic], message: str, place: str) -> None:
    help_line = "if that is not what you want, change the workbook and import it again"
    diagnostics.append(Diagnostic("wrong-value", message, Span.of_file(place), Severity.NOTE, help=help_line))


def _read_strings(workbook: OfficeFile) -> list[str]:
    root = workbook.read_part("xl/sharedStrings.xml")
    return [] if root is None else [clean_text(_text_of(item)) for item in root.iter(f"{_MAIN}si")]


def _text_of(item: etree._Element) -> str:
    """Return the text of a string: of all its runs, without the phonetic hints of Japanese."""
    texts = (text for text in item.iter(f"{_MAIN}t") if next(text.iterancestors(f"{_MAIN}rPh"), None) is None)
    return "".join(text.text or "" for text in texts).replace("_x000D_", "")


class _SheetReader:
    """Reads one sheet: `sheet` grows row by row."""

    def __init__(self, name: str, strings: list[str], formats: CellFormats, diagnostics: list[Diagnostic]) -> None:
        self.sheet = TableSheet(name)
        self._strings, self._formats, self._diagnostics = strings, formats, diagnostics
        self._cells: dict[tuple[int, int], TableCell] = {}

    def read_sheet(self, root: etree._Element) -> TableSheet:
        """Return the sheet's cells; a cell merged over several rows stands in each of them."""
        covered = self._find_covered(root)
        last_row = 0
        hidden_rows: list[str] = []
        for number, row_element in self._number_rows(root):
            row: dict[int, TableCell] = {}
            for column, cell in self._number_cells(row_element):
                place = f"{self.sheet.name} {_column_letters(column)}{number}"
                is_number = cell.get("t", "n") == "n"
                self.sheet.add_cell(row, column, self._read_value(cell), Span.of_file(place), is_number=is_number)
            for column in covered.get(number, {}):
                if column not in row and covered[number][column] in self._cells:
                    row[column] = self._cells[covered[number][column]]
            self._cells |= {(number, column): cell for column, cell in row.items()}
            if row and row_element.get("hidden") in {"1", "true"}:
                hidden_rows.append(str(number))
            if row and number > last_row + 1:
                self.sheet.rows.append({})
            if row:
                self.sheet.rows.append(row)
                last_row = number
        if hidden_rows:
            rows = f"row {hidden_rows[0]} is" if len(hidden_rows) == 1 else f"rows {', '.join(hidden_rows)} are"
            message = f"{rows} hidden (perhaps by a filter), and read like the others"
            _add_note(self._diagnostics, message, self.sheet.name)
        self._report_hidden_columns(root)
        return self.sheet

    def _number_rows(self, root: etree._Element) -> Iterator[tuple[int, etree._Element]]:
        number = 0
        for row in root.iter(f"{_MAIN}row"):
            number = _read_number(row.get("r", "")) or number + 1
            yield number, row

    def _number_cells(self, row: etree._Element) -> Iterator[tuple[int, etree._Element]]:
        column = -1
        for cell in row.iter(f"{_MAIN}c"):
            address = _split_address(cell.get("r", ""))
            column = address[1] if address else column + 1
            yield column, cell

    def _read_value(self, cell: etree._Element) -> str:
        """Return a cell's value as it is shown; of a formula the value that was stored with it."""
        kind, value = cell.get("t", "n"), cell.findtext(f"{_MAIN}v")
        formula = cell.find(f"{_MAIN}f")
        if kind == "inlineStr":
            return clean_text(_text_of(cell))
        # Programs that do not calculate write an empty value.
        if not value:
            return clean_text(f"={formula.text or ''}") if formula is not None else ""
        if kind == "s":
            is_index = value.strip().isdecimal() and len(value) < 9  # noqa: PLR2004 - more strings than cells
            return self._strings[int(value)] if is_index and int(value) < len(self._strings) else ""
        if kind == "b":
            return "true" if value == "1" else "false"
        return clean_text(self._formats.format_number(value, cell.get("s", "0")) if kind == "n" else value)

    def _find_covered(self, root: etree._Element) -> Mapping[int, Mapping[int, tuple[int, int]]]:
        """Return which cells below the first one of a merged range show it, by row and column."""
        # Only downwards: across, one heading or banner would become the value of every column.
        covered: dict[int, dict[int, tuple[int, int]]] = {}
        room = MAX_CELLS
        for merged in root.iter(f"{_MAIN}mergeCell"):
            first, _, last = merged.get("ref", "").partition(":")
            begin, end = _split_address(first), _split_address(last)
            if begin and end:
                # A hostile range may name all rows, and there may be many: no more than can have cells are covered.
                last_row = min(end[0], begin[0] + room)
                room -= max(0, last_row - begin[0])
                for number in range(begin[0] + 1, last_row + 1):
                    covered.setdefault(number, {})[begin[1]] = begin
        return covered

    def _report_hidden_columns(self, root: etree._Element) -> None:
        filled = {column for row in self.sheet.rows for column in row}
        hidden = [column for column in root.iter(f"{_MAIN}col") if column.get("hidden") in {"1", "true"}]
        for element in hidden:
            first, last = _read_number(element.get("min", "")) - 1, _read_number(element.get("max", "")) - 1
            for column in sorted(column for column in filled if first <= column <= last):
                message = f"column {_column_letters(column)} is hidden, and read like the others"
                _add_note(self._diagnostics, message, self.sheet.name)


def _read_number(text: str) -> int:
    """Return the number of a row or column; 0 where there is none."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 8 else 0  # noqa: PLR2004 - 1,048,576 rows


def _split_address(address: str) -> tuple[int, int] | None:
    """Return row (from 1) and column (from 0) of an address such as B7."""
    match = _ADDRESS_PATTERN.match(address)
    if not match:
        return None
    column = 0
    for letter in match[1]:
        column = column * 26 + ord(letter) - ord("A") + 1
    return int(match[2]), column - 1


def _column_letters(column: int) -> str:
    """Return the letters of a column (from 0): A, B, ..., Z, AA."""
    letters = ""
    number = column + 1
    while number:
        number, rest = divmod(number - 1, 26)
        letters = chr(ord("A") + rest) + letters
    return letters
