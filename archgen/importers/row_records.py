"""Interpret rows by the meaning of their columns: what a row is about, and what merged cells leave out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from archgen.importers.column_headings import TableHeadings
from archgen.importers.imported_project import ImportedComponent, fold_name
from archgen.importers.table_cells import TableCell, TableRow

_KIND_SPELLINGS = {
    "component": ("component", "functional component", "module", "block", "function"),
    "connection": ("connection", "link", "flow", "edge", "data flow", "interface", "arrow"),
    "group": ("group", "functional group", "subsystem", "layer"),
    "node": ("node", "ros node"),
    "requirement": ("requirement", "req"),
    "type": ("type", "data type", "message"),
}
_KIND_BY_WORD = {fold_name(word): kind for kind, several in _KIND_SPELLINGS.items() for word in several}


@dataclass(slots=True)
class TableRecord:
    """A row by the meaning of its columns. `kind` comes from the row or is guessed; with `has_exact_ids`, ids are
    paths.
    """

    kind: str
    cells: dict[str, TableCell]
    units: Mapping[str, str]
    has_exact_ids: bool = False
    component: ImportedComponent | None = None

    def cell_below(self, key: str) -> TableCell | None:
        """Return the cell below a heading."""
        return self.cells.get(key)

    @property
    def first_cell(self) -> TableCell:
        """A cell to point at."""
        return next(iter(self.cells.values()))


def read_record(headings: TableHeadings, row: TableRow, cells_above: dict[str, Any]) -> TableRecord | None:
    """Read a row below headings; None where nothing in it can be imported.

    Merged cells leave all but the first empty: group, component and `from` are taken from above. `cells_above` is
    updated.
    """
    cells = {key: row[column] for column, key in sorted(headings.key_by_column.items()) if column in row}
    if not cells:
        return None
    kind = headings.kind or _KIND_BY_WORD.get(fold_name(cells["kind"].one_line) if "kind" in cells else "", "")
    if not headings.kind:
        _fill_merged(headings, cells, cells_above)
        kind = kind or _guess_kind(headings, cells)
    return TableRecord(kind, cells, headings.unit_by_key, bool(headings.kind)) if kind else None


def _fill_merged(headings: TableHeadings, cells: dict[str, TableCell], cells_above: dict[str, TableCell]) -> None:
    # Below another group the component above no longer applies.
    """Fill the cells that merged cells left empty."""
    if "group" in cells and cells_above.get("group") != cells["group"]:
        for key in ("component", "from"):
            cells_above.pop(key, None)
    for key in ("group", "from_group", "component", "from"):
        if key in cells:
            cells_above[key] = cells[key]
        elif key in cells_above and key in headings and _continues_above(key, cells):
            cells[key] = cells_above[key]


def _continues_above(key: str, cells: Mapping[str, TableCell]) -> bool:
    """Return whether a row without this cell continues the one above."""
    if key == "group":
        return "component" in cells or "input" in cells or "output" in cells or "title" in cells
    if key == "component":
        return bool({"input", "output", "from", "to"} & set(cells)) and "title" not in cells and "id" not in cells
    return "to" in cells


def _guess_kind(headings: TableHeadings, cells: Mapping[str, TableCell]) -> str:
    """Guess what a row is about from the cells that it has; empty where that is not clear."""
    # The order matters: a row that connects may name a component, a group and a type as well.
    if "from" in cells or "to" in cells:
        return "connection"
    if "component" in cells:
        return "component"
    if "node" in cells:
        return "node"
    if "group" in cells and not {"from", "to"} <= set(headings.key_by_column.values()):
        return "group"
    if "type" in cells and "message" in cells:
        return "type"
    return "requirement" if "requirement" in cells and ({"title", "description"} & set(cells)) else ""
