"""Import what rows say about groups, components and requirements themselves.

Import what rows say about the ROS side: nodes, topics, and the messages of types.
"""

from __future__ import annotations

import re

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.tables import cell_values, port_lists
from archgen.plugins.tables.imported_project import UNSORTED, ImportedComponent, ImportedGroup, ImportedProject
from archgen.plugins.tables.table_cells import TableCell
from archgen.plugins.tables.table_records import TableRecord

_ROLE_SPELLINGS = {
    "source": "source; sensor; quelle; capteur; fuente; origen",
    "filter": "filter; processing; verarbeitung; filtre; traitement; filtro; procesamiento",
    "sink": "sink; actuator; senke; aktor; aktuator; aktorik; puits; actionneur; sumidero; actuador",
    "reactive": "reactive; service; reaktiv; dienst; réactif; reactivo; servicio",
}
_ROLE_BY_WORD = {word.strip(): role for role, words in _ROLE_SPELLINGS.items() for word in words.split(";")}


def import_declaration(project: ImportedProject, row: TableRecord) -> None:
    """Import what a row says about groups, components or requirements; report a row that names none."""
    first_cell = row.first_cell
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
        message = f"this row names no {row.kind} and was not taken"
        help_line = "fill in its name, or take the row out"
        row.is_lost = True
        if row.cells:
            project.reject_cell("missing-key", message, next(iter(row.cells.values())), help_line)
        else:
            project.add_warning("missing-key", message, first_cell.span, help_line)


def _import_group(project: ImportedProject, row: TableRecord) -> None:
    cell = row.cells["group"]
    group = project.get_group(cell)
    title, owner, description = (
        row.cell_below("title") or row.cell_below("component"),
        row.cell_below("owner"),
        row.cell_below("description") or row.cell_below("functionality"),
    )
    if title:
        group.name = title.one_line
        project.ledger.take_cell(title, "title", group.path, title.one_line)
    if owner:
        group.values["owner"] = _read_owners(project, owner, group)
    if description:
        group.values["description"] = cell_values.join_cell_lines(description)
        project.ledger.take_cell(description, "description", group.path, cell_values.join_cell_lines(description))


def _import_requirement(project: ImportedProject, row: TableRecord) -> None:
    cell, text = (
        row.cells["requirement"],
        row.cell_below("title") or row.cell_below("description") or row.cell_below("functionality"),
    )
    for name in cell_values.read_requirements(project, cell):
        if name in project.requirements:
            project.ledger.take_cell(cell, "requirement", ("requirements", name), name)
            if text:
                project.requirements[name] = text.one_line
                project.ledger.take_cell(text, "title", ("requirements", name), text.one_line)


def _import_component(project: ImportedProject, row: TableRecord) -> None:
    cell = row.cells["component"]
    row.component = component = _find_component(project, row, cell)
    project.take_cell(cell, "component", component, component.id)
    title = row.cell_below("title")
    if title:
        component.name = title.one_line
        project.take_cell(title, "title", component, title.one_line)
    if row.kind == "component":
        for key in ("functionality", "description"):
            if text := row.cell_below(key):
                _set_key(project, component, key, cell_values.join_cell_lines(text), text)
    owner = row.cell_below("owner")
    if owner:
        _set_key(project, component, "owner", _read_owners(project, owner, component), owner)
    _import_role(project, component, row.cell_below("role"))
    requirement_cell = row.cell_below("requirement")
    if requirement_cell and row.kind == "component":
        for requirement in cell_values.read_requirements(project, requirement_cell):
            project.take_cell(requirement_cell, "requirements", component, requirement)
            if requirement not in component.requirements:
                component.requirements.append(requirement)
    if row.kind == "component":
        import_timing(project, row, component)


def _find_component(project: ImportedProject, row: TableRecord, cell: TableCell) -> ImportedComponent:
    """Return the component of a row, a new one where there is none."""
    group_cell, name = row.cell_below("group"), cell.one_line
    if row.has_exact_ids:
        group_id, _, name = name.rpartition(".")
        group = project.get_named_group(group_id, cell.span)
    elif group_cell:
        group = project.get_group(group_cell)
    else:
        namesakes = project.find_components(name)
        group = (
            project.groups[namesakes[0].group] if len(namesakes) == 1 else project.get_named_group(UNSORTED, cell.span)
        )
    id_cell = row.cell_below("id")
    component = project.get_component(group, name, cell.span, id_cell.one_line if id_cell else "")
    if id_cell and component.wanted_id != id_cell.one_line:
        message = f"`{component.name}` has the id `{component.id}` already: `{id_cell.quotation}` was not taken"
        project.reject_cell("conflicting-values", message, id_cell, "say it in the first row of the component")
    elif id_cell:
        project.take_cell(id_cell, "id", component, component.id)
    return component


