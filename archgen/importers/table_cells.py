"""Read the cells of a table with their spans: decode bytes as spreadsheets save them, split rows, undo quotes."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span

MAX_BYTES = 8 * 1024 * 1024
MAX_CELLS = 300_000
"""The most non-empty cells that a table may have. 10,000 components with their connections have fewer."""
MAX_COLUMNS = 200
_BYTE_ORDER_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
_WORKBOOK_MAGIC = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
# Possessive: where the quotation mark is never closed, matching fails without backtracking.
_QUOTED_PATTERN = re.compile(r'"(?:[^"]|"")*+"')
# Spreadsheets and web pages leave no-break, zero-width and byte order characters in cells.
_ODD_BLANKS = str.maketrans({"\xa0": " ", "\u202f": " ", "\u200b": None, "\ufeff": None})
_EMPTY_WORDS = frozenset(
    {"", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "tbd", "tbc", "tba", "todo", "...", "\u2026"}
)
"""What a cell holds that says nothing yet."""


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell with content. `text` has no blanks around it."""

    text: str
    span: Span

    @property
    def one_line(self) -> str:
        """The text on one line, with single blanks between its words."""
        return " ".join(self.text.split())


TableRow = Mapping[int, TableCell]
"""The cells of a row that have content, by column (from 0)."""


def decode_table(file: str, data: bytes) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return a table's text and diagnostics; the text is empty where the bytes cannot be a table."""
    file_span = Span.of_file(file)
    if len(data) > MAX_BYTES:
        message = f"the table is larger than {MAX_BYTES // 1024 // 1024} MiB"
        return "", (_make_error("too-large", message, file_span, "split it; `--from` may be given several times"),)
    # The first bytes of .xlsx (a zip file) and of .xls (a compound file).
    if data.startswith(_WORKBOOK_MAGIC):
        return "", (
            _make_error("syntax-error", "this is a workbook, not a CSV file", file_span, "save it as `CSV UTF-8`"),
        )
    text, diagnostics = _decode_bytes(data, file_span)
    if "\0" in text:
        return "", (_make_error("syntax-error", "the table holds NUL characters", file_span, "save it as `CSV UTF-8`"),)
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
    return (Diagnostic("syntax-error", message, file_span, Severity.WARNING, help="save the table as `CSV UTF-8`"),)


def read_separator(text: str) -> tuple[str, str]:
    """Read the separator from Excel's first line `sep=;`. Return it (or an empty string) and the text with that line
    blanked.
    """
    match = re.match(r"sep=(.)(?=\r?\n)", text, re.IGNORECASE)
    # Blanked, not removed: lines and columns in messages must fit the file.
    return (match[1], " " * match.end() + text[match.end() :]) if match else ("", text)


def read_rows(file: str, text: str, separator: str, diagnostics: list[Diagnostic]) -> Iterator[TableRow]:
    """Yield the rows that have content. Raise TableTooLargeError."""
    # The module csv is not used since it does not tell where a cell begins.
    unquoted = re.compile(f"[^{re.escape(separator)}\\r\\n]*+")
    position, line, line_start, column, count = 0, 1, 0, 0, 0
    row: dict[int, TableCell] = {}
    while position < len(text):
        span = Span(file, line, position - line_start + 1, line, position - line_start + 2)
        quoted = _match_quoted(text, position, span, diagnostics)
        tail = unquoted.match(text, position + len(quoted))
        cell_text = quoted + (tail[0] if tail else "")
        content = _clean_cell(quoted[1:-1].replace('""', '"') + cell_text[len(quoted) :])
        if content:
            count += 1
            width = max(1, len(cell_text.split("\n", 1)[0].rstrip()))
            row[column] = TableCell(content, span._replace(end_column=span.column + width))
        if count > MAX_CELLS or column >= MAX_COLUMNS:
            raise TableTooLargeError(span, columns=column >= MAX_COLUMNS)
        if "\n" in cell_text:
            line, line_start = line + cell_text.count("\n"), position + cell_text.rindex("\n") + 1
        position += len(cell_text)
        if text[position : position + 1] == separator:
            position, column = position + 1, column + 1
            continue
        position += 2 if text.startswith("\r\n", position) else 1
        line, line_start, column = line + 1, position, 0
        if row:
            yield row
        row = {}
    if row:
        yield row


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
    diagnostics.append(_make_warning("syntax-error", "this quotation mark is never closed", span, help_line))
    return ""


def _clean_cell(text: str) -> str:
    """Return a cell's content without blanks around it, empty where it says nothing yet."""
    cleaned = text.translate(_ODD_BLANKS).strip()
    # The apostrophe keeps a spreadsheet from taking the text for a formula; `archgen list` writes it as well.
    if cleaned[:1] == "'" and cleaned[1:].lstrip()[:1] in {"=", "+", "-", "@"}:
        cleaned = cleaned[1:].strip()
    return "" if cleaned.lower() in _EMPTY_WORDS else cleaned


class TableTooLargeError(Exception):
    """A table has more cells or columns than anybody can mean. `diagnostic` says which limit was exceeded."""

    def __init__(self, span: Span, *, columns: bool) -> None:
        super().__init__()
        limit = f"more than {MAX_COLUMNS} columns" if columns else f"more than {MAX_CELLS:,} cells"
        self.diagnostic = _make_error(
            "too-large", f"the table has {limit}", span, "take out what archgen need not know"
        )


def _make_error(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    return Diagnostic(rule, message, span, Severity.ERROR, help=help_line)


def _make_warning(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    return Diagnostic(rule, message, span, Severity.WARNING, help=help_line)
