"""Make one instance of each component type, so that the linker says what follows in types that nobody uses, too."""

from __future__ import annotations

from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import PassWork
from archgen.passes.written_places import list_type_sections, name_probe_type
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, change_at, list_entries

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
    concrete: YamlNode = root
    for path in (("component_types", "*"), ("libraries", "*", "component_types", "*")):
        concrete = change_at(concrete, path, _drop_abstract)
    sections = {entry.key: entry for entry in list_entries(concrete)}
    group = MappingNode(
        {"components": MappingEntry("components", root.span, MappingNode(instances, root.span))}, root.span
    )
    groups = MappingNode({PROBE_GROUP: MappingEntry(PROBE_GROUP, root.span, group)}, root.span)
    sections["groups"] = MappingEntry("groups", root.span, groups)
    return LinkedTree(work.loaded_project, MappingNode(sections, root.span), work.interfaces)


def _drop_abstract(body: YamlNode) -> YamlNode:
    return body.without("abstract") if isinstance(body, MappingNode) else body
