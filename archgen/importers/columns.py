"""The meaning of a table's column headings, in the spellings that teams use."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from archgen.importers.cells import Cell, Row

_SPELLINGS = {
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
MEANING = {spelling.strip(): key for key, several in _SPELLINGS.items() for spelling in several.split(";")}
"""The key by folded heading."""
_ANCHORS = frozenset({"component", "title", "id", "from", "to", "node", "group", "input", "output"})
"""A row of headings has one of these: without them nothing can be imported."""
_UNIT = re.compile(r"[(\[]\s*([A-Za-z/]+)\s*[)\]]\s*\Z")
_DETAIL = re.compile(r"[(\[].*\Z")

LISTED: Mapping[tuple[str, ...], tuple[str, Mapping[str, str]]] = {
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
class Headings:
    """A row of headings.

    `key_by_column` are the meanings, `unit_by_key` the units in brackets. `kind` is set where `archgen list` wrote the
    table: its ids are complete paths.
    """

    keys: Mapping[int, str]
    units: Mapping[str, str]
    unknown: Mapping[int, Cell]
    kind: str = ""

    def __contains__(self, key: object) -> bool:
        return key in self.keys.values()


def headings(row: Row) -> Headings | None:
    """Read a row as headings; None where it is not one."""
    listed = LISTED.get(tuple(cell.text for _, cell in sorted(row.items()))) if 0 in row else None
    if listed:
        kind, meanings = listed
        return Headings({n: meanings[c.text] for n, c in row.items() if c.text in meanings}, {}, {}, kind)
    keys = {column: meaning for column, cell in row.items() if (meaning := _meaning(cell))}
    # The first of two columns with one meaning counts; the second is reported as unknown.
    keys = {column: key for column, key in keys.items() if key not in [k for c, k in keys.items() if c < column]}
    # At least half of the cells must be headings: a row of data may hold a word like `input` or `output` by chance.
    if len(keys) < 2 or not _ANCHORS & set(keys.values()) or 2 * len(keys) < len(row):  # noqa: PLR2004 - two make a table
        return None
    units = {keys[column]: found[1] for column, cell in row.items() if column in keys and (found := _unit(cell))}
    return Headings(_sorted_out(keys), units, {column: cell for column, cell in row.items() if column not in keys})


def again(row: Row) -> Headings | None:
    """Read a row below other headings as new headings: every cell of it must be a known heading."""
    found = headings(row)
    return found if found and (found.kind or not found.unknown) else None


def _meaning(cell: Cell) -> str | None:
    """Return the key that a heading means, with or without what it has in brackets."""
    folded = _folded(cell.line)
    return MEANING.get(folded) or MEANING.get(_folded(_DETAIL.sub("", cell.line)))


def _folded(text: str) -> str:
    """Fold a heading's case, punctuation and camel case into lower-case words."""
    return " ".join(re.findall(r"[a-z0-9]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).casefold()))


def _unit(cell: Cell) -> re.Match[str] | None:
    return _UNIT.search(cell.line)


def _sorted_out(keys: Mapping[int, str]) -> dict[int, str]:
    """Choose what names a component where no column is called so: a name, a title or an id."""
    held = set(keys.values())
    # In a table of components a column `Description` usually says what each of them does.
    if "functionality" not in held and not {"from", "to"} <= held:
        keys = {column: "functionality" if key == "description" else key for column, key in keys.items()}
    if "component" in held or {"from", "to"} <= held:
        return dict(keys)
    name = next((key for key in ("title", "id", "output", "input") if key in held), "")
    if name in {"title", "id"} and "node" not in held:
        return {column: "component" if key == name else key for column, key in keys.items()}
    return dict(keys)
