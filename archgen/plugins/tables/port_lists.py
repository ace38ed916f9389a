"""Import the lists of inputs and outputs in a component's row, and find out where each input comes from."""

from __future__ import annotations

import re

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugin.ros import full_message_name
from archgen.plugins.tables import cell_values
from archgen.plugins.tables.imported_project import ImportedComponent, ImportedInput, ImportedProject, fold_name
from archgen.plugins.tables.table_cells import TableCell
from archgen.plugins.tables.table_records import TableRecord

_NONE_WORDS = frozenset(
    {"none", "nothing", "no", "no inputs", "no outputs", "keine", "keiner", "kein", "keines", "nichts", "nein"}
    | {"aucun", "aucune", "néant", "rien", "non", "ninguno", "ninguna", "nada"}
)
_FROM_PATTERN = re.compile(
    r"(?!.*+\n)(?:(.+?)(?:(?<!\s)\s++from\s++|(?:(?<!\s)\s++)?+(?:<-|\u2190|@)\s*+)(.++)\Z"
    r"|(?=.*\)\Z)(.+?)(?:(?<!\s)\s++)?+\((?:from|von|aus|de|du|depuis|desde|del)\s++(.+)\)\Z)"
)
# These words are also parts of names (`nuage de points`): they count only before the name of a component.
_WEAK_FROM_PATTERN = re.compile(r"(?<!\s)\s++(?:von|vom|aus|de la|de l'|du|depuis|desde|del|de)\s*+(?=\S)")


def import_outputs(project: ImportedProject, row: TableRecord) -> None:
    """Import the list of outputs in a component's row, with their types and messages."""
    cell, component = row.cell_below("output"), row.component
    if row.kind != "component" or row.has_exact_ids or cell is None or component is None:
        return
    if cell.one_line.casefold() in _NONE_WORDS:
        component.declared_empty.add("outputs")
        project.take_cell(cell, "outputs", component)
        return
    items = cell_values.list_items(project, cell)
    types = split_beside(project, items, row.cell_below("type"), component)
    messages = split_beside(project, items, row.cell_below("message"), component)
    for number, item in enumerate(items):
        type_name, output_id = _import_output(project, component, item, types[number], cell)
        row.output_ids.append(output_id)
        message_cell = messages[number]
        message = cell_values.read_message_cell(project, message_cell) if message_cell and type_name else None
        if type_name and message and message_cell:
            set_message(project, type_name, message, message_cell)


def _import_output(
    project: ImportedProject, component: ImportedComponent, item: str, type_cell: TableCell | None, cell: TableCell
) -> tuple[str | None, str]:
    """Import one output: `TYPE`, `NAME: TYPE`, or its name with the type in a cell beside it. Return its type and id."""
    name, _, text = (word.strip() for word in item.partition(":"))
    name = name or text
    if type_cell and text and fold_name(type_cell.one_line) != fold_name(text):
        message = f"`{type_cell.quotation}` was not taken: the output `{name}` carries `{text}`"
        project.reject_cell("conflicting-values", message, type_cell, "say it once")
        type_cell = None
    type_name = cell_values.read_type_name(project, type_cell or cell.with_text(text or name))
    output_id = add_typed_output(project, component, make_id(name, "output"), type_name, cell)
    project.take_cell(cell, "outputs", component, output_id)
    if type_name and text:
        project.take_cell(cell, "type of an output", component, type_name)
    elif type_cell is None:
        component.untyped_outputs.add(output_id)
    if type_name and type_cell:
        project.take_cell(type_cell, "type", component, type_name)
    return type_name, output_id


def split_beside(
    project: ImportedProject, items: list[str], cell: TableCell | None, component: ImportedComponent
) -> list[TableCell | None]:
    """Split a cell beside a list of outputs: the first line belongs to the first output, and so on.

    Where there are not as many lines as outputs, nothing tells which one is meant, and that is reported.
    """
    nothing: list[TableCell | None] = [None] * len(items)
    if cell is None or len(items) < 2:  # noqa: PLR2004 - one output, or none
        return [cell] * len(items)
    lines = cell_values.split_cell_list(cell)
    if len(lines) == len(items):
        return [cell.with_text(line) for line in lines]
    message = f"`{cell.quotation}` was not taken: which of the {len(items)} outputs of `{component.name}` is it for?"
    help_line = "write a line for each output, in their order; or a row for each"
    project.reject_cell("ambiguous-reference", message, cell, help_line)
    return nothing


