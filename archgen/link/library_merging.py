"""Put what the files of libraries hold into a merged project, where a packed file has it."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Sequence

from archgen.diagnostics import Diagnostic
from archgen.link import mapping_values
from archgen.link.slice_merging import merge_documents
from archgen.model.architecture import Architecture
from archgen.project.library_reading import LIBRARY_SECTIONS, LoadedLibrary
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlDocument, list_entries

_WORD = re.compile(r"[a-z0-9]+")


def merge_libraries(
    root: MappingNode, libraries: tuple[LoadedLibrary, ...]
) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Return a merged project with its libraries filled in; the tree is not changed."""
    if not libraries:
        return root, ()
    diagnostics: list[Diagnostic] = []
    bodies = {library.key: library for library in list_entries(root, "libraries")}
    for library in libraries:
        entry = bodies.get(library.id)
        if entry is not None and isinstance(entry.value, MappingNode):
            content, findings = _merge_content(entry.value, library)
            diagnostics += findings
            package = _name_package(library)
            body = MappingNode({**package, **entry.value.entries, **content.entries}, entry.value.span)
            bodies[library.id] = entry.with_value(body)
    return root.change_keys({"libraries": lambda section: section.with_entries(bodies)}), tuple(diagnostics)


def _name_package(library: LoadedLibrary) -> dict[str, MappingEntry]:
    """Return the entry of the package of a library's messages, named after its folder: all of its users know that one."""
    name = "_".join(_WORD.findall(posixpath.basename(library.folder).lower()))
    if not name or not name[0].isalpha():
        return {}
    text = name if name.endswith("_msgs") else f"{name}_msgs"
    return {"package": MappingEntry("package", library.at, ScalarNode(text, text, library.at))}


def _merge_content(written: MappingNode, library: LoadedLibrary) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Return what is written at the library's path together with what its files hold."""
    sections = {name: entry for name, entry in written.entries.items() if name in LIBRARY_SECTIONS}
    own_documents = (YamlDocument("", MappingNode(sections, written.span)),) if sections else ()
    return merge_documents((*own_documents, *library.documents))


def keep_used_libraries(root: MappingNode, architectures: Sequence[Architecture]) -> MappingNode:
    """Return a merged project whose libraries hold only what it uses, also in its variants, and no paths."""

    def keep(library: MappingEntry) -> MappingEntry | None:
        body = _keep_used_types(library, architectures)
        return library.with_value(body) if body.entries else None

    def keep_section(section: MappingEntry) -> MappingEntry | None:
        kept = section.change_each(keep)
        return kept if list_entries(kept.value) else None

    return root.change_keys({"libraries": keep_section})


def _keep_used_types(library: MappingEntry, architectures: Sequence[Architecture]) -> MappingNode:
    body = mapping_values.get_body(library)
    component_types = [
        entry
        for entry in mapping_values.get_mapping(body, "component_types")
        if any(f"{library.key}.{entry.key}" in each.component_types for each in architectures)
    ]
    types = [
        entry
        for entry in mapping_values.get_mapping(body, "types")
        if any(
            (used_type := each.types.get(mapping_values.normalise_type_name(entry.key)))
            and used_type.library == library.key
            for each in architectures
        )
    ]
    used_entries = {
        name: body.entries[name].with_value(MappingNode({e.key: e for e in entries}, body.span))
        for name, entries in (("component_types", component_types), ("types", types))
        if entries
    }
    if types and "package" in body.entries:
        used_entries = {"package": body.entries["package"], **used_entries}
    return MappingNode(used_entries, body.span)
