"""The component types of a project's libraries, by the names under which the project knows them: `common.laser2d`."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, list_entries

_TYPE_KEYS = ("is", "same_as")


def list_type_entries(root: MappingNode) -> dict[str, MappingEntry]:
    """Return the component types that a project may name, by name: its own, then those of its libraries."""
    own_types = root.get("component_types")
    entries = dict(own_types.entries) if isinstance(own_types, MappingNode) else {}
    for library in list_libraries(root):
        for entry in list_entries(library.value, "component_types"):
            name = f"{library.key}.{entry.key}"
            entries[name] = MappingEntry(name, entry.key_span, _qualify_types(entry.value, library.key))
    return entries


def list_libraries(root: MappingNode) -> Iterator[MappingEntry]:
    """Yield the libraries of a merged project."""
    libraries = root.get("libraries")
    if isinstance(libraries, MappingNode):
        yield from libraries


def library_of_type(name: str) -> str | None:
    """Return the library of a component type by its name, None for one of the project."""
    library, dot, _ = name.partition(".")
    return library if dot else None


def _qualify_keys(body: MappingNode, keys: tuple[str, ...], library: str) -> MappingNode:
    """Return a mapping with the library's id before the types that these keys name."""
    entries = dict(body.entries)
    for key in keys:
        reference = body.get(key)
        if isinstance(reference, ScalarNode) and reference.value is not None:
            text = f"{library}.{reference.text.strip()}"
            entries[key] = entries[key].with_value(ScalarNode(text, text, reference.span))
    return body.with_entries(entries)


def _qualify_types(body: YamlNode, library: str) -> YamlNode:
    """Return a type's body in which the types that it names are of the library: nothing else is known there."""
    if not isinstance(body, MappingNode):
        return body
    entries = dict(_qualify_keys(body, _TYPE_KEYS, library).entries)
    deprecated = body.get("deprecated")
    if isinstance(deprecated, MappingNode):
        entries["deprecated"] = entries["deprecated"].with_value(_qualify_keys(deprecated, ("use",), library))
    components = body.get("components")
    if isinstance(components, MappingNode):
        parts = {part.key: part.with_value(_qualify_types(part.value, library)) for part in components}
        parts_node = components.with_entries(parts)
        entries["components"] = entries["components"].with_value(parts_node)
    return body.with_entries(entries)
