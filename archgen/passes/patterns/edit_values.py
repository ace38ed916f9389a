"""What a rule writes, worked out under the bindings of a match: plain data in the language's normal form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.diagnostics import Span
from archgen.diagnostics.element_origins import TreePath
from archgen.model.generic_names import write_generic_name
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.expressions import EditKind
from archgen.passes.patterns.matching import resolve_text
from archgen.passes.patterns.pattern_shapes import (
    TYPE_KEYS,
    Anything,
    Bindings,
    Constant,
    ListPattern,
    MappingPattern,
    Pattern,
    PortReference,
    ScalarText,
    TextPattern,
    Variable,
    ViewValue,
)
from archgen.schema.short_forms import ElementForm
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode


class EditError(Exception):
    """What a rule writes cannot be written. Carries what is wrong, and what to do."""

    def __init__(self, message: str, help_line: str | None = None) -> None:
        super().__init__(message)
        self.help_line = help_line


def fill_pattern(pattern: Pattern, bindings: Bindings, key: str = "") -> ViewValue:
    """Return what a pattern is with its variables bound; None for what is left empty."""
    if isinstance(pattern, Anything):
        return None
    if isinstance(pattern, Variable):
        return bindings[pattern.name]
    if isinstance(pattern, Constant):
        # Without its place: what is made carries that of what it is made from.
        return ScalarText(pattern.text, pattern.text.value)
    if isinstance(pattern, ListPattern):
        return [fill_pattern(item, bindings, key) for item in pattern.items]
    text = resolve_text(pattern, bindings)
    if isinstance(pattern, TextPattern) and text is not None:
        return text
    if not isinstance(pattern, MappingPattern):
        raise EditError("a text is made of texts, and one of these variables stands for a list or a mapping")
    return _fill_mapping(pattern, bindings, key)


def _fill_mapping(pattern: MappingPattern, bindings: Bindings, key: str) -> ViewValue:
    entries = {fill_key(entry.key, bindings): entry.value for entry in pattern.entries}
    if key in TYPE_KEYS and len(entries) == 1:
        return _fill_term(*next(iter(entries.items())), bindings)
    return {name: fill_pattern(value, bindings, name) for name, value in entries.items()}


def fill_key(pattern: Pattern, bindings: Bindings) -> str:
    """Return the text that stands as a key."""
    text = resolve_text(pattern, bindings)
    if text is None:
        raise EditError("a key is a text, and this variable stands for a list or a mapping")
    if not text:
        raise EditError("a key is empty", "leave out in `where` what gives no text")
    return str(text)


def _fill_term(name: str, argument: Pattern, bindings: Bindings) -> str:
    """Return `Envelope<Pose>` of `{Envelope: $t}`."""
    items = argument.items if isinstance(argument, ListPattern) else (argument,)
    words = [fill_pattern(item, bindings, "type") for item in items]
    if not all(isinstance(word, str) for word in words):
        raise EditError(f"`{name}` is made of the names of types, and one of these is none")
    return write_generic_name(f"{name}<{', '.join(map(str, words))}>")


def expand_value(value: ViewValue, form: ElementForm) -> ViewValue:
    """Return what is written with its short forms written out, as a file's are."""
    if not isinstance(value, dict):
        if value is None:
            return {}
        return {key: _expand_leaf(key, value, form) for key in form.short_keys} if form.short_keys else value
    return {key: _expand_entry(key, each, form) for key, each in value.items()}


def _expand_entry(key: str, value: ViewValue, form: ElementForm) -> ViewValue:
    if key in form.part_forms and value is not None:
        return expand_value(value, form.part_forms[key])
    if key in form.keyed_forms and isinstance(value, Mapping):
        return {name: expand_value(each, form.keyed_forms[key]) for name, each in value.items()}
    return _expand_leaf(key, value, form)


def _expand_leaf(key: str, value: ViewValue, form: ElementForm) -> ViewValue:
    return [value] if key in form.list_keys and isinstance(value, str) else value


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
        raise EditError(f"`add` finds another value at `{'.'.join(map(str, path))}`", "`set` replaces it")


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
        words = value.written if _lies_inside(value, copied_from) else str(value)
        return ScalarNode(words, words, value.span or span)
    if isinstance(value, ScalarText):
        return ScalarNode(value.value, str(value), value.span or span)
    return ScalarNode(value, value or "", span)


def are_inside(sources: ViewValue, copied_from: str) -> bool:
    """Whether all sources lie inside of the component that they are copied from."""
    items = sources if isinstance(sources, list) else [sources]
    return all(_lies_inside(item, copied_from) for item in items)


def _lies_inside(item: ViewValue, copied_from: str) -> bool:
    """Whether a source lies inside of the component that it is copied from."""
    is_reference = isinstance(item, PortReference) and bool(copied_from)
    return is_reference and f"{item.holder or item.component}.".startswith(f"{copied_from}.")  # type: ignore[union-attr]


def _is_empty(node: YamlNode) -> bool:
    return isinstance(node, ScalarNode) and node.value is None


def _is_same(node: YamlNode, value: ViewValue) -> bool:
    return isinstance(node, ScalarNode) and isinstance(value, str) and node.text == value
