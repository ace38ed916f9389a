"""`archgen import nodl`: component types from files of the Node Definition Language, version 1 (XML) and 2 (YAML, JSON)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    MappingNode,
    ScalarNode,
    Span,
    XmlElement,
    make_id,
    make_unique_id,
    parse_xml,
    parse_yaml,
    read_bounded,
)
from archgen.plugins.ros.nodl.nodl_documents import read_nodl_document
from archgen.plugins.ros.nodl.nodl_types import NodeType, NodlPort
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_MAX_BYTES = 4_000_000
_ENDINGS = re.compile(r"(?:\.nodl)?\.(?:ya?ml|json|xml)\Z", re.IGNORECASE)


def read_nodl(files: Sequence[Path]) -> ForeignImport:
    """Read files of NoDL. Raise ForeignFileError."""
    account = ImportAccount()
    component_types: dict[str, Any] = {}
    for file in files:
        for name, node in _read_file(file, account):
            type_id = make_unique_id(make_id(name, "node"), component_types.keys())
            component_types[type_id] = node.write()
            account.count("node")
    slices = {"nodl_types.yaml": {"component_types": component_types}} if component_types else {}
    return ForeignImport(slices, dict(sorted((+account.taken).items())), tuple(account.notes))


def _read_file(file: Path, account: ImportAccount) -> Iterator[tuple[str, NodeType]]:
    data = read_bounded(file, _MAX_BYTES)
    if data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        root = parse_xml(str(file), data)
        if root.tag != "interface":
            words = f"its outermost element is `{root.tag}`"
            raise ForeignFileError(words, root.span(str(file)), "NoDL 1 begins with `<interface>`")
        yield from read_interface(root, str(file), account)
        return
    name = _ENDINGS.sub("", file.name)
    yield name, read_nodl_document(_parse_document(file, data), account)


def _parse_document(file: Path, data: bytes) -> MappingNode:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        words = "it is no text in UTF-8"
        raise ForeignFileError(words, Span.of_file(str(file)), "save it in UTF-8") from None
    document, problems = parse_yaml(str(file), text)
    root = document.root if document else None
    if problems or not isinstance(root, MappingNode):
        first = problems[0] if problems else None
        message = first.message if first else "it holds no mapping"
        raise ForeignFileError(message, first.span if first else Span.of_file(str(file)), "NoDL 2 is YAML or JSON")
    version = root.get("nodl_version")
    if not isinstance(version, ScalarNode) or version.text != "2":
        span = version.span if version else Span.of_file(str(file))
        words = "it has no `nodl_version: 2`"
        raise ForeignFileError(words, span, "is it a file of NoDL?")
    return root


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
