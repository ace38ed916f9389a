"""`archgen import nodl`: component types from files of the Node Definition Language, version 1 (XML) and 2 (YAML, JSON).

NoDL 2: a document in YAML or JSON says what one node has; its name is that of the file. What a node is in NoDL, of
either version, and the component type that it becomes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    MappingNode,
    ScalarNode,
    SequenceNode,
    Span,
    XmlElement,
    YamlNode,
    make_id,
    make_unique_id,
    parse_xml,
    parse_yaml,
    read_bounded,
)
from archgen.plugin.model import MAX_DIGITS, is_parameter_name
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_import import read_declared_parameters

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
        raise ForeignFileError("it is no text in UTF-8", Span.of_file(str(file)), "save it in UTF-8") from None
    document, problems = parse_yaml(str(file), text)
    root = document.root if document else None
    if problems or not isinstance(root, MappingNode):
        first = problems[0] if problems else None
        message = first.message if first else "it holds no mapping"
        raise ForeignFileError(message, first.span if first else Span.of_file(str(file)), "NoDL 2 is YAML or JSON")
    version = root.get("nodl_version")
    if not isinstance(version, ScalarNode) or version.text != "2":
        span = version.span if version else Span.of_file(str(file))
        raise ForeignFileError("it has no `nodl_version: 2`", span, "is it a file of NoDL?")
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
        if not is_parameter_name(name):
            account.add_note("parameter", f"`{name}` is no name of a parameter", child.span(file))
        elif known is None:
            account.add_note("parameter", f"`{type_name}` is no type of a parameter", child.span(file))
        else:
            node.parameters[name] = {"type": f"{known}[]" if type_name.endswith(("[]", "_array")) else known}
            account.count("parameter")
    else:
        account.add_note(child.tag, f"`{child.tag}` is not read", child.span(file))


_SECTIONS = {
    "publishers": ("publishes", "topic"),
    "subscriptions": ("subscribes", "topic"),
    "service_servers": ("serves", "service"),
    "service_clients": ("calls", "service"),
    "action_servers": ("serves", "action"),
    "action_clients": ("calls", "action"),
}
_READ = frozenset({"nodl_version", "description", "parameters", *_SECTIONS})
_QOS_WORDS = {
    "history": {"KEEP_LAST": "keep_last", "KEEP_ALL": "keep_all"},
    "reliability": {"RELIABLE": "reliable", "BEST_EFFORT": "best_effort"},
    "durability": {"VOLATILE": "volatile", "TRANSIENT_LOCAL": "transient_local"},
    "liveliness": {"AUTOMATIC": "automatic", "MANUAL_BY_TOPIC": "manual_by_topic"},
}
_OPEN_CHOICES = frozenset({"SYSTEM_DEFAULT", "BEST_AVAILABLE"})
_QOS_TIMES = {"deadline_ns": "deadline", "lifespan_ns": "lifespan", "liveliness_lease_duration_ns": "lease_duration"}
_MAX_DEPTH = 2**31


def read_nodl_document(root: MappingNode, account: ImportAccount) -> NodeType:
    """Return what a document says of its node."""
    node = NodeType(account)
    for entry in root:
        if entry.key not in _READ:
            words = f"what stands below `{entry.key}` is not read"
            help_line = "give the files that it names as well" if entry.key == "include" else ""
            account.add_note(entry.key, words, entry.key_span, help_line)
    description = root.get("description")
    if isinstance(description, ScalarNode) and description.text.strip():
        node.words["description"] = description.text.strip()
    parameters = root.get("parameters")
    if isinstance(parameters, MappingNode):
        node.parameters, node.open = read_declared_parameters(parameters, account)
        account.count("parameter", len(node.parameters))
    for section, (use, kind) in _SECTIONS.items():
        for item in _list_items(root.get(section), section, account):
            _read_endpoint(node, item, use, kind, account)
    return node


def _list_items(node: YamlNode | None, section: str, account: ImportAccount) -> Iterator[MappingNode]:
    if node is None:
        return
    if not isinstance(node, SequenceNode):
        account.add_note(section, f"`{section}` is no list", node.span)
        return
    for item in node.items:
        if isinstance(item, MappingNode):
            yield item
        else:
            account.add_note(section, f"an entry of `{section}` is a mapping with `name` and `type`", item.span)


def _read_endpoint(node: NodeType, item: MappingNode, use: str, kind: str, account: ImportAccount) -> None:
    further: dict[str, Any] = {}
    if description := _read_text(item, "description"):
        further["description"] = description
    qos = item.get("qos")
    if isinstance(qos, MappingNode):
        if kind == "topic":
            further |= _read_qos(qos, account)
        else:
            account.add_note("qos", f"the quality of service of a {kind} has no place here", qos.span)
    node.add_port(NodlPort(use, kind, _read_text(item, "name"), _read_text(item, "type"), item.span), further)


def _read_text(item: MappingNode, key: str) -> str:
    value = item.get(key)
    return value.text.strip() if isinstance(value, ScalarNode) else ""


def _read_qos(qos: MappingNode, account: ImportAccount) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for entry in qos:
        text = entry.value.text if isinstance(entry.value, ScalarNode) else ""
        if entry.key in _QOS_WORDS and text in _QOS_WORDS[entry.key]:
            found[entry.key] = _QOS_WORDS[entry.key][text]
        elif entry.key in _QOS_WORDS and text in _OPEN_CHOICES:
            words = f"`{entry.key}: {text}` leaves the choice to the middleware: it is not written"
            account.add_note("qos", words, entry.value.span, fate="noted")
        elif entry.key == "depth" and text.isdecimal() and len(text) <= MAX_DIGITS and 0 < int(text) < _MAX_DEPTH:
            found["depth"] = int(text)
        elif entry.key in _QOS_TIMES and text.isdecimal() and len(text) <= MAX_DIGITS:
            # Zero is no limit.
            found |= {_QOS_TIMES[entry.key]: f"{int(text)} ns"} if int(text) else {}
        else:
            account.add_note("qos", f"`{entry.key}` is not read", _find_span(entry.value, entry.key_span))
    return {"qos": found} if found else {}


def _find_span(node: YamlNode | None, span: Span) -> Span:
    return node.span if node is not None else span


_TYPE = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/(?:(msg|srv|action)/)?([A-Z][A-Za-z0-9_]*)\Z")
_MAX_TYPE_LENGTH = 200
_NAME = re.compile(r"[A-Za-z]\Z|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]\Z")


class NodlPort(NamedTuple):
    """What a node has, as written: `use` is `publishes`, ...; `kind` is `topic`, `service` or `action`."""

    use: str
    kind: str
    name: str
    type_name: str
    span: Span


class NodeType:
    """The component type that a node becomes, as it grows."""

    def __init__(self, account: ImportAccount) -> None:
        """Tell the account what is taken, and what is not."""
        self._account = account
        self.words: dict[str, Any] = {}
        """What is said of the whole: its description."""
        self.node: dict[str, Any] = {}
        self.parameters: dict[str, Any] = {}
        self.open: list[str] = []
        self._ports: dict[str, dict[str, Any]] = {"inputs": {}, "outputs": {}}
        self._uses: dict[str, dict[str, Any]] = {}

    def add_port(self, port: NodlPort, further: dict[str, Any] | None = None) -> None:
        """Add what a node publishes, subscribes to, serves or calls, with what else is said of it."""
        use, kind, name, type_name, span = port
        message = _read_type(type_name, {"topic": "msg", "service": "srv", "action": "action"}[kind])
        if not _NAME.match(name) or "//" in name:
            self._account.add_note(kind, f"`{name}` is no name of a {kind}", span, "letters, digits, `_` and `/`")
            return
        if message is None:
            words = f"`{type_name}` of `{name}` is no type of a {kind}"
            self._account.add_note(kind, words, span, "it is `package/kind/Name`, such as `std_msgs/msg/String`")
            return
        side = "outputs" if use in {"publishes", "serves"} else "inputs"
        further = dict(further or {})
        description = further.pop("description", "")
        port_id = make_unique_id(make_id(name.strip("/~").replace("/", "_"), kind), self._ports[side].keys())
        self._ports[side][port_id] = {"type": message, "description": description} if description else message
        key = "topic" if kind == "topic" else "name"
        self._uses.setdefault(use, {})[port_id] = {key: name, **further} if further else name
        self._account.count(kind)

    def write(self) -> dict[str, Any]:
        """Return the component type."""
        body = {**self.words, **self._ports}
        if self.parameters:
            body["parameters"] = self.parameters
        if self.open:
            body["open"] = self.open
        node = {**self.node, **self._uses}
        return {**body, "node": node} if node else body


def _read_type(text: str, kind: str) -> str | None:
    match = _TYPE.match(text)
    if match is None or (match[2] or kind) != kind:
        return None
    name = f"{match[1]}/{kind}/{match[3]}"
    return name if len(name) <= _MAX_TYPE_LENGTH else None
