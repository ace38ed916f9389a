"""Lay what a variant writes over a merged project, as an instance is laid over its type, and take out keys.

Neither tree is changed, and what only one of them has is shared: the variants of a large project cost little.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from archgen.compose.instance_overlay import InstanceOverlay, lay_mapping, lay_node
from archgen.compose.library_types import list_type_entries
from archgen.diagnostics import Diagnostic
from archgen.language.language_tables import SECTION_KINDS
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, find_value

if TYPE_CHECKING:
    from archgen.compose.type_table import TypeTable

_JOINED_LISTS = ("requirements", "tags")
"""Lists that are added to, as by instances."""
_MAX_KEY_PARTS = 12
"""So many dots the key of an element may have where a path of keys is followed."""


def lay_changes(
    root: MappingNode, changes: MappingNode, incomplete_libraries: frozenset[str]
) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Return a merged project with what a variant writes laid over it, and what is wrong with types that it names."""
    return _ChangeLayer(root, incomplete_libraries).lay_sections(changes)


class _ChangeLayer:
    """Lays the sections of one variant; component types come first, since components are judged by them."""

    def __init__(self, root: MappingNode, incomplete_libraries: frozenset[str]) -> None:
        self._entries = dict(root.entries)
        self._span = root.span
        self._incomplete_libraries = incomplete_libraries
        self._diagnostics: list[Diagnostic] = []
        self._types: TypeTable | None = None
        self._overlay = InstanceOverlay(self._diagnostics, self._may_replace)

    def _may_replace(self, replaced: ScalarNode, replacing: ScalarNode, component_id: str) -> bool:
        if self._types is None:
            from archgen.compose.type_table import TypeTable

            root = MappingNode(self._entries, self._span)
            self._types = TypeTable(list_type_entries(root), self._diagnostics, self._incomplete_libraries)
        return self._types.may_replace(replaced, replacing, component_id)

    def lay_sections(self, changes: MappingNode) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
        for section in sorted(changes, key=lambda entry: entry.key != "component_types"):
            if section.key == "component_types" and isinstance(section.value, MappingNode):
                section = self._lay_library_types(section, section.value)  # noqa: PLW2901 - the rest of the same
            self._entries[section.key] = self._lay_section(self._entries.get(section.key), section)
        return MappingNode(self._entries, self._span), tuple(self._diagnostics)

    def _lay_library_types(self, section: MappingEntry, types: MappingNode) -> MappingEntry:
        """Lay what is written at `library.type` over the types of that library; return the section without it."""
        libraries = self._entries.get("libraries")
        if libraries is None or not isinstance(libraries.value, MappingNode):
            return section
        bodies = dict(libraries.value.entries)
        own_types = dict(types.entries)
        for entry in types:
            library_id, dot, type_id = entry.key.partition(".")
            library = bodies.get(library_id)
            library_types = find_value(library.value, "component_types") if dot and library else None
            if library is None or not isinstance(library_types, MappingNode) or type_id not in library_types.entries:
                continue
            del own_types[entry.key]
            below = library_types.entries[type_id]
            laid = MappingEntry(type_id, below.key_span, self._lay_type(below, entry.value))
            filled = MappingNode({**library_types.entries, type_id: laid}, library_types.span)
            bodies[library_id] = library.change_keys(
                {"component_types": lambda section, filled=filled: section.with_value(filled)}  # type: ignore[misc]
            )
        laid_libraries = MappingNode(bodies, libraries.value.span)
        self._entries["libraries"] = MappingEntry("libraries", libraries.key_span, laid_libraries)
        return section.with_value(MappingNode(own_types, types.span))

    def _lay_section(self, below: MappingEntry | None, section: MappingEntry) -> MappingEntry:
        if below is None or not isinstance(below.value, MappingNode) or not isinstance(section.value, MappingNode):
            return section
        if section.key == "ros":
            value = lay_node(below.value, section.value)  # its parameters are data, too
        elif section.key not in SECTION_KINDS:
            value = lay_mapping(below.value, section.value)
        else:
            elements = dict(below.value.entries)
            for entry in section.value:
                element = elements.get(entry.key)
                elements[entry.key] = entry if element is None else self._lay_element(section.key, element, entry)
            value = MappingNode(elements, below.value.span)
        return MappingEntry(section.key, below.key_span, value)

    def _lay_element(self, section: str, below: MappingEntry, entry: MappingEntry) -> MappingEntry:
        if not isinstance(below.value, MappingNode) or not isinstance(entry.value, MappingNode):
            return MappingEntry(entry.key, below.key_span, entry.value)
        match section:
            case "component_types":
                value: YamlNode = self._lay_type(below, entry.value)
            case "groups":
                value = self._lay_group(below.value, entry.value, entry.key)
            case "nodes":
                value = _join_lists(lay_node(below.value, entry.value), below.value, entry.value)
            case _:
                value = _join_lists(lay_mapping(below.value, entry.value), below.value, entry.value)
        return MappingEntry(entry.key, below.key_span, value)

    def _lay_type(self, below: MappingEntry, over: YamlNode) -> MappingNode:
        base = below.value if isinstance(below.value, MappingNode) else MappingNode({}, below.key_span)
        return (
            self._overlay.lay_over_type(base, over, below.key)
            if isinstance(over, MappingNode) and over.entries
            else base
        )

    def _lay_group(self, base: MappingNode, over: MappingNode, group_id: str) -> MappingNode:
        rest = over.without("components")
        group = _join_lists(lay_mapping(base, rest), base, rest)
        written = over.entries.get("components")
        if written is not None and isinstance(written.value, MappingNode):
            components = base.get("components")
            laid = self._overlay.lay_components(
                components if isinstance(components, MappingNode) else None, written.value, group_id
            )
            below = base.entries.get("components", written)
            group.entries["components"] = MappingEntry("components", below.key_span, laid)
        return group


