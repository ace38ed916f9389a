"""What stands in the tree as rules see it: mappings, lists and texts, and references as what they mean."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.passes.patterns.pass_shapes import WRONG_PASS
from archgen.passes.patterns.pattern_shapes import PortReference, ScalarText, ViewValue
from archgen.schema.language_schema import load_schema
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, list_entries

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


VIRTUAL_KEYS = ("in", "id", "kind")
"""What a view says of a component beside the language's own keys: where it stands, its id alone, and what it is."""
_PORT_KINDS = {"inputs": ("input", "type_input"), "outputs": ("output",)}


def check_view_keys(view: MappingNode, *, is_edit: bool) -> Iterator[Diagnostic]:
    """Yield what is no key of the language where a rule looks for it, or writes it."""
    for component in list_entries(view, "components"):
        for entry in list_entries(component.value):
            yield from _check_component_key(entry, is_edit=is_edit)
    for named_type in list_entries(view, "types"):
        for entry in list_entries(named_type.value):
            yield from _check_key(entry, _list_keys("type"), "a type")


def _check_component_key(entry: MappingEntry, *, is_edit: bool) -> Iterator[Diagnostic]:
    if entry.key == "components":
        help_line = "what stands inside has a path of its own: `$inner: {in: $outer}`"
        yield _diagnose_word("components do not stand inside of one another here", entry.key_span, help_line)
    elif is_edit and entry.key in {"in", "id"}:
        help_line = "a new component stands where its path says: `$outer.name`"
        yield _diagnose_word(f"`{entry.key}` follows from the path, and is not written", entry.key_span, help_line)
    else:
        yield from _check_key(
            entry, _list_keys("component", "component_type", "group", extra=VIRTUAL_KEYS), "a component"
        )
    kinds = _PORT_KINDS.get(entry.key)
    for port in list_entries(entry.value) if kinds else ():
        for inner in list_entries(port.value):
            yield from _check_key(inner, _list_keys(*(kinds or ())), f"an {(kinds or ('',))[0]}")


def _check_key(entry: MappingEntry, known_keys: tuple[str, ...], subject: str) -> Iterator[Diagnostic]:
    if "$" not in entry.key and entry.key not in known_keys:
        help_line = did_you_mean(entry.key, known_keys)
        yield _diagnose_word(f"`{entry.key}` is no key of {subject}", entry.key_span, help_line)


@functools.cache
def _list_keys(*kinds: str, extra: tuple[str, ...] = ()) -> tuple[str, ...]:
    definitions = load_schema()["$defs"]
    keys = {key: None for kind in kinds for key in definitions[kind]["properties"] if key != "components"}
    return (*keys, *extra)


def _diagnose_word(message: str, span: Span, help_line: str | None) -> Diagnostic:
    return Diagnostic(WRONG_PASS, message, span, help=help_line)
