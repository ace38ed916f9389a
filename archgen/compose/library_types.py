"""The component types of a project's libraries, by the names under which the project knows them: `common.laser2d`."""

from __future__ import annotations

from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, list_entries

_REFERENCE_KEYS = ("is", "same_as")


class LibraryWord(str):
    """What a library says of its own program alone: its `status`."""

    __slots__ = ()


def list_type_entries(root: MappingNode) -> dict[str, MappingEntry]:
    """Return the component types that a project may name, by name: its own, then those of its libraries."""
    own_types = root.get("component_types")
    entries = dict(own_types.entries) if isinstance(own_types, MappingNode) else {}
    for library in list_entries(root, "libraries"):
        for entry in list_entries(library.value, "component_types"):
            name = f"{library.key}.{entry.key}"
            entries[name] = MappingEntry(name, entry.key_span, _qualify_type(entry, library.key).value)
    return entries


def library_of_type(name: str) -> str | None:
    """Return the library of a component type by its name, None for one of the project."""
    library, dot, _ = name.partition(".")
    return library if dot else None


def _qualify_type(entry: MappingEntry, library: str) -> MappingEntry:
    """Return a type, or a component in one, in which the types that it names are of the library: it knows nothing else."""

    def qualify(reference: MappingEntry) -> MappingEntry:
        if not isinstance(reference.value, ScalarNode) or reference.value.value is None:
            return reference
        text = f"{library}.{reference.value.text.strip()}"
        return reference.with_value(ScalarNode(text, text, reference.value.span))

    def mark(status: MappingEntry) -> MappingEntry:
        value = status.value
        if not isinstance(value, ScalarNode):
            return status
        return status.with_value(ScalarNode(value.value, LibraryWord(value.text), value.span, value.is_plain))

    return entry.change_keys(
        {
            **dict.fromkeys(_REFERENCE_KEYS, qualify),
            "status": mark,
            "node": lambda node: node.change_keys({"status": mark}),
            "deprecated": lambda deprecated: deprecated.change_keys({"use": qualify}),
            "components": lambda parts: parts.change_each(lambda part: _qualify_type(part, library)),
        }
    )
