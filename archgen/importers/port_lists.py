"""Import the lists of inputs and outputs in a component's row, and find out where each input comes from."""

from __future__ import annotations

import re

from archgen.importers import cell_values
from archgen.importers.imported_project import ImportedComponent, ImportedInput, ImportedProject, fold_name
from archgen.importers.row_records import TableRecord
from archgen.importers.table_cells import TableCell
from archgen.model import element_ids

_NONE_WORDS = frozenset({"none", "nothing", "no", "no inputs", "no outputs"})


def import_outputs(project: ImportedProject, row: TableRecord) -> None:
    """Import the list of outputs in a component's row."""
    cell, component = row.cell_below("output"), row.component
    if row.kind != "component" or row.has_exact_ids or cell is None or component is None:
        return
    if cell.one_line.casefold() in _NONE_WORDS:
        component.declared_empty.add("outputs")
        return
    for item in cell_values.split_list(cell):
        name, colon, text = (word.strip() for word in item.partition(":"))
        type_cell = row.cell_below("type") if len(cell_values.split_list(cell)) == 1 and not colon else None
        type_name = (
            cell_values.read_type_name(project, type_cell)
            if type_cell
            else cell_values.read_type_name(project, TableCell(text if colon else name, cell.span))
        )
        if name:
            add_typed_output(project, component, element_ids.make_id(name, "output"), type_name, cell)


def add_typed_output(
    project: ImportedProject, component: ImportedComponent, output_id: str, type_name: str | None, cell: TableCell
) -> str:
    """Add an output to a component and return its id; another type on the same id makes another output."""
    existing_type = component.outputs.get(output_id)
    if output_id not in component.outputs or existing_type is None:
        project.add_output(component, output_id, type_name)
    elif type_name is not None and existing_type != type_name:
        same_type = next((other_id for other_id, type_ in component.outputs.items() if type_ == type_name), None)
        free_id = same_type or element_ids.make_unique_id(output_id, set(component.outputs))
        if same_type is None:
            project.add_output(component, free_id, type_name)
            message = f"the output `{output_id}` of `{component.name}` carries `{existing_type}`: `{type_name}` became the output `{free_id}`"
            project.add_note(message, cell.span, "give the outputs names of their own")
        return free_id
    return output_id


def import_inputs(project: ImportedProject, row: TableRecord) -> None:
    """Import the list of inputs in a component's row, each with its source where that is clear."""
    cell, component = row.cell_below("input"), row.component
    if row.kind != "component" or row.has_exact_ids or cell is None or component is None:
        return
    if cell.one_line.casefold() in _NONE_WORDS:
        component.declared_empty.add("inputs")
        return
    for item in cell_values.split_list(cell):
        name, _, text = (word.strip() for word in item.partition(":"))
        _import_input(project, component, name, text or name, cell)


def _import_input(
    project: ImportedProject, component: ImportedComponent, name: str, text: str, cell: TableCell
) -> None:
    """Import one input: `WHAT`, `NAME: WHAT`, `WHAT from COMPONENT`, `WHAT <- COMPONENT` or `WHAT @ COMPONENT`."""
    wanted_name, producer = text, ""
    match = re.match(r"(.+?)(?:\s+from\s+|\s*<-\s*|\s*\u2190\s*|\s*@\s*)(.+)\Z|(.+?)\s*\((?:from\s+)(.+)\)\Z", text)
    if match:
        wanted_name, producer = (match[1] or match[3]).strip(), (match[2] or match[4]).strip()
        name = wanted_name if name == text else name
    sources = _find_sources(project, component, wanted_name, producer)
    port = component.inputs.setdefault(element_ids.make_id(name, "input"), ImportedInput())
    if len(sources) == 1:
        port.sources += [source for source in sources if source not in port.sources]
        return
    if port.sources:
        return
    port.type = cell_values.read_type_name(project, TableCell(wanted_name, cell.span))
    if len(sources) > 1:
        candidates = ", ".join(f"`{'.'.join(path)}`" for path in sources[:4])
        message = f"`{wanted_name}` comes from several components ({candidates}): the input has no source yet"
        project.add_warning("ambiguous-reference", message, cell.span, f"write `{wanted_name} from NAME`")
    elif producer:
        message = f"no component is called `{producer}`: the input `{name}` of `{component.name}` has no source yet"
        project.add_warning(
            "unknown-reference", message, cell.span, project.suggest_component(producer) or "add a row for it"
        )
    else:
        message = f"no component gives `{wanted_name}`: the input of `{component.name}` has no source yet"
        project.add_warning(
            "unknown-reference", message, cell.span, "name it as an output somewhere, or write `WHAT from COMPONENT`"
        )


def _find_sources(
    project: ImportedProject, reader: ImportedComponent, wanted_name: str, producer: str
) -> list[tuple[str, ...]]:
    """Return the paths that an input may mean."""
    if producer:
        component_and_port = project.resolve_path(producer)
        components = project.find_components(producer) or ([component_and_port[0]] if component_and_port else [])
        return [_find_output(project, component, wanted_name) for component in components]
    # A component by that name comes before outputs and types: people list what feeds an input by its component.
    components_named = [component for component in project.find_components(wanted_name) if component is not reader]
    if components_named:
        return [(component.group, component.id) for component in components_named]
    component_and_port = project.resolve_path(wanted_name)
    if component_and_port and component_and_port[1]:
        return [_find_output(project, component_and_port[0], component_and_port[1])]
    return [path for path in project.find_producers(wanted_name) if path[:2] != (reader.group, reader.id)]


def _find_output(project: ImportedProject, component: ImportedComponent, wanted_name: str) -> tuple[str, ...]:
    """Return the path of a component's output by its name or type; add the output where there is none."""
    found_id = next(
        (
            output_id
            for output_id, type_name in component.outputs.items()
            if fold_name(wanted_name) in {fold_name(output_id), fold_name(type_name or "")}
        ),
        None,
    )
    if found_id is None:
        found_id = element_ids.make_id(wanted_name, "output")
        project.add_output(component, found_id, wanted_name)
    return (component.group, component.id, found_id)
