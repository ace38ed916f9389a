"""Import what rows say about the ROS side: nodes, topics, and the messages of types."""

from __future__ import annotations

from archgen.importers import values
from archgen.importers.cells import Cell
from archgen.importers.draft import Component, Draft
from archgen.importers.rows import Record
from archgen.model import ids

_STATUSES = frozenset({"planned", "existing", "adapted"})


def take(draft: Draft, row: Record) -> None:
    """Import a row's node, topic and message."""
    _message(draft, row)
    if row.exact and row.kind == "node":
        _listed(draft, row)
        return
    if row.exact or not ({"node", "topic", "package", "status"} & set(row.cells)):
        return
    if row.component is None and row.kind == "node" and row.get("component"):
        row.component = next(iter(draft.named(row.cells["component"].line)), None)
    if row.component is None:
        alone = next(row.cells[key] for key in ("node", "topic", "package", "status") if key in row.cells)
        draft.say("missing-key", "no component stands beside this: it was not taken", alone.at, "name the component")
        return
    node = _node(draft, row, row.component)
    cell = row.get("package")
    if cell and (package := values.package(draft, cell)):
        _keep(draft, node, "package", package, cell)
    status = row.get("status")
    if status and status.line.casefold() in _STATUSES:
        node["status"] = status.line.casefold()
    elif status:
        draft.say(
            "wrong-value",
            f"`{status.line}` is no status and was not taken",
            status.at,
            "write planned, adapted or existing",
        )
    if row.get("topic"):
        _topic(draft, row, row.component, node)


def _keep(draft: Draft, node: dict[str, object], key: str, value: str, cell: Cell) -> None:
    """Set a node's key; a different value from an earlier row stays."""
    if node.setdefault(key, value) != value:
        draft.say(
            "conflicting-values", f"the node has another {key} already: this was not taken", cell.at, "say it once"
        )


def _listed(draft: Draft, row: Record) -> None:
    """Import a node that `archgen list` wrote; one without a place was derived, and will be derived again."""
    cell, implements = row.cells["node"], row.get("component")
    if row.get("place") is None or implements is None:
        return
    node: dict[str, object] = {"implements": [part.strip() for part in implements.line.split(",")]}
    node |= {key: row.cells[key].line for key in ("package", "status") if key in row.cells}
    draft.nodes[cell.line] = node


def _node(draft: Draft, row: Record, component: Component) -> dict[str, object]:
    """Return the node of a row: the one it names, the component's first, or a new one called like the component."""
    path = f"{component.group}.{component.id}"
    cell = row.get("node")
    if cell is None:
        held = draft.node_of.get(path)
        if held is not None:
            return draft.nodes[held]
        name = ids.free(component.id, set(draft.nodes))
    else:
        name = ids.made(cell.line.strip("/"), "node")
    node = draft.nodes.setdefault(name, {"implements": []})
    draft.node_of.setdefault(path, name)
    if path not in _implements(node):
        node["implements"] = [*_implements(node), path]
    return node


def _implements(node: dict[str, object]) -> list[str]:
    found = node["implements"]
    return found if isinstance(found, list) else []


def _topic(draft: Draft, row: Record, component: Component, node: dict[str, object]) -> None:
    """Import a topic for the row's output, or for the component's only one."""
    cell = row.cells["topic"]
    output = row.get("output") if row.kind == "connection" else None
    names = [output.line] if output and output.line else list(component.outputs)
    name = values.topic(draft, cell)
    if name is None:
        return
    if len(names) != 1:
        message = f"it cannot be told which output of `{component.name}` stands on this topic: it was not taken"
        draft.say("ambiguous-reference", message, cell.at, "write it in a row that names the output")
        return
    told = component.outputs.get(names[0])
    kind = (draft.types.get(told or "") or told or "").split("/")[1:2]
    # The middle of `package/srv/Name` says whether this is a service or an action.
    section = "serves" if kind in (["srv"], ["action"]) else "publishes"
    held = node.setdefault(section, {})
    if isinstance(held, dict) and held.setdefault(names[0], name) != name:
        message = f"`{names[0]}` stands on the topic `{held[names[0]]}` already: this was not taken"
        draft.say("conflicting-values", message, cell.at, "say it once")


def _message(draft: Draft, row: Record) -> None:
    """Import the message that carries a type."""
    cell, told = row.get("message"), row.get("type")
    if cell is None or told is None or cell.line in {"?", "physical"}:
        return
    name = values.type_name(draft, told)
    message = values.message(draft, cell)
    if name is None or message is None or name == message:
        return
    if draft.types.setdefault(name, message) != message:
        text = f"`{name}` is carried by `{draft.types[name]}` in another row: this was not taken"
        draft.say("conflicting-values", text, cell.at, "give one of the two another type")
