"""Import what rows say about groups, components and requirements themselves."""

from __future__ import annotations

import re

from archgen.importers import cell_values
from archgen.importers.imported_project import UNSORTED, ImportedComponent, ImportedProject
from archgen.importers.row_records import TableRecord
from archgen.importers.table_cells import TableCell

_ROLE_WORDS = {"source": "source", "sensor": "source", "filter": "filter", "processing": "filter", "sink": "sink"} | {
    "actuator": "sink",
    "reactive": "reactive",
    "service": "reactive",
}


def import_declaration(project: ImportedProject, row: TableRecord) -> None:
    """Import what a row says about groups, components or requirements; report a row that names none."""
    span = row.first_cell.span
    # Formulas go first: every later step then sees an empty cell in their place.
    for key in list(row.cells):
        if cell_values.reject_formula(project, row.cells[key]):
            del row.cells[key]
    if row.kind == "group" and row.cell_below("group"):
        _import_group(project, row)
    elif row.kind == "requirement" and row.cell_below("requirement"):
        _import_requirement(project, row)
    elif row.kind in {"component", "connection"} and row.cell_below("component"):
        _import_component(project, row)
    elif row.kind in {"component", "group", "requirement"}:
        project.add_warning(
            "missing-key",
            f"this row names no {row.kind} and was not taken",
            span,
            "fill in its name, or take the row out",
        )


def _import_group(project: ImportedProject, row: TableRecord) -> None:
    cell = row.cells["group"]
    group = project.get_group(cell.one_line, cell.span)
    title, owner, description = (
        row.cell_below("title") or row.cell_below("component"),
        row.cell_below("owner"),
        row.cell_below("description") or row.cell_below("functionality"),
    )
    if title:
        group.name = title.one_line
    if owner:
        group.values["owner"] = _read_owners(project, owner)
    if description:
        group.values["description"] = _join_lines(description)


def _import_requirement(project: ImportedProject, row: TableRecord) -> None:
    cell, text = (
        row.cells["requirement"],
        row.cell_below("title") or row.cell_below("description") or row.cell_below("functionality"),
    )
    for name in cell_values.read_requirements(project, cell):
        if name in project.requirements and text:
            project.requirements[name] = text.one_line


def _import_component(project: ImportedProject, row: TableRecord) -> None:
    cell = row.cells["component"]
    group_cell, name = row.cell_below("group"), cell.one_line
    if row.has_exact_ids:
        group_id, _, name = name.rpartition(".")
        group = project.get_group(group_id, cell.span)
    elif group_cell:
        group = project.get_group(group_cell.one_line, group_cell.span)
    else:
        namesakes = project.find_components(name)
        group = project.groups[namesakes[0].group] if len(namesakes) == 1 else project.get_group(UNSORTED, cell.span)
    id_cell = row.cell_below("id")
    row.component = component = project.get_component(group, name, cell.span, id_cell.one_line if id_cell else "")
    title = row.cell_below("title")
    if title:
        component.name = title.one_line
    if row.kind == "component":
        for key in ("functionality", "description"):
            _set_key(project, component, key, _join_lines(row.cell_below(key)), row.cell_below(key))
    _set_key(project, component, "owner", _read_owners(project, row.cell_below("owner")), row.cell_below("owner"))
    _import_role(project, component, row.cell_below("role"))
    requirement_cell = row.cell_below("requirement")
    if requirement_cell:
        component.requirements += [
            requirement
            for requirement in cell_values.read_requirements(project, requirement_cell)
            if requirement not in component.requirements
        ]
    rate = row.cell_below("rate") or row.cell_below("period")
    if rate and row.kind == "component":
        unit = row.units.get("rate" if row.cell_below("rate") else "period", "Hz" if row.cell_below("rate") else "ms")
        _set_key(project, component, "timing", cell_values.read_timing(project, rate, unit), rate)


def _join_lines(cell: TableCell | None) -> str | None:
    """Return a text of several lines without blanks at the ends of its lines."""
    return "\n".join(line.rstrip() for line in cell.text.splitlines()) if cell else None


def _set_key(
    project: ImportedProject, component: ImportedComponent, key: str, value: object, cell: TableCell | None
) -> None:
    """Set a key; a different value from an earlier row stays."""
    if value is None or cell is None:
        return
    if component.values.setdefault(key, value) != value:
        message = f"another row says something else on {key} of `{component.name}`: this was not taken"
        project.add_warning("conflicting-values", message, cell.span, "say it once")


def _import_role(project: ImportedProject, component: ImportedComponent, cell: TableCell | None) -> None:
    if cell is None:
        return
    role = _ROLE_WORDS.get(cell.one_line.casefold())
    if role:
        _set_key(project, component, "role", role, cell)
    else:
        project.add_warning(
            "wrong-value",
            f"`{cell.one_line}` is no role and was not taken",
            cell.span,
            "write source, filter, sink or reactive",
        )


def _read_owners(project: ImportedProject, cell: TableCell | None) -> str | tuple[str, ...] | None:
    """Read one partner or several."""
    if cell is None:
        return None
    names = [name.strip() for name in re.split(r"[,;/&+\n]| and ", cell.text) if name.strip()]
    owners = tuple(dict.fromkeys(project.get_partner_id(name) for name in names))
    return owners[0] if len(owners) == 1 else owners or None
