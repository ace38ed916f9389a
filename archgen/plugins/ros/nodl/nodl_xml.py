"""NoDL 1: a file in XML says what the nodes of a package have."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.plugin.importing import XmlElement, make_id
from archgen.plugins.ros.nodl.nodl_types import NodeType, NodlPort
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_ROLES = {
    "topic": {"publisher": ("publishes",), "subscription": ("subscribes",), "both": ("publishes", "subscribes")},
    "service": {"server": ("serves",), "client": ("calls",), "both": ("serves", "calls")},
    "action": {"server": ("serves",), "client": ("calls",), "both": ("serves", "calls")},
}
_TYPES = {
    "bool": "boolean",
    "int": "integer",
    "integer": "integer",
    "double": "float",
    "float": "float",
    "str": "string",
    "string": "string",
}
_MAX_PARAMETER_NAME = 200


def read_interface(root: XmlElement, file: str, account: ImportAccount) -> Iterator[tuple[str, NodeType]]:
    """Yield the nodes of a file by their names."""
    for element in root.find_all("node"):
        name = element.attributes.get("name", "").strip()
        if not name:
            account.add_note("node", "a node has no name", element.span(file))
            continue
        node = NodeType(account)
        executable = element.attributes.get("executable", "").strip()
        if executable:
            node.node["executable"] = executable
        if name.isidentifier() and name != make_id(name, "node"):
            node.node["name"] = name
        for child in element.children:
            _read_child(node, child, file, account)
        yield name, node


def _read_child(node: NodeType, child: XmlElement, file: str, account: ImportAccount) -> None:
    name, type_name = (child.attributes.get(key, "").strip() for key in ("name", "type"))
    if child.tag in _ROLES:
        role = child.attributes.get("role", "").strip()
        uses = _ROLES[child.tag].get(role)
        if uses is None:
            allowed = ", ".join(_ROLES[child.tag])
            account.add_note(child.tag, f"`{role}` is no role of a {child.tag}", child.span(file), f"it is {allowed}")
        for use in uses or ():
            node.add_port(NodlPort(use, child.tag, name, type_name, child.span(file)))
    elif child.tag == "parameter":
        known = _TYPES.get(type_name.removesuffix("[]").removesuffix("_array"))
        if (
            not name
            or len(name) > _MAX_PARAMETER_NAME
            or any(not part or part.split() != [part] for part in name.split("."))
        ):
            account.add_note("parameter", f"`{name}` is no name of a parameter", child.span(file))
        elif known is None:
            account.add_note("parameter", f"`{type_name}` is no type of a parameter", child.span(file))
        else:
            node.parameters[name] = {"type": f"{known}[]" if type_name.endswith(("[]", "_array")) else known}
            account.count("parameter")
    else:
        account.add_note(child.tag, f"`{child.tag}` is not read", child.span(file))
