"""What stands in the tree as rules see it: mappings, lists and texts, and references as what they mean."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.passes.patterns.pattern_shapes import PortReference, ScalarText, ViewValue
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode

FindReference = Callable[[YamlNode], PortReference | None]
"""Returns what a reference in the tree means, None for what is no reference."""


def read_view_value(node: YamlNode, find_reference: FindReference, moves: Mapping[str, str]) -> ViewValue:
    """Return a part of the tree as rules see it; references to what stands in a type are moved to what is made from it.

    `moves` is the path of the component by that of the type.
    """
    if isinstance(node, MappingNode):
        return {entry.key: read_view_value(entry.value, find_reference, moves) for entry in node}
    if isinstance(node, SequenceNode):
        return [read_view_value(item, find_reference, moves) for item in node.items]
    reference = find_reference(node)
    if reference is None:
        return read_scalar(node)
    return _move_reference(reference, moves, node) if moves else reference


def read_scalar(node: ScalarNode) -> ScalarText | None:
    """Return a scalar as rules see it: its text, None where nothing is written."""
    if node.value is None:
        return None
    text = str(node.value).lower() if isinstance(node.value, bool) else node.text
    return ScalarText(text, node.value, node.span)


def _move_reference(reference: PortReference, moves: Mapping[str, str], node: YamlNode) -> PortReference:
    at = node if isinstance(node, ScalarNode) else None
    for type_key, key in moves.items():
        if reference.holder == type_key:
            return PortReference(key, reference.port, holder=key, at=at)
        if reference.component.startswith(f"{type_key}."):
            return PortReference(key + reference.component[len(type_key) :], reference.port, at=at)
    return reference
