"""Import what rows say about the ROS side: nodes, topics, and the messages of types."""

from __future__ import annotations

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.tables import cell_values, port_lists
from archgen.plugins.tables.imported_project import ImportedComponent, ImportedProject
from archgen.plugins.tables.row_records import TableRecord
from archgen.plugins.tables.table_cells import TableCell

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
    if status and (word := _STATUS_BY_WORD.get(status.one_line.casefold())):
        _set_node_key(project, name, "status", word, status)
    elif status:
        message = f"`{status.quotation}` is no status and was not taken"
        project.reject_cell("wrong-value", message, status, "write planned, adapted or existing")
    if row.cell_below("topic"):
        _import_topics(project, row, row.component, name)


def _set_node_key(project: ImportedProject, name: str, key: str, value: str, cell: TableCell) -> None:
    """Set a node's key; a different value from an earlier row stays."""
    if project.nodes[name].setdefault(key, value) == value:
        project.ledger.take_cell(cell, key, ("nodes", name), value)
        return
    message = f"the node `{name}` has another {key} already: `{cell.quotation}` was not taken"
    project.reject_cell("conflicting-values", message, cell, "say it once")


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
    if topics.setdefault(output, topic) == topic:
        project.ledger.take_cell(cell, "topic", ("nodes", node), topic)
    else:
        message = f"`{output}` stands on the topic `{topics[output]}` already: `{cell.quotation}` was not taken"
        project.reject_cell("conflicting-values", message, cell, "say it once")


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
