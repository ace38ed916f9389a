"""Import what rows say about the ROS side: nodes, topics, and the messages of types."""

from __future__ import annotations

from archgen.importers import cell_values
from archgen.importers.imported_project import ImportedComponent, ImportedProject
from archgen.importers.row_records import TableRecord
from archgen.importers.table_cells import TableCell
from archgen.model import element_ids

_STATUSES = frozenset({"planned", "existing", "adapted"})


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
        project.add_warning(
            "missing-key", "no component stands beside this: it was not taken", first_cell.span, "name the component"
        )
        return
    node = _get_node(project, row, row.component)
    cell = row.cell_below("package")
    if cell and (package := cell_values.read_package(project, cell)):
        _set_node_key(project, node, "package", package, cell)
    status = row.cell_below("status")
    if status and status.one_line.casefold() in _STATUSES:
        node["status"] = status.one_line.casefold()
    elif status:
        project.add_warning(
            "wrong-value",
            f"`{status.one_line}` is no status and was not taken",
            status.span,
            "write planned, adapted or existing",
        )
    if row.cell_below("topic"):
        _import_topic(project, row, row.component, node)


def _set_node_key(project: ImportedProject, node: dict[str, object], key: str, value: str, cell: TableCell) -> None:
    """Set a node's key; a different value from an earlier row stays."""
    if node.setdefault(key, value) != value:
        project.add_warning(
            "conflicting-values", f"the node has another {key} already: this was not taken", cell.span, "say it once"
        )


def _import_listed_node(project: ImportedProject, row: TableRecord) -> None:
    """Import a node that `archgen list` wrote; one without a place was derived, and will be derived again."""
    cell, implements = row.cells["node"], row.cell_below("component")
    if row.cell_below("place") is None or implements is None:
        return
    node: dict[str, object] = {"implements": [part.strip() for part in implements.one_line.split(",")]}
    node |= {key: row.cells[key].one_line for key in ("package", "status") if key in row.cells}
    project.nodes[cell.one_line] = node


def _get_node(project: ImportedProject, row: TableRecord, component: ImportedComponent) -> dict[str, object]:
    """Return the node of a row: the one it names, the component's first, or a new one called like the component."""
    path = f"{component.group}.{component.id}"
    cell = row.cell_below("node")
    if cell is None:
        existing = project.first_node.get(path)
        if existing is not None:
            return project.nodes[existing]
        name = element_ids.make_unique_id(component.id, set(project.nodes))
    else:
        name = element_ids.make_id(cell.one_line.strip("/"), "node")
    node = project.nodes.setdefault(name, {"implements": []})
    project.first_node.setdefault(path, name)
    if path not in _implemented_paths(node):
        node["implements"] = [*_implemented_paths(node), path]
    return node


def _implemented_paths(node: dict[str, object]) -> list[str]:
    implements = node["implements"]
    return implements if isinstance(implements, list) else []


def _import_topic(
    project: ImportedProject, row: TableRecord, component: ImportedComponent, node: dict[str, object]
) -> None:
    """Import a topic for the row's output, or for the component's only one."""
    cell = row.cells["topic"]
    output = row.cell_below("output") if row.kind == "connection" else None
    names = [output.one_line] if output and output.one_line else list(component.outputs)
    name = cell_values.read_topic(project, cell)
    if name is None:
        return
    if len(names) != 1:
        message = f"it cannot be told which output of `{component.name}` stands on this topic: it was not taken"
        project.add_warning("ambiguous-reference", message, cell.span, "write it in a row that names the output")
        return
    type_name = component.outputs.get(names[0])
    interface_kind = (project.types.get(type_name or "") or type_name or "").split("/")[1:2]
    # The middle of `package/srv/Name` says whether this is a service or an action.
    section = "serves" if interface_kind in (["srv"], ["action"]) else "publishes"
    topics = node.setdefault(section, {})
    if isinstance(topics, dict) and topics.setdefault(names[0], name) != name:
        message = f"`{names[0]}` stands on the topic `{topics[names[0]]}` already: this was not taken"
        project.add_warning("conflicting-values", message, cell.span, "say it once")


def _import_message(project: ImportedProject, row: TableRecord) -> None:
    """Import the message that carries a type."""
    cell, type_cell = row.cell_below("message"), row.cell_below("type")
    if cell is None or type_cell is None or cell.one_line in {"?", "physical"}:
        return
    type_name = cell_values.read_type_name(project, type_cell)
    message = cell_values.read_message(project, cell)
    if type_name is None or message is None or type_name == message:
        return
    if project.types.setdefault(type_name, message) != message:
        text = f"`{type_name}` is carried by `{project.types[type_name]}` in another row: this was not taken"
        project.add_warning("conflicting-values", text, cell.span, "give one of the two another type")
