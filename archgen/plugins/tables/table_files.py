"""Read the tables of a file, whatever its form: text with separators, a workbook, a document.

Read tables in plain text (CSV): decode bytes as spreadsheets save them, split rows, undo quotes.
"""

from __future__ import annotations

import codecs
import contextlib
import re

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import SourceTexts, Span
from archgen.plugins.tables.table_cells import (
    MAX_BYTES,
    MAX_COLUMNS,
    HeadingMap,
    TableCell,
    TableSheet,
    TableTooLargeError,
    clean_text,
    make_error,
    make_warning,
    read_headings,
)

_ZIP_MAGIC, _COMPOUND_MAGIC = b"PK\x03\x04", b"\xd0\xcf\x11\xe0"


def read_sheets(
    name: str, data: bytes, heading_map: HeadingMap, diagnostics: list[Diagnostic], sources: SourceTexts
) -> list[TableSheet]:
    """Return the tables of a file; none where it cannot be read, which is reported."""
    try:
        if data.startswith(_ZIP_MAGIC):
            return _read_office_file(name, data, diagnostics)
        if data.startswith(_COMPOUND_MAGIC):
            message = "this is a workbook or document of the old form, or one with a password"
            help_line = "save it as .xlsx, .docx or `CSV UTF-8`, without a password"
            diagnostics.append(make_error("syntax-error", message, Span.of_file(name), help_line))
            return []
        text, text_diagnostics = decode_table(name, data)
        diagnostics.extend(text_diagnostics)
        sources.add_text(name, text)
        return [read_text_table(name, text, heading_map, diagnostics)] if text else []
    except TableTooLargeError as error:
        diagnostics.append(error.diagnostic)
        return []


def _read_office_file(name: str, data: bytes, diagnostics: list[Diagnostic]) -> list[TableSheet]:
    # Imported here: reading XML takes time to load, and most tables are plain text.
    from archgen.plugins.tables import word_tables, workbook_sheets
    from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError

    try:
        office_file = OfficeFile(data)
        if "word/document.xml" in office_file.names:
            return word_tables.read_word_tables(name, office_file)
        if "xl/workbook.xml" in office_file.names:
            return workbook_sheets.read_workbook(name, office_file, diagnostics)
        reason = "it holds neither a workbook (.xlsx) nor a document (.docx)"
    except UnreadableOfficeFileError as error:
        reason = str(error)
    message = f"this file cannot be read: {reason}"
    diagnostics.append(
        make_error("syntax-error", message, Span.of_file(name), "save it as .xlsx, .docx or `CSV UTF-8`")
    )
    return []


_BYTE_ORDER_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
# Possessive: where the quotation mark is never closed, matching fails without backtracking.
_QUOTED_PATTERN = re.compile(r'"(?:[^"]|"")*+"')


def decode_table(file: str, data: bytes) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return a table's text and diagnostics; the text is empty where the bytes cannot be a table."""
    file_span = Span.of_file(file)
    if len(data) > MAX_BYTES:
        message = f"the table is larger than {MAX_BYTES // 1024 // 1024} MiB"
        return "", (make_error("too-large", message, file_span, "split it; `--from` may be given several times"),)
    text, diagnostics = _decode_bytes(data, file_span)
    if "\0" in text:
        return "", (make_error("syntax-error", "the table holds NUL characters", file_span, "save it as `CSV UTF-8`"),)
    return text, diagnostics


def _decode_bytes(data: bytes, file_span: Span) -> tuple[str, tuple[Diagnostic, ...]]:
    """Decode by the byte order mark, else as UTF-8, else as Windows-1252."""
    for byte_order_mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(byte_order_mark):
            text = data[len(byte_order_mark) :].decode(encoding, "replace")
            return text, _report_replaced(text, encoding, file_span)
    try:
        return data.decode(), ()
    except UnicodeDecodeError:
        # Excel's plain `CSV` is saved in the code page of the machine, which in western Europe is this one.
        message = "the table is not UTF-8 and was read as Windows-1252"
        help_line = "look at the letters with accents; if they are wrong, save the table as `CSV UTF-8`"
        note = Diagnostic("syntax-error", message, file_span, Severity.NOTE, help=help_line)
        text = data.decode("cp1252", "replace")
        return text, (note, *_report_replaced(text, "Windows-1252", file_span))


