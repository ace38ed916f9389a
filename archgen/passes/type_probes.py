"""Make one instance of each component type, so that the linker says what follows in types that nobody uses, too."""

from __future__ import annotations

from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import PassWork
from archgen.passes.written_places import list_type_sections, name_probe_type
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode

PROBE_GROUP = "probe"


def link_types(work: PassWork) -> LinkedTree:
    """Return a project of nothing but an instance of each component type, those of libraries and abstract ones included."""
    root = work.tree.root
    instances: dict[str, MappingEntry] = {}
    for section_path in list_type_sections(work.tree):
        for entry in work.tree.get_mapping(section_path).values():
            path = (*section_path, entry.key)
            name = name_probe_type(path, entry)
            instance_id = f"t{len(instances)}"
            type_scalar = MappingEntry("is", entry.key_span, ScalarNode(name, name, entry.key_span))
            body = MappingNode({"is": type_scalar}, entry.key_span)
            instances[instance_id] = MappingEntry(instance_id, entry.key_span, body)
    sections = {
        key: MappingEntry(key, entry.key_span, _make_concrete(key, entry.value)) for key, entry in root.entries.items()
    }
    group = MappingNode(
        {"components": MappingEntry("components", root.span, MappingNode(instances, root.span))}, root.span
    )
    groups = MappingNode({PROBE_GROUP: MappingEntry(PROBE_GROUP, root.span, group)}, root.span)
    sections["groups"] = MappingEntry("groups", root.span, groups)
    return LinkedTree(work.loaded_project, MappingNode(sections, root.span), work.interfaces)


def _make_concrete(key: str, section: object) -> MappingNode:
    """Return a section in which no component type is abstract."""
    if not isinstance(section, MappingNode) or key not in {"component_types", "libraries"}:
        return section  # type: ignore[return-value]
    if key == "libraries":
        entries = {
            each.key: MappingEntry(each.key, each.key_span, _make_library_concrete(each.value)) for each in section
        }
        return MappingNode(entries, section.span)
    return MappingNode(
        {each.key: MappingEntry(each.key, each.key_span, _drop_abstract(each.value)) for each in section}, section.span
    )


def _make_library_concrete(library: object) -> MappingNode:
    if not isinstance(library, MappingNode):
        return library  # type: ignore[return-value]
    return MappingNode(
        {e.key: MappingEntry(e.key, e.key_span, _make_concrete(e.key, e.value)) for e in library}, library.span
    )


def _drop_abstract(body: object) -> MappingNode:
    if not isinstance(body, MappingNode):
        return body  # type: ignore[return-value]
    return MappingNode({each.key: each for each in body if each.key != "abstract"}, body.span)
