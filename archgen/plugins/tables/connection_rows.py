"""Import rows that connect a component's output to a component's input."""

from __future__ import annotations

from typing import NamedTuple

from archgen.plugin.importing import MAX_ID_LENGTH, make_id, make_unique_id
from archgen.plugins.tables import cell_values, declaration_rows, port_lists
from archgen.plugins.tables.imported_project import UNSORTED, ImportedComponent, ImportedInput, ImportedProject
from archgen.plugins.tables.table_cells import TableCell
from archgen.plugins.tables.table_records import TableRecord


class ConnectionEnd(NamedTuple):
    """One end of a connection: a component, and the name of its port if the cell has one (`component.output`)."""

    component: ImportedComponent
    port: str


class DataFlow(NamedTuple):
    """What flows: the output's id (empty where it is not known) and its type."""

    output: str
    type: str | None


def import_connection(project: ImportedProject, row: TableRecord) -> None:
    """Import one connection."""
    if row.kind != "connection":
        return
    if row.has_exact_ids:
        _import_listed_connection(project, row)
        return
    source_cell = row.cell_below("from") or (row.cell_below("component") if row.cell_below("to") else None)
    target_cell = row.cell_below("to") or (row.cell_below("component") if row.cell_below("from") else None)
    if source_cell is None and target_cell is None:
        row.is_lost = True  # a formula stood there, and was said
        return
    source = _find_end(project, row, source_cell, "from_group") if source_cell else None
    target = _find_end(project, row, target_cell, "to_group") if target_cell else None
    if (source_cell and source is None) or (target_cell and target is None):
        row.is_lost = True
        return
    _report_open_input(project, row, source, target)
    type_name = _read_type(project, row)
    output_id = _resolve_output(project, row, source, type_name) if source else ""
    # `import_node_row` comes later, and needs the component and output that this row is about.
    row.component = source.component if source else None
    row.output_id = output_id
    if target:
        _connect_input(project, row, (source, target), DataFlow(output_id, type_name))
    _take_ends(project, row, (source, target), (source_cell, target_cell), type_name)
    if source:
        declaration_rows.import_timing(project, row, source.component)
    if requirement := row.cell_below("requirement"):
        message = f"`{requirement.quotation}`: requirements of a connection were not taken: components have them"
        project.reject_cell("wrong-value", message, requirement, "write them in a component's row")


def _take_ends(
    project: ImportedProject,
    row: TableRecord,
    ends: tuple[ConnectionEnd | None, ConnectionEnd | None],
    cells: tuple[TableCell | None, TableCell | None],
    type_name: str | None,
) -> None:
    """Note what the cells of a connection were taken for."""
    source, target = ends
    if source and cells[0]:
        project.take_cell(cells[0], "from", target.component if target else source.component, source.component.id)
    if target and cells[1]:
        project.take_cell(cells[1], "to", target.component, target.component.id)
    carrier = source.component if source else target.component if target else None
    type_cell = row.cell_below("type")
    if type_cell is None or type_cell.span in project.ledger.reasons:
        type_cell = row.cell_below("message")
    if type_cell and type_name and carrier:
        project.take_cell(type_cell, "type", carrier, type_name)
    output = row.cell_below("output")
    if output and source and row.output_id:
        project.take_cell(output, "output", source.component, row.output_id)


def _report_open_input(
    project: ImportedProject, row: TableRecord, source: ConnectionEnd | None, target: ConnectionEnd | None
) -> None:
    if source is None and target is not None:
        message = f"nothing says where this comes from: the input of `{target.component.name}` has no source yet"
        project.add_warning("missing-key", message, row.first_cell.span, "fill in the component that gives it")


def _find_end(project: ImportedProject, row: TableRecord, cell: TableCell, group_key: str) -> ConnectionEnd | None:
    """Find the component that a cell names; add one that no row declares, and report it."""
    group_cell = row.cell_below(group_key) or (row.cell_below("group") if group_key == "from_group" else None)
    name = cell.one_line
    namesakes = project.find_components(name)
    if row.cell_below(group_key):
        return ConnectionEnd(project.get_component(project.get_group(row.cells[group_key]), name, cell.span), "")
    # A component of the row's own group comes before namesakes in other groups.
    candidates = [
        component for component in namesakes if group_cell and component.group == project.get_group(group_cell).id
    ] or namesakes
    if len(candidates) == 1:
        return ConnectionEnd(candidates[0], "")
    if candidates:
        groups = ", ".join(f"`{component.group}`" for component in candidates)
        message = f"`{name}` is a component in several groups ({groups}): this row was not taken"
        help_line = f"write `{candidates[0].group}.{candidates[0].id}`"
        project.reject_cell("ambiguous-reference", message, cell, help_line)
        return None
    component_and_port = project.resolve_path(name)
    if component_and_port:
        return ConnectionEnd(*component_and_port)
    return ConnectionEnd(_add_component(project, cell, group_cell), "")


