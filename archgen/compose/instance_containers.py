"""Give each instance containers of its own: `containers` inside of a component become containers of the project."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.derived_names import derive_node_ids
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, list_entries


def make_instance_containers(
    root: MappingNode, bodies: Mapping[str, MappingEntry], parents: Mapping[str, str]
) -> tuple[dict[str, MappingEntry], dict[str, str]]:
    """Return the containers to add to a project, and who brings them along, by id; name them in the bodies of components.

    `bodies` are the entries of all components by complete id; those whose node names a container inside of what is
    around it get a body of their own.
    """
    entries_by_path = dict(_list_containers(bodies))
    if not entries_by_path:
        return {}, {}
    written = root.get("containers")
    used_ids = written.entries if isinstance(written, MappingNode) else {}
    ids = derive_node_ids(entries_by_path, entries_by_path, used_ids)
    for component_id, entry in bodies.items():
        _name_container(component_id, entry, ids, parents)
    containers = {
        ids[path]: MappingEntry(ids[path], each.key_span, each.value) for path, each in entries_by_path.items()
    }
    return containers, {ids[path]: path.rpartition(".")[0] for path in entries_by_path}


def _list_containers(bodies: Mapping[str, MappingEntry]) -> Iterator[tuple[str, MappingEntry]]:
    for component_id, entry in bodies.items():
        for container in list_entries(entry.value, "containers"):
            yield f"{component_id}.{container.key}", container


def _name_container(component_id: str, entry: MappingEntry, ids: Mapping[str, str], parents: Mapping[str, str]) -> None:
    node = entry.value.entries.get("node") if isinstance(entry.value, MappingNode) else None
    reference = node.value.entries.get("container") if node and isinstance(node.value, MappingNode) else None
    if node is None or reference is None or not isinstance(reference.value, ScalarNode):
        return
    around: str | None = component_id
    while around is not None and f"{around}.{reference.value.text}" not in ids:
        around = parents.get(around)
    if around is None or not isinstance(node.value, MappingNode) or not isinstance(entry.value, MappingNode):
        return
    name = ids[f"{around}.{reference.value.text}"]
    named = MappingEntry("container", reference.key_span, ScalarNode(name, name, reference.value.span))
    own_node = MappingNode({**node.value.entries, "container": named}, node.value.span)
    # A body of its own: other instances share the type's.
    entry.value = MappingNode(
        {**entry.value.entries, "node": MappingEntry("node", node.key_span, own_node)}, entry.value.span
    )
