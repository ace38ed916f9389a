"""Read the tables of a Word document (.docx): merged cells, several paragraphs in a cell, without deleted text."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from archgen.plugin.importing import Span
from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError
from archgen.plugins.tables.table_cells import TableCell, TableSheet, clean_text

_WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
_LINE_BREAKS = {f"{_WORD}br": "\n", f"{_WORD}cr": "\n", f"{_WORD}tab": " ", f"{_WORD}noBreakHyphen": "-"}


def read_word_tables(file: str, document: OfficeFile) -> list[TableSheet]:
    """Read all tables in their order; one inside a cell is a part of its text. Raise UnreadableOfficeFileError."""
    root = document.read_part("word/document.xml")
    if root is None or root.tag != f"{_WORD}document":
        raise UnreadableOfficeFileError("it is no .docx")
    outer_tables = [
        table for table in root.iter(f"{_WORD}tbl") if next(table.iterancestors(f"{_WORD}tbl"), None) is None
    ]
    return [_read_table(f"{file} [table {number}]", table) for number, table in enumerate(outer_tables, 1)]


def _read_table(name: str, table: etree._Element) -> TableSheet:
    sheet = TableSheet(name)
    cells_above: dict[int, TableCell] = {}
    for number, row_element in enumerate(_own_parts(table, "tr"), 1):
        row: dict[int, TableCell] = {}
        column = _read_number(row_element.find(f"{_WORD}trPr/{_WORD}gridBefore"))
        for cell in _own_parts(row_element, "tc"):
            properties = cell.find(f"{_WORD}tcPr")
            merge = None if properties is None else properties.find(f"{_WORD}vMerge")
            if merge is not None and merge.get(f"{_WORD}val", "continue") == "continue":
                if column in cells_above:
                    row[column] = cells_above[column]
            else:
                place = Span.of_file(f"{name} row {number}, column {column + 1}")
                sheet.add_cell(row, column, clean_text(_text_of(cell)), place)
            span = None if properties is None else properties.find(f"{_WORD}gridSpan")
            column += _read_number(span) or 1
        cells_above = row
        sheet.rows.append(row)
    return sheet


def _own_parts(element: etree._Element, name: str) -> Iterator[etree._Element]:
    """Yield the rows of a table or the cells of a row, not those of tables inside."""
    for child in element:
        if child.tag == f"{_WORD}{name}":
            yield child
        # Content controls and marks of insertion stand between a table and its rows.
        elif child.tag in {f"{_WORD}sdt", f"{_WORD}sdtContent", f"{_WORD}customXml", f"{_WORD}ins"}:
            yield from _own_parts(child, name)


def _read_number(element: etree._Element | None) -> int:
    text = "" if element is None else element.get(f"{_WORD}val", "")
    return min(int(text), 1000) if text.isdecimal() and len(text) < 9 else 0  # noqa: PLR2004 - hostile numbers are long


def _text_of(cell: etree._Element) -> str:
    """Return a cell's text, a line for each paragraph."""
    return "\n".join("".join(_paragraph_texts(paragraph)) for paragraph in cell.iter(f"{_WORD}p"))


def _paragraph_texts(paragraph: etree._Element) -> Iterator[str]:
    for element in paragraph.iter(f"{_WORD}t", *_LINE_BREAKS):
        if element.tag in _LINE_BREAKS:
            # A tab stop's definition has the same name as a tab in the text.
            if next(element.iterancestors()).tag == f"{_WORD}r":
                yield _LINE_BREAKS[element.tag]
        # Text that was moved away stands here as well as in its new place.
        elif (
            next(element.iterancestors(f"{_WORD}p"), None) is paragraph
            and next(element.iterancestors(f"{_WORD}moveFrom"), None) is None
        ):
            yield element.text or ""
