"""The meaning of a table's column headings, in the spellings that teams use."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from archgen.importers.table_cells import TableCell, TableRow

_HEADING_SPELLINGS = {
    "kind": "kind; row; row type; record; element; element type; entry",
    "group": "group; functional group; subsystem; sub system; group name; group id; area; layer; system; module group",
    "component": "component; components; component name; functional component; software component; module; block; function name; "
    "functional block",
    "id": "id; identifier; component id; key; short name",
    "title": "title; name; label; display name; full name",
    "functionality": "functionality; purpose; function; what it does; task; does",
    "description": "description; comment; comments; notes; note; remarks; remark; details; summary",
    "owner": "owner; partner; responsible; responsible partner; organisation; organization; lead; company; team; owned by",
    "role": "role",
    "input": "input; inputs; in; input port; input ports; to input; to port; target port; target input; consumes; needs; input name; "
    "requires; destination port; inputs from",
    "output": "output; outputs; out; output port; output ports; from output; from port; source port; source output; provides; produces; "
    "gives; output name; outputs to",
    "from": "from; source; from component; source component; sender; producer; publisher; writer; provider; origin; src; publisher "
    "component; input from",
    "to": "to; target; to component; target component; destination; destination component; receiver; consumer; subscriber; reader; "
    "sink; dst; dest; subscriber component; output to",
    "from_group": "from group; source group; producer group; source subsystem; from subsystem",
    "to_group": "to group; target group; destination group; consumer group; target subsystem; to subsystem",
    "type": "type; data; data type; datatype; conceptual type; content; signal; payload; information; what; data item; flow",
    "message": "message; ros message; msg; message type; msg type; ros type; interface; ros msg; ros interface; ros message type",
    "node": "node; ros node; node name; nodes; ros nodes",
    "package": "package; ros package; pkg",
    "topic": "topic; ros topic; topic name",
    "rate": "rate; frequency; freq; hz; update rate; publish rate; rate hz; frequency hz",
    "period": "period; cycle; cycle time; period ms; cycle time ms",
    "requirement": "requirement; requirements; req; reqs; requirement id; requirement ids; req id",
    "status": "status; node status",
}
KEY_BY_HEADING = {
    spelling.strip(): key for key, several in _HEADING_SPELLINGS.items() for spelling in several.split(";")
}
"""The key by folded heading."""
_ANCHOR_KEYS = frozenset({"component", "title", "id", "from", "to", "node", "group", "input", "output"})
"""A row of headings has one of these: without them nothing can be imported."""
_UNIT_PATTERN = re.compile(r"[(\[]\s*([A-Za-z/]+)\s*[)\]]\s*\Z")
_DETAIL_PATTERN = re.compile(r"[(\[].*\Z")

LIST_TABLES: Mapping[tuple[str, ...], tuple[str, Mapping[str, str]]] = {
    ("id", "title", "owner", "role", "inputs", "outputs", "nodes", "place"): (
        "component",
        {"id": "component", "title": "title", "owner": "owner", "role": "role"},
    ),
    ("id", "title", "owner", "components", "place"): ("group", {"id": "group", "title": "title", "owner": "owner"}),
    ("input", "from", "kind", "types", "messages", "edges", "from_owner", "to_owner", "place"): (
        "connection",
        {"input": "to", "from": "from", "types": "type"},
    ),
    ("output", "input", "type", "message", "place"): (
        "connection",
        {"output": "from", "input": "to", "type": "type", "message": "message"},
    ),
    ("id", "implements", "owner", "package", "status", "host", "ros_name", "place"): (
        "node",
        {"id": "node", "implements": "component", "package": "package", "status": "status", "place": "place"},
    ),
    ("id", "title", "use_cases", "served_by", "place"): ("requirement", {"id": "requirement", "title": "title"}),
    ("type", "message", "size", "remarks"): ("type", {"type": "type", "message": "message"}),
}
"""The tables that `archgen list` writes: what a row is, and what its columns mean. The other columns can be derived."""


@dataclass(frozen=True, slots=True)
class TableHeadings:
    """A row of headings.

    `key_by_column` are the meanings, `unit_by_key` the units in brackets. `kind` is set where `archgen list` wrote the
    table: its ids are complete paths.
    """

    key_by_column: Mapping[int, str]
    unit_by_key: Mapping[str, str]
    unknown_columns: Mapping[int, TableCell]
    kind: str = ""

    def __contains__(self, key: object) -> bool:
        return key in self.key_by_column.values()


def read_headings(row: TableRow) -> TableHeadings | None:
    """Read a row as headings; None where it is not one."""
    list_table = LIST_TABLES.get(tuple(cell.text for _, cell in sorted(row.items()))) if 0 in row else None
    if list_table:
        kind, meanings = list_table
        return TableHeadings(
            {index: meanings[heading.text] for index, heading in row.items() if heading.text in meanings}, {}, {}, kind
        )
    keys = {column: meaning for column, cell in row.items() if (meaning := _key_of_heading(cell))}
    # The first of two columns with one meaning counts; the second is reported as unknown.
    keys = {
        column: key
        for column, key in keys.items()
        if key not in [earlier_key for heading, earlier_key in keys.items() if heading < column]
    }
    # At least half of the cells must be headings: a row of data may hold a word like `input` or `output` by chance.
    if len(keys) < 2 or not _ANCHOR_KEYS & set(keys.values()) or 2 * len(keys) < len(row):  # noqa: PLR2004 - two make a table
        return None
    units = {
        keys[column]: unit_match[1]
        for column, cell in row.items()
        if column in keys and (unit_match := _match_unit(cell))
    }
    return TableHeadings(
        _choose_component_column(keys), units, {column: cell for column, cell in row.items() if column not in keys}
    )


def read_new_headings(row: TableRow) -> TableHeadings | None:
    """Read a row below other headings as new headings: every cell of it must be a known heading."""
    new_headings = read_headings(row)
    return new_headings if new_headings and (new_headings.kind or not new_headings.unknown_columns) else None


def _key_of_heading(cell: TableCell) -> str | None:
    """Return the key that a heading means, with or without what it has in brackets."""
    folded = _fold_heading(cell.one_line)
    return KEY_BY_HEADING.get(folded) or KEY_BY_HEADING.get(_fold_heading(_DETAIL_PATTERN.sub("", cell.one_line)))


def _fold_heading(text: str) -> str:
    """Fold a heading's case, punctuation and camel case into lower-case words."""
    return " ".join(re.findall(r"[a-z0-9]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).casefold()))


def _match_unit(cell: TableCell) -> re.Match[str] | None:
    return _UNIT_PATTERN.search(cell.one_line)


def _choose_component_column(keys: Mapping[int, str]) -> dict[int, str]:
    """Choose what names a component where no column is called so: a name, a title or an id."""
    present_keys = set(keys.values())
    # In a table of components a column `Description` usually says what each of them does.
    if "functionality" not in present_keys and not {"from", "to"} <= present_keys:
        keys = {column: "functionality" if key == "description" else key for column, key in keys.items()}
    if "component" in present_keys or {"from", "to"} <= present_keys:
        return dict(keys)
    name = next((key for key in ("title", "id", "output", "input") if key in present_keys), "")
    if name in {"title", "id"} and "node" not in present_keys:
        return {column: "component" if key == name else key for column, key in keys.items()}
    return dict(keys)
