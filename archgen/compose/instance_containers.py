"""Give each instance containers of its own: `containers` inside of a component become containers of the project."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.derived_names import derive_node_ids
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, change_at, find_value, list_entries


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
    reference = find_value(entry.value, "node", "container")
    if not isinstance(reference, ScalarNode):
        return
    around: str | None = component_id
    while around is not None and f"{around}.{reference.text}" not in ids:
        around = parents.get(around)
    if around is None:
        return
    name = ScalarNode(ids[f"{around}.{reference.text}"], ids[f"{around}.{reference.text}"], reference.span)
    # A body of its own: other instances share the type's.
    entry.value = change_at(entry.value, ("node", "container"), lambda _: name)
