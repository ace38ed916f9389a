"""What stands in the tree as rules see it: mappings, lists and texts, and references as what they mean."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.language.language_tables import SECTION_KINDS
from archgen.link.mapping_values import list_scalars
from archgen.passes.patterns.expressions import diagnose_pass
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


VIRTUAL_KEYS = ("in", "id", "kind", "host")
"""What a view says of a component beside the language's own keys: where it stands, its id alone, what it is, where it runs."""
FACT_KEYS = ("nodes", "hosts", "containers", "links", "topics", "connections")
"""Sections that are known once a project is linked."""
VIEW_KEYS = ("components", "types", *FACT_KEYS)
"""The sections that rules see."""
_DERIVED_KEYS = {
    "topics": ("flow", "messages", "types", "publishers", "subscribers", "servers", "clients"),
    "connections": ("from", "to", "type", "crosses"),
}
_CROSSED = ("host", "partner", "process")
_DERIVED_HELP = {
    "topics": "a topic is named at a node: `publishes: {$port: {topic: ...}}`",
    "connections": "a connection is written at its reader: `inputs: {$input: {from: [$source.$port]}}`",
}
_PORT_KINDS = {"inputs": ("input", "type_input"), "outputs": ("output",)}


def check_view_keys(view: MappingNode, *, is_edit: bool) -> Iterator[Diagnostic]:
    """Yield what is no key of the language where a rule looks for it, or writes it."""
    for component in list_entries(view, "components"):
        for entry in list_entries(component.value):
            yield from _check_component_key(entry, is_edit=is_edit)
    for section in VIEW_KEYS[1:]:
        keys = _DERIVED_KEYS.get(section) or _list_keys(SECTION_KINDS[section])
        for element in list_entries(view, section):
            if is_edit and section in _DERIVED_KEYS:
                message = f"{name_element(section)} follows from what is connected, and is not written"
                yield diagnose_pass(message, element.key_span, _DERIVED_HELP[section])
            for entry in list_entries(element.value):
                yield from _check_key(entry, keys, name_element(section))
                yield from _check_crossed(entry)


def name_element(section: str) -> str:
    """Return what one of those that stand in a section is called: `a node`."""
    return f"a {section.removesuffix('s')}"


def _check_crossed(entry: MappingEntry) -> Iterator[Diagnostic]:
    for word in list_scalars(entry.value) if entry.key == "crosses" else ():
        if "$" not in word.text and word.text not in _CROSSED:
            help_line = did_you_mean(word.text, _CROSSED) or "a connection crosses `host`, `partner` or `process`"
            yield diagnose_pass(f"`{word.text}` is nothing that a connection crosses", word.span, help_line)


def list_crossed_words(section: str, element: YamlNode) -> YamlNode:
    """Return an element of a section as it is looked for: `crosses: host` of a connection is one item of a list."""
    crossed = element.entries.get("crosses") if section == "connections" and isinstance(element, MappingNode) else None
    if crossed is None or not isinstance(crossed.value, ScalarNode) or not isinstance(element, MappingNode):
        return element
    listed = crossed.with_value(SequenceNode([crossed.value], crossed.value.span))
    return MappingNode({**element.entries, "crosses": listed}, element.span)


def _check_component_key(entry: MappingEntry, *, is_edit: bool) -> Iterator[Diagnostic]:
    if entry.key == "components":
        help_line = "what stands inside has a path of its own: `$inner: {in: $outer}`"
        yield diagnose_pass("components do not stand inside of one another here", entry.key_span, help_line)
    elif is_edit and entry.key in {"in", "id"}:
        help_line = "a new component stands where its path says: `$outer.name`"
        yield diagnose_pass(f"`{entry.key}` follows from the path, and is not written", entry.key_span, help_line)
    else:
        yield from _check_key(
            entry, _list_keys("component", "component_type", "group", extra=VIRTUAL_KEYS), "a component"
        )
    for host in (each for each in list_entries(entry.value) if entry.key == "node" and each.key == "host"):
        if not is_edit:
            message = "`host` below `node` is only what stands at the component itself, and not where it runs"
            yield diagnose_pass(message, host.key_span, "`host` of the component holds wherever it is written")
    kinds = _PORT_KINDS.get(entry.key)
    for port in list_entries(entry.value) if kinds else ():
        for inner in list_entries(port.value):
            yield from _check_key(inner, _list_keys(*(kinds or ())), f"an {(kinds or ('',))[0]}")


def _check_key(entry: MappingEntry, known_keys: tuple[str, ...], subject: str) -> Iterator[Diagnostic]:
    if "$" not in entry.key and entry.key not in known_keys:
        help_line = did_you_mean(entry.key, known_keys)
        yield diagnose_pass(f"`{entry.key}` is no key of {subject}", entry.key_span, help_line)


@functools.cache
def _list_keys(*kinds: str, extra: tuple[str, ...] = ()) -> tuple[str, ...]:
    definitions = load_schema()["$defs"]
    keys = {key: None for kind in kinds for key in definitions[kind]["properties"] if key != "components"}
    return (*keys, *extra)