def import_timing(project: ImportedProject, row: TableRecord, component: ImportedComponent) -> None:
    """Import a component's rate, or else its period; a different one from an earlier row stays."""
    rate, period = row.cell_below("rate"), row.cell_below("period")
    cell = rate or period
    if cell is None:
        return
    if rate and period:
        message = f"`{period.quotation}` was not taken: the row has a rate, and a period says the same"
        project.reject_cell("conflicting-values", message, period, "leave out one of the two")
    unit = row.units.get("rate" if rate else "period", "Hz" if rate else "ms")
    timing = cell_values.read_timing(project, cell, unit)
    if timing is None:
        return
    message = f"`{component.name}` has another rate already: `{cell.quotation}` was not taken"
    help_line = "a component has one rate; slower outputs are written by hand"
    if project.set_once(component.values, "timing", timing, cell, message, help_line):
        project.take_cell(cell, next(iter(timing)), component, next(iter(timing.values())))


def _set_key(
    project: ImportedProject, component: ImportedComponent, key: str, value: str | tuple[str, ...], cell: TableCell
) -> None:
    """Set a key; a different value from an earlier row stays."""
    message = f"another row says something else on {key} of `{component.name}`: this was not taken"
    if project.set_once(component.values, key, value, cell, message):
        path = ("groups", component.group) if key == "owner" else component.path
        for words in (value,) if isinstance(value, str) else value:
            project.ledger.take_cell(cell, key, path, words)


def _import_role(project: ImportedProject, component: ImportedComponent, cell: TableCell | None) -> None:
    if cell and (role := _read_word(project, cell, "role")):
        _set_key(project, component, "role", role, cell)


def _read_word(project: ImportedProject, cell: TableCell, key: str) -> str | None:
    """Return what a word means that people write for a role or a status; a word that means neither is reported."""
    meanings, words = (
        (_ROLE_BY_WORD, "source, filter, sink or reactive")
        if key == "role"
        else (_STATUS_BY_WORD, "planned, adapted or existing")
    )
    meaning = meanings.get(cell.one_line.casefold())
    if meaning is None:
        project.reject_cell("wrong-value", f"`{cell.quotation}` is no {key} and was not taken", cell, f"write {words}")
    return meaning


def _read_owners(
    project: ImportedProject, cell: TableCell, owned: ImportedComponent | ImportedGroup
) -> str | tuple[str, ...]:
    """Read one partner or several."""
    # Not at `&`: it stands in the names of companies.
    names = [name.strip() for name in re.split(r"[,;/+\n]| (?:and|und|et|y) ", cell.text) if name.strip()]
    owners = tuple(dict.fromkeys(project.get_partner_id(name) for name in names or [cell.one_line]))
    if isinstance(owned, ImportedGroup):
        for owner in owners:
            project.ledger.take_cell(cell, "owner", owned.path, owner)
    return owners[0] if len(owners) == 1 else owners


_STATUS_SPELLINGS = {
    "planned": "planned; geplant; in planung; prévu; prévue; planifié; planificado; planeado; previsto",
    "existing": "existing; vorhanden; bestehend; fertig; existant; existante; existente",
    "adapted": "adapted; angepasst; adapté; adaptée; adaptado; adaptada",
}
_STATUS_BY_WORD = {word.strip(): status for status, words in _STATUS_SPELLINGS.items() for word in words.split(";")}


def import_node_row(project: ImportedProject, row: TableRecord) -> None:
    """Import a row's node, topic and message."""
    _import_message(project, row)
    if row.has_exact_ids and row.kind == "node":
        _import_listed_node(project, row)
        return
    if row.has_exact_ids or not ({"node", "topic", "package", "status"} & set(row.cells)):
        return
    if row.component is None and row.kind == "node" and row.cell_below("component"):
        row.component = next(iter(project.find_components(row.cells["component"].one_line)), None)
    if row.component is None:
        first_cell = next(row.cells[key] for key in ("node", "topic", "package", "status") if key in row.cells)
        message = f"`{first_cell.quotation}`: no component stands beside this: it was not taken"
        project.reject_cell("missing-key", message, first_cell, "name the component")
        row.is_lost = True
        return
    name = _get_node(project, row, row.component)
    cell = row.cell_below("package")
    if cell and (package := cell_values.read_package(project, cell)):
        _set_node_key(project, name, "package", package, cell)
    status = row.cell_below("status")
    if status and (word := _read_word(project, status, "status")):
        _set_node_key(project, name, "status", word, status)
    if row.cell_below("topic"):
        _import_topics(project, row, row.component, name)


