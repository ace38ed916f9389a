"""Tables as they were read, whatever file they stood in: cells with their places, rows, and what says nothing yet.

What became of each cell of a table: taken for a key of an element, not taken with a reason, or left out on purpose.

A cell that nobody accounts for counts as not taken, and what is said to be taken is looked up in the data that are
written: a cell cannot get lost without a word.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import Span, title_from_id

MAX_BYTES = 8 * 1024 * 1024
"""The most bytes that a table in plain text may have."""
MAX_CELLS = 100_000
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


ElementPath = tuple[str, ...]
"""Where an element stands in the data: `("groups", "sensing", "components", "camera")`."""


class CellUse(NamedTuple):
    """What a cell was taken for: a key of an element, and the words that the element must then have."""

    key: str
    element: ElementPath
    words: str


@dataclass(slots=True)
class CellLedger:
    """The accounts of all cells, by the cells' places."""

    cells: dict[Span, TableCell] = field(default_factory=dict)
    key_by_cell: dict[Span, str] = field(default_factory=dict)
    """The meaning of the column in which a cell stands."""
    _known_uses: set[tuple[Span, CellUse]] = field(default_factory=set)
    uses: dict[Span, list[CellUse]] = field(default_factory=dict)
    reasons: dict[Span, str] = field(default_factory=dict)
    """Why cells, or parts of them, were not taken."""
    listed: dict[Span, str] = field(default_factory=dict)
    """The reasons for cells that have no finding of their own: the summary lists these cells."""
    omissions: dict[Span, str] = field(default_factory=dict)
    """Why cells were left out on purpose."""

    def add_cell(self, cell: TableCell, key: str = "") -> None:
        """Open the account of a cell."""
        self.cells.setdefault(cell.span, cell)
        if key:
            self.key_by_cell.setdefault(cell.span, key)

    def take_cell(self, cell: TableCell, key: str, element: ElementPath, words: str = "") -> None:
        """Note that a cell was taken, and which words the element must have because of it."""
        use = CellUse(key, element, words)
        if (cell.span, use) not in self._known_uses:
            self._known_uses.add((cell.span, use))
            self.uses.setdefault(cell.span, []).append(use)

    def reject_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell, or a part of it, was not taken."""
        self.reasons.setdefault(cell.span, reason)

    def list_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell was not taken where a finding about its row, column or table says so already."""
        self.add_cell(cell)
        if cell.span not in self.reasons:
            self.reasons[cell.span] = self.listed[cell.span] = reason

    def omit_cell(self, cell: TableCell, reason: str) -> None:
        """Note that a cell was left out on purpose: it says nothing, or what follows from the rest."""
        self.add_cell(cell)
        self.omissions.setdefault(cell.span, reason)

    def has_account(self, cell: TableCell) -> bool:
        """Return whether something is noted about a cell."""
        return cell.span in self.uses or cell.span in self.reasons or cell.span in self.omissions

    def list_element(self, element: ElementPath, reason: str) -> None:
        """Note that all cells of an element were not taken, since it is not written."""
        for span, cell_uses in self.uses.items():
            if any(use.element == element for use in cell_uses) and span in self.cells:
                self.list_cell(self.cells[span], reason)

    def prove_uses(self, sections: Mapping[str, Any]) -> Iterator[tuple[TableCell, CellUse | None]]:
        """Drop what the data do not have. Yield the cells that this concerns, and those without an account (None)."""
        words_by_element: dict[ElementPath, frozenset[str]] = {}
        for span, cell in self.cells.items():
            proved_uses: list[CellUse] = []
            lost_use = None
            for use in self.uses.pop(span, ()):
                if use.element not in words_by_element:
                    words_by_element[use.element] = frozenset(_list_words(_look_up(sections, use.element)))
                present_words = words_by_element[use.element]
                if present_words and (not use.words or use.words in present_words):
                    proved_uses.append(use)
                else:
                    lost_use = lost_use or use
            if proved_uses:
                self.uses[span] = proved_uses
            if span not in self.reasons and span not in self.omissions and (lost_use or not proved_uses):
                yield cell, lost_use


def _look_up(sections: Mapping[str, Any], element: ElementPath) -> Any:  # noqa: ANN401 - any value of the language
    """Return an element with its id; None where it is not in the data."""
    value: Any = sections
    for name in element:
        if not isinstance(value, Mapping) or name not in value:
            return None
        value = value[name]
    # A title that follows from the id is not written.
    follows = {} if isinstance(value, Mapping) and "title" in value else {title_from_id(element[-1]): None}
    return {**follows, element[-1]: value}


def _list_words(value: Any) -> Iterator[str]:  # noqa: ANN401 - as above
    """Yield all keys and texts of a value; of a reference also each of its ids."""
    if isinstance(value, Mapping):
        for key, inner_value in value.items():
            yield str(key)
            yield from _list_words(inner_value)
    elif isinstance(value, str):
        yield value
        if "." in value and " " not in value:
            yield from value.split(".")
    elif isinstance(value, list | tuple):
        for inner_value in value:
            yield from _list_words(inner_value)
