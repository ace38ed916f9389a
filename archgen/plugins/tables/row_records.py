"""Interpret rows by the meaning of their columns: what a row is about, and what merged cells leave out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugins.tables.column_headings import KEY_BY_HEADING, TableHeadings, fold_heading
from archgen.plugins.tables.imported_project import ImportedComponent, ImportedProject
from archgen.plugins.tables.table_cells import TableCell, TableRow

_KIND_SPELLINGS = {
    "connection": "connection; signal; signal flow; link; flow; edge; data flow; interface; arrow; Verbindung; Verknüpfung; Datenfluss; liaison; lien; "
    "connexion; flux; conexión; enlace; flujo",
    "component": "function; Funktion; fonction; función",
}
_KIND_BY_WORD = {fold_heading(word): kind for kind, words in _KIND_SPELLINGS.items() for word in words.split(";")}
_ROW_KINDS = ("component", "group", "node", "requirement", "type", "message")
"""The meanings of columns that also say what a row is: a row `Komponente` is a component."""


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
    output_id: str = ""
    """The output of the component that a connection is about."""
    is_lost: bool = False
    """Whether the row as a whole could not be imported, which was reported."""
    output_ids: list[str] = field(default_factory=list)
    """The outputs that the row of a component lists."""

    def cell_below(self, key: str) -> TableCell | None:
        """Return the cell below a heading."""
        return self.cells.get(key)

    @property
    def first_cell(self) -> TableCell:
        """A cell to point at."""
        return next(iter(self.cells.values()))


def read_record(
    project: ImportedProject, headings: TableHeadings, row: TableRow, cells_above: dict[str, Any]
) -> TableRecord | None:
    """Read a row below headings; None where nothing in it can be imported.

    Merged cells leave all but the first empty: group, component and `from` are taken from above. `cells_above` is
    updated.
    """
    cells = {key: row[column] for column, key in sorted(headings.key_by_column.items()) if column in row}
    if not cells:
        return None
    kind = headings.kind or (_read_kind(project, cells["kind"]) if "kind" in cells else "")
    if not headings.kind:
        _fill_merged(headings, cells, cells_above)
        kind = kind or _guess_kind(headings, cells)
    return TableRecord(kind, cells, headings.unit_by_key, bool(headings.kind)) if kind else None


def _read_kind(project: ImportedProject, cell: TableCell) -> str:
    """Return what a cell says that its row is; empty where it says nothing that is known, which is reported."""
    key = KEY_BY_HEADING.get(fold_heading(cell.one_line), "")
    kind = _KIND_BY_WORD.get(fold_heading(cell.one_line)) or (key if key in _ROW_KINDS else "")
    if kind:
        project.ledger.take_cell(cell, "kind", ("groups",))
        return "type" if kind == "message" else kind
    message = f"`{cell.quotation}` is no kind of row and was not taken"
    help_line = "write component, connection, group, node, requirement or type; or map the column to what it means"
    project.reject_cell("wrong-value", message, cell, help_line)
    return ""


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