def set_message(project: ImportedProject, type_name: str, message: str, cell: TableCell) -> None:
    """Set the message that carries a type; a different one from an earlier row stays."""
    carried_by = type_name if full_message_name(type_name) else project.types.setdefault(type_name, message)
    if carried_by == message:
        # A message that is its own type stands at the output, and in no table of types.
        element = ("types", type_name) if type_name in project.types else ("groups",)
        project.ledger.take_cell(cell, "message", element, message)
        return
    text = f"`{type_name}` is carried by `{carried_by}` already: `{cell.quotation}` was not taken"
    project.reject_cell("conflicting-values", text, cell, "give one of the two another type")


def add_typed_output(
    project: ImportedProject, component: ImportedComponent, output_id: str, type_name: str | None, cell: TableCell
) -> str:
    """Add an output to a component and return its id; another type on the same id makes another output."""
    existing_type = component.outputs.get(output_id)
    if output_id not in component.outputs or existing_type is None or output_id in component.untyped_outputs:
        if type_name or output_id not in component.outputs:
            project.add_output(component, output_id, type_name)
            component.untyped_outputs.discard(output_id)
    elif type_name is not None and existing_type != type_name:
        same_type = next((other_id for other_id, type_ in component.outputs.items() if type_ == type_name), None)
        free_id = same_type or make_unique_id(output_id, set(component.outputs))
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
        project.take_cell(cell, "inputs", component)
        return
    for item in cell_values.list_items(project, cell):
        name, _, text = (word.strip() for word in item.partition(":"))
        _import_input(project, component, name or text, text or name, cell)


def _import_input(
    project: ImportedProject, component: ImportedComponent, name: str, text: str, cell: TableCell
) -> None:
    """Import one input: `WHAT`, `NAME: WHAT`, `WHAT from COMPONENT`, `WHAT <- COMPONENT` or `WHAT @ COMPONENT`."""
    wanted_name, producer = _split_source(project, text)
    name = wanted_name if name == text else name
    sources = _find_sources(project, component, wanted_name, producer)
    if (
        name == wanted_name
        and len(sources) == 1
        and any(sources[0] in port.sources for port in component.inputs.values())
    ):
        # A connection gave this source another name already.
        project.take_cell(cell, "inputs", component, sources[0][-1])
        return
    input_id = make_id(name, "input")
    port = component.inputs.setdefault(input_id, ImportedInput())
    project.take_cell(cell, "inputs", component, input_id)
    if len(sources) == 1:
        port.sources += [source for source in sources if source not in port.sources]
        project.take_cell(cell, "source of an input", component, sources[0][-1])
        return
    if port.sources or port.type:
        if port.type != wanted_name:
            message = (
                f"`{text}` was not taken: the input `{input_id}` of `{component.name}` comes from elsewhere already"
            )
            project.reject_cell("conflicting-values", message, cell, "name a component that gives it")
        return
    port.type = cell_values.read_type_name(project, cell.with_text(wanted_name))
    if port.type:
        project.take_cell(cell, "type of an input", component, port.type)
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


def _split_source(project: ImportedProject, text: str) -> tuple[str, str]:
    """Return what an input takes, and the component that it names behind `from` (empty where it names none)."""
    match = _FROM_PATTERN.match(text)
    if match:
        return (match[1] or match[3]).strip(), (match[2] or match[4]).strip()
    if not project.find_producers(text) and not project.find_components(text):
        for weak_match in _WEAK_FROM_PATTERN.finditer(text):
            producer = text[weak_match.end() :].strip()
            if weak_match.start() and project.find_components(producer):
                return text[: weak_match.start()].strip(), producer
    return text, ""


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
        found_id = make_id(wanted_name, "output")
        project.add_output(component, found_id, wanted_name)
    return (component.group, component.id, found_id)
