"""Declare the types of a loaded project, with those that ship for its distribution.

Take the types that a project uses of its libraries among its own: they are known by their own names. Load the type
mapper that ships with archgen (ros_type_mapper.yaml), for one distribution.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from archgen import resources
from archgen.compose import ExpandedProject
from archgen.diagnostics import Diagnostic, diagnose_repetition
from archgen.frozen import NamedTuple, replace
from archgen.link import mapping_values
from archgen.link.data_types.field_types import TypeSources
from archgen.link.declare.section_declaration import declare_project
from archgen.link.declare.type_declaration import DeclaredTypes, declare_types
from archgen.link.element_outline import ElementOutline
from archgen.model import quantity
from archgen.model.known_interfaces import guess_distro
from archgen.model.message_types import ConceptualType
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    list_entries,
    node_to_data,
)


def declare_project_types(
    loaded_project: LoadedProject,
    merged_table: MappingNode,
    expansion: ExpandedProject,
    outline: ElementOutline,
    damaged_elements: frozenset[str] = frozenset(),
) -> DeclaredTypes:
    """Return the project's types: in `damaged_elements` something could not be read, which may seem to be missing."""
    distro = guess_distro(loaded_project.distro)
    project_id = declare_project(merged_table, loaded_project.id, loaded_project.title).id
    library_types = add_library_types(merged_table, expansion, outline)
    sources = TypeSources(
        project_id,
        load_shipped_types(distro),
        distro,
        loaded_project.lost_keys,
        damaged_elements,
        loaded_project.partial,
        library_types.library_ids,
        list_message_packages(merged_table),
    )
    declared = declare_types(library_types.root, outline, sources)
    return replace(declared, diagnostics=(*declared.diagnostics, *library_types.diagnostics))


@cache
def load_shipped_types(distro: str | None) -> Mapping[str, ConceptualType]:
    """Return the shipped types by name, with the messages of a distribution; read once, and read-only.

    Without a distribution, and for one that an entry does not name, the entry's plain message counts.
    """
    types = dict[str, ConceptualType]()
    for name, entry in _read_entries().items():
        if distro in entry.get("without", ()):
            continue
        message = entry.get("distros", {}).get(distro, entry)["message"]
        size = quantity.parse_quantity(entry["size"], "size") if "size" in entry else None
        types[name] = ConceptualType(name, message, entry.get("comment"), size, origin="shipped")
    return MappingProxyType(types)


def _read_entries() -> dict[str, dict[str, Any]]:
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    text = resources.resource_path("ros_type_mapper.yaml").read_text(encoding="utf-8")
    types: dict[str, dict[str, Any]] = yaml.load(text, loader)["types"]  # noqa: S506  # the base loader makes only text
    return types


_NAME_BETWEEN_BRACKETS = re.compile(r"[^<>,\[\]]+")
_NAMING_KEYS = frozenset({"type", "request", "response", "feedback", "use"})
"""Keys whose scalars name types; `fields` and its like hold them by name."""
_FIELD_KEYS = frozenset({"fields", "request", "response", "feedback"})


class LibraryDataTypes(NamedTuple):
    """A project with the types that it uses of libraries, and of which library each is, by its name."""

    root: MappingNode
    library_ids: Mapping[str, str] = {}
    diagnostics: tuple[Diagnostic, ...] = ()


class _LibraryType(NamedTuple):
    library_id: str
    entry: MappingEntry


