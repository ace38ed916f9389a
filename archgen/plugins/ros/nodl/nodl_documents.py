"""NoDL 2: a document in YAML or JSON says what one node has; its name is that of the file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from archgen.plugin.importing import MappingNode, ScalarNode, SequenceNode, Span, YamlNode
from archgen.plugin.model import MAX_DIGITS
from archgen.plugins.ros.nodl.nodl_types import NodeType, NodlPort
from archgen.plugins.ros.ros_package.declared_parameters import read_declared_parameters
from archgen.plugins.ros.ros_package.import_account import ImportAccount

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