def _join_lists(laid: MappingNode, base: MappingNode, over: MappingNode) -> MappingNode:
    """Give an element both its own requirements and tags and those that are laid over it."""
    for key in _JOINED_LISTS:
        below, written = base.get(key), over.entries.get(key)
        if isinstance(below, SequenceNode) and written is not None and isinstance(written.value, SequenceNode):
            items = SequenceNode([*below.items, *written.value.items], written.value.span)
            laid.entries[key] = MappingEntry(key, written.key_span, items)
    return laid


def drop_key(root: MappingNode, path: str) -> MappingNode | MissingKey:
    """Return a tree without the key at a path of keys from its top; or what is there where the path leads nowhere."""
    return _drop_parts(root, path.split("."), ())


class MissingKey:
    """A path of keys that leads nowhere: the key that is missing, what stands beside it, and the keys before it."""

    def __init__(self, word: str, known_keys: tuple[str, ...], keys_before: tuple[str, ...]) -> None:
        self.word = word
        self.known_keys = known_keys
        self.keys_before = keys_before


def _drop_parts(mapping: MappingNode, parts: list[str], keys_before: tuple[str, ...]) -> MappingNode | MissingKey:
    for key, rest in _split_key(parts):
        entry = mapping.entries.get(key)
        if entry is None:
            continue
        if not rest:
            return mapping.with_entries({e.key: e for e in mapping if e.key != key})
        if not isinstance(entry.value, MappingNode):
            return MissingKey(".".join(rest), (), (*keys_before, key))
        inner = _drop_parts(entry.value, rest, (*keys_before, key))
        if isinstance(inner, MissingKey):
            return inner
        kept = MappingEntry(key, entry.key_span, inner)
        return mapping.with_entries({**mapping.entries, key: kept})
    return MissingKey(parts[0], tuple(mapping.entries), keys_before)


def _split_key(parts: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield the first key of a path and the rest, the longest first: ids of requirements and types may have dots."""
    for length in range(min(len(parts), _MAX_KEY_PARTS), 0, -1):
        yield ".".join(parts[:length]), parts[length:]
