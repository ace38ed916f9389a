"""Find components whose inputs and outputs are exchanged, and put them right, so that one slip is one finding."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.yaml_tree import YamlDocument, YamlNode

_DOTTED_PATH = re.compile(r"[a-z][a-z0-9_]*(?:\.[a-z][a-z0-9_]*)+\Z")
_TYPE_SIGN = re.compile(r"[A-Z /]")
"""What a reference never holds and nearly every type does: a capital, a blank, the slash of a message."""

_HOLDING_KEYS = frozenset({"components", "is", "same_as"})


def mend_exchanged_ports(document: YamlDocument) -> Iterator[Diagnostic]:
    """Report components whose outputs are references and whose inputs are types, and exchange the two in the tree."""
    for group in _list_entries(document.root.get("groups")):
        for component in _list_entries(_get_child(group.value, "components")):
            body = component.value
            inputs, outputs = _get_child(body, "inputs"), _get_child(body, "outputs")
            # What holds components passes on what they send: its outputs are references, and its inputs may be types.
            is_leaf = isinstance(body, MappingNode) and _HOLDING_KEYS.isdisjoint(body.entries)
            if isinstance(body, MappingNode) and is_leaf and _are_references(outputs) and _are_types(inputs):
                yield _diagnose_exchange(body, f"{group.key}.{component.key}")
                input_entry, output_entry = body.entries["inputs"], body.entries["outputs"]
                input_entry.value, output_entry.value = output_entry.value, input_entry.value


def _diagnose_exchange(component: MappingNode, component_id: str) -> Diagnostic:
    inputs, outputs = component.entries["inputs"], component.entries["outputs"]
    return Diagnostic(
        "wrong-value",
        f"the inputs and outputs of `{component_id}` look exchanged: the inputs are types, the outputs references",
        inputs.key_span,
        labels=(Label(outputs.key_span, "the references"),),
        help="exchange the two keys: an input says where it comes from, an output of what type it is",
        element=component_id,
    )


def _are_references(ports: YamlNode | None) -> bool:
    """Whether every port says where something comes from, and at least one by a dotted path."""
    has_dotted_path = False
    for port in _list_entries(ports):
        for text in _list_texts(port.value, "from"):
            # Nearly always true of the first output: it has a type, and nothing else is looked at.
            if _TYPE_SIGN.search(text):
                return False
            has_dotted_path = has_dotted_path or _DOTTED_PATH.match(text) is not None
    return has_dotted_path


def _are_types(ports: YamlNode | None) -> bool:
    """Whether every port says of what type it is, and at least one by a text that no reference can be."""
    types = [text for port in _list_entries(ports) for text in _list_texts(port.value, "type")]
    names_source = any(
        "from" in port.value.entries for port in _list_entries(ports) if isinstance(port.value, MappingNode)
    )
    return not names_source and any(map(_TYPE_SIGN.search, types)) and not any(map(_DOTTED_PATH.match, types))


def _list_texts(port: YamlNode, key: str) -> list[str]:
    """Return what a port says in short form or at a key, as a list."""
    node = port.get(key) if isinstance(port, MappingNode) else port
    items = node.items if isinstance(node, SequenceNode) else [node]
    return [item.text for item in items if isinstance(item, ScalarNode) and item.value is not None]


def _get_child(node: YamlNode, key: str) -> YamlNode | None:
    return node.get(key) if isinstance(node, MappingNode) else None


def _list_entries(node: YamlNode | None) -> list[MappingEntry]:
    return list(node) if isinstance(node, MappingNode) else []