def add_library_types(root: MappingNode, expansion: ExpandedProject, outline: ElementOutline) -> LibraryDataTypes:
    """Return a merged project whose types include those that it uses of libraries. A type of its own hides theirs.

    Two libraries that say different things of a type that is used are reported; the first counts.
    """
    library_types = _list_library_types(root)
    if not library_types:
        return LibraryDataTypes(root)
    own_types = root.get("types")
    own_entries = dict(own_types.entries) if isinstance(own_types, MappingNode) else {}
    own_names = {mapping_values.normalise_type_name(name) for name in own_entries}
    diagnostics: list[Diagnostic] = []
    used_types: dict[str, _LibraryType] = {}
    pending_names = [*_list_project_names(root, expansion, outline)]
    while pending_names:
        name = pending_names.pop()
        if name in own_names or name in used_types or name not in library_types:
            continue
        first_type, *others = library_types[name]
        used_types[name] = first_type
        diagnostics += _find_differences(name, first_type, others)
        pending_names += _list_names_in(first_type.entry.value, is_field=False)
    if not used_types:
        return LibraryDataTypes(root)
    # In an order that a packed file has as well.
    entries = own_entries | {name: used_types[name].entry for name in sorted(used_types)}
    span = root.entries["types"].key_span if "types" in root.entries else root.entries["libraries"].key_span
    section = MappingEntry("types", span, MappingNode(entries, own_types.span if own_types else span))
    library_ids = {name: each.library_id for name, each in used_types.items()}
    return LibraryDataTypes(MappingNode({**root.entries, "types": section}, root.span), library_ids, tuple(diagnostics))


def list_message_packages(root: MappingNode) -> dict[str, str]:
    """Return the packages of the messages that the types of libraries define, by library."""
    return {
        library.key: mapping_values.get_text(mapping_values.get_body(library), "package") or f"{library.key}_msgs"
        for library in list_entries(root, "libraries")
    }


def _list_library_types(root: MappingNode) -> dict[str, list[_LibraryType]]:
    library_types: dict[str, list[_LibraryType]] = {}
    for library in list_entries(root, "libraries"):
        for key, entry, _ in mapping_values.iterate_elements(mapping_values.get_body(library), "types"):
            name = mapping_values.normalise_type_name(key)
            library_types.setdefault(name, []).append(_LibraryType(library.key, entry))
    return library_types


def _list_project_names(root: MappingNode, expansion: ExpandedProject, outline: ElementOutline) -> Iterator[str]:
    """Yield what may be the name of a type in a project: of ports, operations, its own types, its component types."""
    own_types = root.get("types")
    own_names = own_types.entries if isinstance(own_types, MappingNode) else ()
    # A name may bind a generic type of a library: `Envelope<Pose>: {message: ...}`.
    yield from _split_names((*outline.list_used_types(), *own_names))
    yield from _list_names_in(own_types, is_field=False)
    for body in expansion.type_bodies.values():
        yield from _list_names_in(body, is_field=False)
    for _, _, group in mapping_values.iterate_elements(expansion.root, "groups"):
        for _, _, component in mapping_values.iterate_elements(group, "components"):
            yield from _list_names_in(component.get("operations"), is_field=False)


def _list_names_in(node: YamlNode | None, *, is_field: bool) -> Iterator[str]:
    """Yield the types that a part of the language names. Some may be something else: they are no types of a library."""
    if isinstance(node, MappingNode):
        for entry in node:
            if isinstance(entry.value, ScalarNode):
                if is_field or entry.key in _NAMING_KEYS:
                    yield from _split_names([entry.value.text])
            elif entry.key != "parameters":
                yield from _list_names_in(entry.value, is_field=entry.key in _FIELD_KEYS)
    elif isinstance(node, SequenceNode):
        for item in node.items:
            yield from _list_names_in(item, is_field=False)


def _split_names(texts: Iterable[str]) -> Iterator[str]:
    """Yield the names in texts such as `Envelope<Pose>` and `Pose[3]`."""
    for text in texts:
        yield mapping_values.normalise_type_name(text)
        if not {"<", "["}.isdisjoint(text):
            yield from map(mapping_values.normalise_type_name, _NAME_BETWEEN_BRACKETS.findall(text))


def _find_differences(name: str, first: _LibraryType, others: Iterable[_LibraryType]) -> Iterator[Diagnostic]:
    for other in others:
        if node_to_data(other.entry.value) != node_to_data(first.entry.value):
            yield diagnose_repetition(
                "conflicting-values",
                f"the libraries `{first.library_id}` and `{other.library_id}` say different things of the type `{name}`",
                other.entry.key_span,
                first.entry.key_span,
                help_line="declare it in the project, below `types`, or in one library only",
                element=name,
            )
