"""Import what rows say about groups, components and requirements themselves."""

from __future__ import annotations

import re

from archgen.importers import values
from archgen.importers.cells import Cell
from archgen.importers.draft import UNSORTED, Component, Draft
from archgen.importers.rows import Record

_ROLES = {"source": "source", "sensor": "source", "filter": "filter", "processing": "filter", "sink": "sink"} | {
    "actuator": "sink",
    "reactive": "reactive",
    "service": "reactive",
}


def declare(draft: Draft, row: Record) -> None:
    """Import what a row says about groups, components or requirements; report a row that names none."""
    at = row.first.at
    # Formulas go first: every later step then sees an empty cell in their place.
    for key in list(row.cells):
        if values.formula(draft, row.cells[key]):
            del row.cells[key]
    if row.kind == "group" and row.get("group"):
        _group(draft, row)
    elif row.kind == "requirement" and row.get("requirement"):
        _requirement(draft, row)
    elif row.kind in {"component", "connection"} and row.get("component"):
        _component(draft, row)
    elif row.kind in {"component", "group", "requirement"}:
        draft.say(
            "missing-key",
            f"this row names no {row.kind} and was not taken",
            at,
            "fill in its name, or take the row out",
        )


def _group(draft: Draft, row: Record) -> None:
    cell = row.cells["group"]
    group = draft.group(cell.line, cell.at)
    title, owner, text = (
        row.get("title") or row.get("component"),
        row.get("owner"),
        row.get("description") or row.get("functionality"),
    )
    if title:
        group.name = title.line
    if owner:
        group.keys["owner"] = _owner(draft, owner)
    if text:
        group.keys["description"] = _prose(text)


def _requirement(draft: Draft, row: Record) -> None:
    cell, text = row.cells["requirement"], row.get("title") or row.get("description") or row.get("functionality")
    for name in values.requirements(draft, cell):
        if name in draft.requirements and text:
            draft.requirements[name] = text.line


def _component(draft: Draft, row: Record) -> None:
    cell = row.cells["component"]
    outer, name = row.get("group"), cell.line
    if row.exact:
        above, _, name = name.rpartition(".")
        group = draft.group(above, cell.at)
    elif outer:
        group = draft.group(outer.line, outer.at)
    else:
        known = draft.named(name)
        group = draft.groups[known[0].group] if len(known) == 1 else draft.group(UNSORTED, cell.at)
    wanted = row.get("id")
    row.component = component = draft.component(group, name, cell.at, wanted.line if wanted else "")
    title = row.get("title")
    if title:
        component.name = title.line
    if row.kind == "component":
        for key in ("functionality", "description"):
            _keep(draft, component, key, _prose(row.get(key)), row.get(key))
    _keep(draft, component, "owner", _owner(draft, row.get("owner")), row.get("owner"))
    _role(draft, component, row.get("role"))
    asked = row.get("requirement")
    if asked:
        component.requirements += [r for r in values.requirements(draft, asked) if r not in component.requirements]
    rate = row.get("rate") or row.get("period")
    if rate and row.kind == "component":
        unit = row.units.get("rate" if row.get("rate") else "period", "Hz" if row.get("rate") else "ms")
        _keep(draft, component, "timing", values.timing(draft, rate, unit), rate)


def _prose(cell: Cell | None) -> str | None:
    """Return a text of several lines without blanks at the ends of its lines."""
    return "\n".join(line.rstrip() for line in cell.text.splitlines()) if cell else None


def _keep(draft: Draft, component: Component, key: str, found: object, cell: Cell | None) -> None:
    """Set a key; a different value from an earlier row stays."""
    if found is None or cell is None:
        return
    if component.keys.setdefault(key, found) != found:
        message = f"another row says something else on {key} of `{component.name}`: this was not taken"
        draft.say("conflicting-values", message, cell.at, "say it once")


def _role(draft: Draft, component: Component, cell: Cell | None) -> None:
    if cell is None:
        return
    role = _ROLES.get(cell.line.casefold())
    if role:
        _keep(draft, component, "role", role, cell)
    else:
        draft.say(
            "wrong-value",
            f"`{cell.line}` is no role and was not taken",
            cell.at,
            "write source, filter, sink or reactive",
        )


def _owner(draft: Draft, cell: Cell | None) -> str | tuple[str, ...] | None:
    """Read one partner or several."""
    if cell is None:
        return None
    names = [name.strip() for name in re.split(r"[,;/&+\n]| and ", cell.text) if name.strip()]
    found = tuple(dict.fromkeys(draft.partner(name) for name in names))
    return found[0] if len(found) == 1 else found or None
