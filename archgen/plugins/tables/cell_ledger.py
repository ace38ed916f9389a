"""What became of each cell of a table: taken for a key of an element, not taken with a reason, or left out on purpose.

A cell that nobody accounts for counts as not taken, and what is said to be taken is looked up in the data that are
written: a cell cannot get lost without a word.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from archgen.plugin.importing import Span, title_from_id
from archgen.plugins.tables.table_cells import TableCell

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
        cell_uses = self.uses.setdefault(cell.span, [])
        if use not in cell_uses:
            cell_uses.append(use)

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
