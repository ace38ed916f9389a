"""Tables as they were read, whatever file they stood in: cells with their places, rows, and what says nothing yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span

MAX_BYTES = 8 * 1024 * 1024
"""The most bytes that a table in plain text may have."""
MAX_CELLS = 300_000
"""The most non-empty cells that a table may have. 10,000 components with their connections have fewer."""
MAX_COLUMNS = 200
# Spreadsheets and web pages leave no-break, zero-width and byte order characters in cells.
_ODD_BLANKS = str.maketrans({"\xa0": " ", "\u202f": " ", "\u2009": " ", "\u200b": None, "\ufeff": None, "\xad": None})
_EMPTY_WORDS = frozenset(
    {"", "-", "--", "\u2013", "\u2014", "?", "n/a", "na", "tbd", "tbc", "tba", "todo", "...", "\u2026"}
    | {"n.a.", "n. a.", "k.a.", "k. a.", "n.v.", "n/d", "s/o", "à définir", "por definir"}
)
"""What a cell holds that says nothing yet."""


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell with content. `text` has no blanks around it; `is_number` where a workbook stores it as a number."""

    text: str
    span: Span
    is_number: bool = False

    @property
    def one_line(self) -> str:
        """The text on one line, with single blanks between its words."""
        return " ".join(self.text.split())

    def with_text(self, text: str) -> TableCell:
        """Return a part of the cell as a cell of its own, in the same place."""
        return replace(self, text=text)

    @property
    def quotation(self) -> str:
        """The beginning of the text as findings quote it."""
        text = self.one_line
        return text if len(text) <= 40 else f"{text[:39]}\u2026"  # noqa: PLR2004 - enough to recognise it


TableRow = Mapping[int, TableCell]
"""The cells of a row that have content, by column (from 0)."""


@dataclass(slots=True)
class TableSheet:
    """One table as it was read: a text file, a sheet of a workbook or a table of a document.

    `rows` has an empty row wherever rows are blank; `placeholders` are the cells that say nothing yet (`tbd`).
    """

    name: str
    rows: list[TableRow] = field(default_factory=list)
    placeholders: list[TableCell] = field(default_factory=list)
    count: int = 0

    def add_cell(
        self, row: dict[int, TableCell], column: int, text: str, span: Span, *, is_number: bool = False
    ) -> None:
        """Add a cell to a row, unless it is empty. Raise TableTooLargeError."""
        if not text:
            return
        self.count += 1
        if self.count > MAX_CELLS or column >= MAX_COLUMNS:
            raise TableTooLargeError(span, columns=column >= MAX_COLUMNS)
        cell = TableCell(text, span, is_number)
        if text.lower() in _EMPTY_WORDS:
            self.placeholders.append(cell)
        else:
            row[column] = cell


def clean_text(text: str) -> str:
    """Return a cell's content without odd blanks, and without blanks around it."""
    cleaned = text.translate(_ODD_BLANKS).strip()
    # The apostrophe keeps a spreadsheet from taking the text for a formula; `archgen list` writes it as well.
    return cleaned[1:].strip() if cleaned[:1] == "'" and cleaned[1:].lstrip()[:1] in {"=", "+", "-", "@"} else cleaned


class TableTooLargeError(Exception):
    """A table has more cells or columns than anybody can mean. `diagnostic` says which limit was exceeded."""

    def __init__(self, span: Span, *, columns: bool) -> None:
        super().__init__()
        limit = f"more than {MAX_COLUMNS} columns" if columns else f"more than {MAX_CELLS:,} cells"
        self.diagnostic = make_error("too-large", f"the table has {limit}", span, "take out what archgen need not know")


def make_error(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    """Return an error about a table as a whole: nothing is imported then."""
    return Diagnostic(rule, message, span, Severity.ERROR, help=help_line)


def make_warning(rule: str, message: str, span: Span, help_line: str) -> Diagnostic:
    """Return a warning about how a table could be read."""
    return Diagnostic(rule, message, span, Severity.WARNING, help=help_line)
