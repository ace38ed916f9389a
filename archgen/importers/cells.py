"""Read the cells of a table with their spans: decode bytes as spreadsheets save them, split rows, undo quotes."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from archgen.diagnostic import Diagnostic, Severity
from archgen.source import Span

MAX_BYTES = 8 * 1024 * 1024
MAX_CELLS = 300_000
"""The most non-empty cells that a table may have. 10,000 components with their connections have fewer."""
MAX_COLUMNS = 200
_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
_WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
# Possessive: where the quotation mark is never closed, matching fails without backtracking.
_QUOTED = re.compile(r'"(?:[^"]|"")*+"')
# Spreadsheets and web pages leave no-break, zero-width and byte order characters in cells.
_ODD_BLANKS = str.maketrans({"\xa0": " ", "\u202f": " ", "\u200b": None, "\ufeff": None})
_NOTHING = frozenset(
    {"", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "tbd", "tbc", "tba", "todo", "...", "\u2026"}
)
"""What a cell holds that says nothing yet."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell with content. `text` has no blanks around it."""

    text: str
    at: Span

    @property
    def line(self) -> str:
        """The text on one line, with single blanks between its words."""
        return " ".join(self.text.split())


Row = Mapping[int, Cell]
"""The cells of a row that have content, by column (from 0)."""


def decode(file: str, data: bytes) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return a table's text and diagnostics; the text is empty where the bytes cannot be a table."""
    whole = Span.of_file(file)
    if len(data) > MAX_BYTES:
        message = f"the table is larger than {MAX_BYTES // 1024 // 1024} MiB"
        return "", (_error("too-large", message, whole, "split it; `--from` may be given several times"),)
    # The first bytes of .xlsx (a zip file) and of .xls (a compound file).
    if data.startswith(_WORKBOOKS):
        return "", (_error("syntax-error", "this is a workbook, not a CSV file", whole, "save it as `CSV UTF-8`"),)
    text, found = _decoded(data, whole)
    if "\0" in text:
        return "", (_error("syntax-error", "the table holds NUL characters", whole, "save it as `CSV UTF-8`"),)
    return text, found


def _decoded(data: bytes, whole: Span) -> tuple[str, tuple[Diagnostic, ...]]:
    """Decode by the byte order mark, else as UTF-8, else as Windows-1252."""
    for mark, name in _MARKS:
        if data.startswith(mark):
            text = data[len(mark) :].decode(name, "replace")
            return text, _replaced(text, name, whole)
    try:
        return data.decode(), ()
    except UnicodeDecodeError:
        # Excel's plain `CSV` is saved in the code page of the machine, which in western Europe is this one.
        message = "the table is not UTF-8 and was read as Windows-1252"
        help_line = "look at the letters with accents; if they are wrong, save the table as `CSV UTF-8`"
        note = Diagnostic("syntax-error", message, whole, Severity.NOTE, help=help_line)
        text = data.decode("cp1252", "replace")
        return text, (note, *_replaced(text, "Windows-1252", whole))


def _replaced(text: str, name: str, whole: Span) -> tuple[Diagnostic, ...]:
    """Report bytes that could not be decoded."""
    if "\ufffd" not in text:
        return ()
    message = f"some bytes are no {name}: \ufffd stands in their place"
    return (Diagnostic("syntax-error", message, whole, Severity.WARNING, help="save the table as `CSV UTF-8`"),)


def separator(text: str) -> tuple[str, str]:
    """Read the separator from Excel's first line `sep=;`. Return it (or an empty string) and the text with that line
    blanked.
    """
    found = re.match(r"sep=(.)(?=\r?\n)", text, re.IGNORECASE)
    # Blanked, not removed: lines and columns in messages must fit the file.
    return (found[1], " " * found.end() + text[found.end() :]) if found else ("", text)


def rows(file: str, text: str, mark: str, found: list[Diagnostic]) -> Iterator[Row]:
    """Yield the rows that have content. Raise TableTooLargeError."""
    # The module csv is not used since it does not tell where a cell begins.
    unquoted = re.compile(f"[^{re.escape(mark)}\\r\\n]*+")
    place, line, begun, column, count = 0, 1, 0, 0, 0
    row: dict[int, Cell] = {}
    while place < len(text):
        at = Span(file, line, place - begun + 1, line, place - begun + 2)
        quoted = _quoted(text, place, at, found)
        tail = unquoted.match(text, place + len(quoted))
        written = quoted + (tail[0] if tail else "")
        said = _said(quoted[1:-1].replace('""', '"') + written[len(quoted) :])
        if said:
            count += 1
            width = max(1, len(written.split("\n", 1)[0].rstrip()))
            row[column] = Cell(said, at._replace(end_column=at.column + width))
        if count > MAX_CELLS or column >= MAX_COLUMNS:
            raise TooLargeError(at, columns=column >= MAX_COLUMNS)
        if "\n" in written:
            line, begun = line + written.count("\n"), place + written.rindex("\n") + 1
        place += len(written)
        if text[place : place + 1] == mark:
            place, column = place + 1, column + 1
            continue
        place += 2 if text.startswith("\r\n", place) else 1
        line, begun, column = line + 1, place, 0
        if row:
            yield row
        row = {}
    if row:
        yield row


def _quoted(text: str, place: int, at: Span, found: list[Diagnostic]) -> str:
    """Return the quoted part of a cell with its quotation marks; an empty string where there is none or it never
    closes.
    """
    if text[place] != '"':
        return ""
    quoted = _QUOTED.match(text, place)
    if quoted:
        return quoted[0]
    help_line = 'write `""` for a quotation mark in a text'
    found.append(_warning("syntax-error", "this quotation mark is never closed", at, help_line))
    return ""


def _said(text: str) -> str:
    """Return a cell's content without blanks around it, empty where it says nothing yet."""
    found = text.translate(_ODD_BLANKS).strip()
    # The apostrophe keeps a spreadsheet from taking the text for a formula; `archgen list` writes it as well.
    if found[:1] == "'" and found[1:].lstrip()[:1] in {"=", "+", "-", "@"}:
        found = found[1:].strip()
    return "" if found.lower() in _NOTHING else found


class TooLargeError(Exception):
    """A table has more cells or columns than anybody can mean. `diagnostic` says which limit was exceeded."""

    def __init__(self, at: Span, *, columns: bool) -> None:
        super().__init__()
        what = f"more than {MAX_COLUMNS} columns" if columns else f"more than {MAX_CELLS:,} cells"
        self.diagnostic = _error("too-large", f"the table has {what}", at, "take out what archgen need not know")


def _error(rule: str, message: str, at: Span, help_line: str) -> Diagnostic:
    return Diagnostic(rule, message, at, Severity.ERROR, help=help_line)


def _warning(rule: str, message: str, at: Span, help_line: str) -> Diagnostic:
    return Diagnostic(rule, message, at, Severity.WARNING, help=help_line)
