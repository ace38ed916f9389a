"""Write plain data into a tree, and take it out: mappings key by key, lists item by item."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.diagnostics.element_origins import TreePath
from archgen.diagnostics.source_span import Span
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.edit_values import EditError
from archgen.passes.patterns.pass_shapes import EditKind
from archgen.passes.patterns.pattern_shapes import PortReference, ScalarText, ViewValue
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode


def merge_data(view: ArchitectureView, kind: EditKind, path: TreePath, value: ViewValue, source: TreePath) -> None:
    """Write plain data over what stands at a path."""
    present = view.tree.get(path)
    span = view.tree.find_place(source)
    if isinstance(value, dict) and value and isinstance(present, MappingNode):
        for name, each in value.items():
            merge_data(view, kind, (*path, name), each, source)
    elif kind == "add" and isinstance(value, list) and isinstance(present, SequenceNode):
        for item in value:
            view.tree.append(path, make_data_node(item, span), source)
    elif kind == "set" or present is None or _is_empty(present):
        view.tree.set(path, make_data_node(value, span), source)
    elif not _is_same(present, value) and not (isinstance(value, dict) and not value):
        message = f"`add` finds another value at `{'.'.join(map(str, path))}`"
        raise EditError(message, "`set` replaces it")


def drop_data(view: ArchitectureView, path: TreePath, value: ViewValue) -> None:
    """Take a leaf, a key or items of a list out of plain data."""
    present = view.tree.get(path)
    if value is None or (isinstance(present, ScalarNode) and value == present.text):
        view.tree.drop(path)
    elif isinstance(value, dict) and isinstance(present, MappingNode):
        for name, each in value.items():
            drop_data(view, (*path, name), each)
    elif isinstance(value, list) and isinstance(present, SequenceNode):
        _drop_items(view, path, present, [str(item) for item in value if isinstance(item, str)])


def _drop_items(view: ArchitectureView, path: TreePath, sequence: SequenceNode, texts: Sequence[str]) -> None:
    for number in range(len(sequence.items) - 1, -1, -1):
        item = sequence.items[number]
        if isinstance(item, ScalarNode) and (view.find_reference(item) or item.text) in texts:
            view.tree.drop((*path, number))
    if not sequence.items:
        view.tree.drop(path)


def make_data_node(value: ViewValue, span: Span, copied_from: str = "") -> YamlNode:
    """Return plain data as a tree. What a copy names inside of itself is written as it was."""
    if isinstance(value, dict):
        entries = {key: MappingEntry(key, span, make_data_node(each, span, copied_from)) for key, each in value.items()}
        return MappingNode(entries, span)
    if isinstance(value, list):
        return SequenceNode([make_data_node(item, span, copied_from) for item in value], span)
    if isinstance(value, PortReference):
        words = value.written if lies_inside(value, copied_from) else str(value)
        return ScalarNode(words, words, value.span or span)
    if isinstance(value, ScalarText):
        return ScalarNode(value.value, str(value), value.span or span)
    return ScalarNode(value, value or "", span)


def are_inside(sources: ViewValue, copied_from: str) -> bool:
    """Whether all sources lie inside of the component that they are copied from."""
    items = sources if isinstance(sources, list) else [sources]
    return all(lies_inside(item, copied_from) for item in items)


def lies_inside(item: ViewValue, copied_from: str) -> bool:
    """Whether a source lies inside of the component that it is copied from."""
    is_reference = isinstance(item, PortReference) and bool(copied_from)
    return is_reference and f"{item.holder or item.component}.".startswith(f"{copied_from}.")  # type: ignore[union-attr]


def _is_empty(node: YamlNode) -> bool:
    return isinstance(node, ScalarNode) and node.value is None


def _is_same(node: YamlNode, value: ViewValue) -> bool:
    return isinstance(node, ScalarNode) and isinstance(value, str) and node.text == value
