"""Declare the variants as they are written; `link/variants` says how the project stands in them."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.link import mapping_values
from archgen.link.value_readers import read_element
from archgen.model.variant import BASE_NAME, Variant, WrittenChange
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode


def declare_variants(root: MappingNode) -> dict[str, Variant]:
    """Declare the variants, except one that takes the name of the project itself, which is reported."""
    return {
        name: Variant(
            **read_element("variant", Variant, entry, body),
            changes=tuple(_list_changes(mapping_values.get_mapping(body, "changes"), "")),
        )
        for name, entry, body in mapping_values.iterate_elements(root, "variants")
        if name != BASE_NAME
    }


def _list_changes(node: YamlNode, path: str) -> Iterator[WrittenChange]:
    """Yield what stands below a node, leaf by leaf; lists are leaves, and so is what is known to be empty."""
    if isinstance(node, MappingNode) and node.entries:
        for entry in node:
            yield from _list_changes(entry.value, f"{path}.{entry.key}" if path else entry.key)
    elif path:
        yield WrittenChange(path, _write_leaf(node))


def _write_leaf(node: YamlNode) -> str:
    if isinstance(node, ScalarNode):
        return node.text
    if isinstance(node, MappingNode):
        return "{" + ", ".join(f"{entry.key}: {_write_leaf(entry.value)}" for entry in node) + "}"
    return "[" + ", ".join(_write_leaf(item) for item in node.items) + "]"
