"""Interpret rows by the meaning of their columns: what a row is about, and what merged cells leave out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from archgen.importers.cells import Cell, Row
from archgen.importers.columns import Headings
from archgen.importers.draft import Component, fold

_KINDS = {
    "component": ("component", "functional component", "module", "block", "function"),
    "connection": ("connection", "link", "flow", "edge", "data flow", "interface", "arrow"),
    "group": ("group", "functional group", "subsystem", "layer"),
    "node": ("node", "ros node"),
    "requirement": ("requirement", "req"),
    "type": ("type", "data type", "message"),
}
_KIND = {fold(word): kind for kind, several in _KINDS.items() for word in several}


@dataclass(slots=True)
class Record:
    """A row by the meaning of its columns. `kind` comes from the row or is guessed; with `has_exact_ids`, ids are
    paths.
    """

    kind: str
    cells: dict[str, Cell]
    units: Mapping[str, str]
    exact: bool = False
    component: Component | None = None

    def get(self, key: str) -> Cell | None:
        """Return the cell below a heading."""
        return self.cells.get(key)

    @property
    def first(self) -> Cell:
        """A cell to point at."""
        return next(iter(self.cells.values()))


def record(heads: Headings, row: Row, above: dict[str, Any]) -> Record | None:
    """Read a row below headings; None where nothing in it can be imported.

    Merged cells leave all but the first empty: group, component and `from` are taken from above. `cells_above` is
    updated.
    """
    found = {key: row[column] for column, key in sorted(heads.keys.items()) if column in row}
    if not found:
        return None
    kind = heads.kind or _KIND.get(fold(found["kind"].line) if "kind" in found else "", "")
    if not heads.kind:
        _fill(heads, found, above)
        kind = kind or _guess(heads, found)
    return Record(kind, found, heads.units, bool(heads.kind)) if kind else None


def _fill(heads: Headings, found: dict[str, Cell], above: dict[str, Cell]) -> None:
    # Below another group the component above no longer applies.
    """Fill the cells that merged cells left empty."""
    if "group" in found and above.get("group") != found["group"]:
        for key in ("component", "from"):
            above.pop(key, None)
    for key in ("group", "from_group", "component", "from"):
        if key in found:
            above[key] = found[key]
        elif key in above and key in heads and _goes_on(key, found):
            found[key] = above[key]


def _goes_on(key: str, found: Mapping[str, Cell]) -> bool:
    """Return whether a row without this cell continues the one above."""
    if key == "group":
        return "component" in found or "input" in found or "output" in found or "title" in found
    if key == "component":
        return bool({"input", "output", "from", "to"} & set(found)) and "title" not in found and "id" not in found
    return "to" in found


def _guess(heads: Headings, found: Mapping[str, Cell]) -> str:
    """Guess what a row is about from the cells that it has; empty where that is not clear."""
    # The order matters: a row that connects may name a component, a group and a type as well.
    if "from" in found or "to" in found:
        return "connection"
    if "component" in found:
        return "component"
    if "node" in found:
        return "node"
    if "group" in found and not {"from", "to"} <= set(heads.keys.values()):
        return "group"
    if "type" in found and "message" in found:
        return "type"
    return "requirement" if "requirement" in found and ({"title", "description"} & set(found)) else ""