def _set_node_key(project: ImportedProject, name: str, key: str, value: str, cell: TableCell) -> None:
    """Set a node's key; a different value from an earlier row stays."""
    message = f"the node `{name}` has another {key} already: `{cell.quotation}` was not taken"
    if project.set_once(project.nodes[name], key, value, cell, message):
        project.ledger.take_cell(cell, key, ("nodes", name), value)


def _import_listed_node(project: ImportedProject, row: TableRecord) -> None:
    """Import a node that `archgen list` wrote; one without a place was derived, and will be derived again."""
    cell, implements = row.cells["node"], row.cell_below("component")
    if row.cell_below("place") is None or implements is None:
        return
    node: dict[str, object] = {"implements": [part.strip() for part in implements.one_line.split(",")]}
    node |= {key: row.cells[key].one_line for key in ("package", "status") if key in row.cells}
    project.nodes[cell.one_line] = node
    for key in ("node", "component", "package", "status"):
        if key in row.cells:
            project.ledger.take_cell(row.cells[key], key, ("nodes", cell.one_line))


def _get_node(project: ImportedProject, row: TableRecord, component: ImportedComponent) -> str:
    """Return the id of the node of a row: the one it names, the component's first, or a new one called like the component."""
    path = f"{component.group}.{component.id}"
    cell = row.cell_below("node")
    if cell is None:
        existing = project.first_node.get(path)
        if existing is not None:
            return existing
        name = make_unique_id(component.id, set(project.nodes))
    else:
        name = make_id(cell.one_line.strip("/"), "node")
    node = project.nodes.setdefault(name, {"implements": []})
    project.first_node.setdefault(path, name)
    if path not in _implemented_paths(node):
        node["implements"] = [*_implemented_paths(node), path]
    if cell:
        project.ledger.take_cell(cell, "node", ("nodes", name), name)
    return name


def _implemented_paths(node: dict[str, object]) -> list[str]:
    implements = node["implements"]
    return implements if isinstance(implements, list) else []


def _import_topics(project: ImportedProject, row: TableRecord, component: ImportedComponent, node: str) -> None:
    """Import the topics for the row's outputs, or for the component's only one."""
    cell = row.cells["topic"]
    connected = [row.output_id] if row.kind == "connection" and row.output_id else []
    names = connected or row.output_ids or list(component.outputs)
    if not names:
        message = f"`{cell.quotation}` was not taken: `{component.name}` has no output that could stand on this topic"
        project.reject_cell("missing-key", message, cell, "write it in a row that names the output")
    for name, topic_cell in zip(names, port_lists.split_beside(project, names, cell, component), strict=True):
        topic = cell_values.read_topic(project, topic_cell) if topic_cell else None
        if topic and topic_cell:
            _set_topic(project, component, (node, name), topic, topic_cell)


def _set_topic(
    project: ImportedProject,
    component: ImportedComponent,
    node_and_output: tuple[str, str],
    topic: str,
    cell: TableCell,
) -> None:
    """Set the topic of an output; a different one from an earlier row stays."""
    node, output = node_and_output
    type_name = component.outputs.get(output)
    interface_kind = (project.types.get(type_name or "") or type_name or "").split("/")[1:2]
    # The middle of `package/srv/Name` says whether this is a service or an action.
    section = "serves" if interface_kind in (["srv"], ["action"]) else "publishes"
    topics = project.nodes[node].setdefault(section, {})
    if not isinstance(topics, dict):
        return
    message = f"`{output}` stands on the topic `{topics.get(output)}` already: `{cell.quotation}` was not taken"
    if project.set_once(topics, output, topic, cell, message):
        project.ledger.take_cell(cell, "topic", ("nodes", node), topic)


def _import_message(project: ImportedProject, row: TableRecord) -> None:
    """Import the message that carries a type."""
    cell, type_cell = row.cell_below("message"), row.cell_below("type")
    # The messages beside a list of outputs were imported with them.
    if cell is None or type_cell is None or row.output_ids:
        return
    if row.has_exact_ids and cell.one_line in {"?", "physical"}:
        return
    type_name = cell_values.read_type_name(project, type_cell)
    message = cell_values.read_message_cell(project, cell)
    if type_name is None or message is None:
        return
    port_lists.set_message(project, type_name, message, cell)
    if type_name in project.types:
        project.ledger.take_cell(type_cell, "type", ("types", type_name), type_name)