def _report_replaced(text: str, encoding: str, file_span: Span) -> tuple[Diagnostic, ...]:
    """Report bytes that could not be decoded."""
    if "\ufffd" not in text:
        return ()
    message = f"some bytes are no {encoding}: \ufffd stands in their place"
    return (make_warning("syntax-error", message, file_span, "save the table as `CSV UTF-8`"),)


def read_text_table(file: str, text: str, heading_map: HeadingMap, diagnostics: list[Diagnostic]) -> TableSheet:
    """Read a table from its text. Raise TableTooLargeError."""
    declared_separator, text = _read_separator(text)
    separator = declared_separator or _guess_separator(file, text, heading_map)
    table = TableSheet(file)
    _add_rows(table, text, separator, diagnostics)
    return table


def _read_separator(text: str) -> tuple[str, str]:
    """Read the separator from Excel's first line `sep=;`. Return it (or an empty string) and the text with that line
    blanked.
    """
    match = re.match(r"sep=(.)(?=\r?\n)", text, re.IGNORECASE)
    # Blanked, not removed: lines and columns in messages must fit the file.
    return (match[1], " " * match.end() + text[match.end() :]) if match else ("", text)


def _guess_separator(file: str, text: str, heading_map: HeadingMap) -> str:
    """Guess the separator: the one with which most headings are recognised in the first rows, else the one with most
    cells.
    """
    # The first 50 rows decide, and they may be long: a cut keeps four trial parses cheap.
    beginning = text[:100_000]

    def weigh_mark(mark: str) -> tuple[int, int]:
        table = TableSheet(file)
        with contextlib.suppress(TableTooLargeError):
            _add_rows(table, beginning, mark, [], 50)
        headings = (read_headings(row, heading_map) for row in table.rows)
        return max((len(known.key_by_column) for known in headings if known), default=0), max(
            map(len, table.rows), default=0
        )

    return max(",;\t|", key=weigh_mark)


def _add_rows(
    table: TableSheet, text: str, separator: str, diagnostics: list[Diagnostic], max_rows: int | None = None
) -> None:
    """Split a text into a table's rows and cells. Raise TableTooLargeError."""
    # The module csv is not used since it does not tell where a cell begins.
    unquoted = re.compile(f"[^{re.escape(separator)}\\r\\n]*+")
    position, line, line_start, column = 0, 1, 0, 0
    row: dict[int, TableCell] = {}
    while position < len(text) and (max_rows is None or len(table.rows) < max_rows):
        span = Span(table.name, line, position - line_start + 1, line, position - line_start + 2)
        quoted = _match_quoted(text, position, span, diagnostics)
        tail = unquoted.match(text, position + len(quoted))
        cell_text = quoted + (tail[0] if tail else "")
        width = max(1, len(cell_text.split("\n", 1)[0].rstrip()))
        content = clean_text(quoted[1:-1].replace('""', '"') + cell_text[len(quoted) :])
        if column >= MAX_COLUMNS:
            raise TableTooLargeError(span, columns=True)
        table.add_cell(row, column, content, span._replace(end_column=span.column + width))
        if "\n" in cell_text:
            line, line_start = line + cell_text.count("\n"), position + cell_text.rindex("\n") + 1
        position += len(cell_text)
        if text[position : position + 1] == separator:
            position, column = position + 1, column + 1
            continue
        position += 2 if text.startswith("\r\n", position) else 1
        line, line_start, column = line + 1, position, 0
        table.rows.append(row)
        row = {}
    if row:
        table.rows.append(row)


def _match_quoted(text: str, position: int, span: Span, diagnostics: list[Diagnostic]) -> str:
    """Return the quoted part of a cell with its quotation marks; an empty string where there is none or it never
    closes.
    """
    if text[position] != '"':
        return ""
    quoted = _QUOTED_PATTERN.match(text, position)
    if quoted:
        return quoted[0]
    help_line = 'write `""` for a quotation mark in a text'
    diagnostics.append(make_warning("syntax-error", "this quotation mark is never closed", span, help_line))
    return ""
