"""Read the tables of a Word document (.docx): merged cells, several paragraphs in a cell, without deleted text.

Open workbooks and documents of Office Open XML: zip files whose parts are XML, read within limits.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from posixpath import dirname, join, normpath

from lxml import etree

from archgen.plugin.importing import ARCHIVE_DAMAGE, MAX_OFFICE_BYTES, Span
from archgen.plugins.tables.table_cells import TableCell, TableSheet, clean_text

# What zipfile and its methods of compression raise for bytes that are not what they should be.
_DAMAGE = (*ARCHIVE_DAMAGE, OSError)
_RELATION = "{http://schemas.openxmlformats.org/package/2006/relationships}Relationship"


class UnreadableOfficeFileError(Exception):
    """The bytes are no workbook or document that can be read. The text says why."""


class OfficeFile:
    """The parts of one file, by their names in it."""

    def __init__(self, data: bytes) -> None:
        """Open the file. Raise UnreadableOfficeFileError."""
        if len(data) > MAX_OFFICE_BYTES:
            msg = f"it is larger than {MAX_OFFICE_BYTES // 1024 // 1024} MiB"
            raise UnreadableOfficeFileError(msg)
        try:
            self._archive = zipfile.ZipFile(io.BytesIO(data))
        except _DAMAGE as error:
            msg = f"the file is damaged ({error})"
            raise UnreadableOfficeFileError(msg) from None
        # Together: many sheets, each within its limit, would take as long as one that is too large.
        self._bytes_left = 2 * MAX_OFFICE_BYTES
        self.names = frozenset(self._archive.namelist())

    def read_part(self, name: str) -> etree._Element | None:
        """Return the root of a part; None where there is no such part. Raise UnreadableOfficeFileError."""
        if name not in self.names:
            return None
        try:
            limit = min(MAX_OFFICE_BYTES, self._bytes_left)
            with self._archive.open(name) as stream:
                # One byte more, so that a part that is too large is seen; what its head says of its size may be a lie.
                content = stream.read(limit + 1)
            self._bytes_left -= len(content)
            if len(content) > limit:
                msg = f"its part {name} is too large: at most {MAX_OFFICE_BYTES // 1024 // 1024} MiB of a part are read"
                raise UnreadableOfficeFileError(msg)
            parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
            return etree.fromstring(content, parser)
        except (etree.XMLSyntaxError, *_DAMAGE) as error:
            msg = f"its part {name} cannot be read ({error})"
            raise UnreadableOfficeFileError(msg) from None

    def targets_of(self, name: str) -> dict[str, str]:
        """Return the names of the parts that a part refers to, by the id of the reference."""
        folder = dirname(name)
        relations = self.read_part(join(folder, "_rels", f"{name.rpartition('/')[2]}.rels"))
        if relations is None:
            return {}
        return {
            relation.get("Id", ""): normpath(join("/" + folder, relation.get("Target", ""))).lstrip("/")
            for relation in relations.iter(_RELATION)
            if relation.get("TargetMode") != "External"
        }


_WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
_LINE_BREAKS = {f"{_WORD}br": "\n", f"{_WORD}cr": "\n", f"{_WORD}tab": " ", f"{_WORD}noBreakHyphen": "-"}


def read_word_tables(file: str, document: OfficeFile) -> list[TableSheet]:
    """Read all tables in their order; one inside a cell is a part of its text. Raise UnreadableOfficeFileError."""
    root = document.read_part("word/document.xml")
    if root is None or root.tag != f"{_WORD}document":
        msg = "it is no .docx"
        raise UnreadableOfficeFileError(msg)
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