def _add_component(project: ImportedProject, cell: TableCell, group_cell: TableCell | None) -> ImportedComponent:
    """Add a component that no row declares."""
    guess = project.suggest_component(cell.one_line)
    group = project.get_group(group_cell) if group_cell else project.get_named_group(UNSORTED, cell.span)
    component = project.get_component(group, cell.one_line, cell.span)
    if project.is_complete:
        message = f"no row declares the component `{cell.one_line}`: it was added to the group `{group.id}`"
        project.add_warning(
            "unknown-reference", message, cell.span, f"{guess}or add a row for it" if guess else "add a row for it"
        )
    return component


def _read_type(project: ImportedProject, row: TableRecord) -> str | None:
    """Read the row's type, or else its message."""
    cell, message_cell = row.cell_below("type"), row.cell_below("message")
    type_name = cell_values.read_type_name(project, cell) if cell else None
    return type_name or (cell_values.read_message_cell(project, message_cell) if message_cell else None)


def _resolve_output(project: ImportedProject, row: TableRecord, source: ConnectionEnd, type_name: str | None) -> str:
    """Return the output's id: as the row names it, as its type is called, or the only one of the component."""
    outputs = source.component.outputs
    cell = row.cell_below("output")
    name = cell.one_line if cell else source.port
    if not name and type_name:
        name = (
            next((output_id for output_id, output_type in outputs.items() if output_type == type_name), "")
            or type_name.rpartition("/")[2]
        )
    if not name and len(outputs) == 1:
        return next(iter(outputs))
    if not name:
        return ""
    output_id = name if name in outputs else make_id(name, "output")
    return port_lists.add_typed_output(project, source.component, output_id, type_name, cell or row.first_cell)


def _connect_input(
    project: ImportedProject,
    row: TableRecord,
    connection_ends: tuple[ConnectionEnd | None, ConnectionEnd],
    flow: DataFlow,
) -> None:
    """Connect a component's input to its source, and describe it."""
    (source, target), output_id, type_name = connection_ends, flow.output, flow.type
    cell = row.cell_below("input")
    port_name = cell.one_line if cell else target.port
    input_id = make_id(port_name, "input") if port_name else output_id
    if not input_id:
        input_id = source.component.id if source else "input"
    path = _path_of(source, output_id) if source else ()
    existing = target.component.inputs.get(input_id)
    # Without a name of its own the input is called like the output. A second source of the same type feeds the same
    # input; one of another type must not, and gets an input named after its component.
    if (
        existing
        and not port_name
        and existing.sources
        and path
        and path not in existing.sources
        and _carries_other_type(project, existing, type_name)
    ):
        input_id = make_unique_id(
            f"{input_id}_{source.component.id}"[:MAX_ID_LENGTH].strip("_") if source else input_id,
            set(target.component.inputs),
        )
    port = target.component.inputs.setdefault(input_id, ImportedInput())
    if cell:
        project.take_cell(cell, "input", target.component, input_id)
    if path and path not in port.sources:
        port.sources.append(path)
    elif not path and type_name:
        port.type = port.type or type_name
    description = row.cell_below("description") or row.cell_below("functionality")
    if description and port.description in {None, description.one_line}:
        port.description = description.one_line
        project.take_cell(description, "description", target.component, description.one_line)
    elif description:
        message = f"another row describes the input `{input_id}`: `{description.quotation}` was not taken"
        project.reject_cell("conflicting-values", message, description, "say it once")


def _carries_other_type(project: ImportedProject, existing: ImportedInput, type_name: str | None) -> bool:
    """Return whether an input already takes a type other than this one."""
    source_types = {
        project.groups[path[0]].components[path[1]].outputs.get(path[2])
        for path in existing.sources
        if len(path) == 3  # noqa: PLR2004 - group, component, output
    }
    return type_name not in source_types


def _path_of(source: ConnectionEnd, output_id: str) -> tuple[str, ...]:
    """Return the path of an output, or of its component where the output is not known."""
    component = source.component
    return (component.group, component.id, output_id) if output_id else (component.group, component.id)


def _import_listed_connection(project: ImportedProject, row: TableRecord) -> None:
    """Import a connection that `archgen list` wrote: complete paths at both ends."""
    source, target = row.cell_below("from"), row.cell_below("to")
    if source is None or target is None:
        return
    path = tuple(source.one_line.split("."))
    group, _, inner_path = target.one_line.partition(".")
    component, _, port = inner_path.partition(".")
    reader = project.get_component(project.get_named_group(group, target.span), component, target.span)
    project.take_cell(target, "to", reader, port)
    project.take_cell(source, "from", reader, path[-1])
    existing = reader.inputs.setdefault(port, ImportedInput())
    if path not in existing.sources:
        existing.sources.append(path)
    if len(path) > 1:
        producer = project.get_component(project.get_named_group(path[0], source.span), path[1], source.span)
        type_name = _read_type(project, row) if row.cell_below("type") and row.cells["type"].one_line != "?" else None
        if len(path) == 3:  # noqa: PLR2004 - group, component, output
            project.add_output(producer, path[2], producer.outputs.get(path[2]) or type_name)
