"""What a variant takes out with the components and nodes that it selects: what then serves nobody goes too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.frozen import dataclass
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


@dataclass(frozen=True, slots=True)
class RemovedElements:
    """What is not there in a variant: components (composed ones too), nodes and groups by complete ids."""

    components: frozenset[str]
    nodes: frozenset[str]
    groups: frozenset[str]
    words: frozenset[str]
    """Every part of a path that may lead to one of them or to its ports: a reference without any means none of them."""

    def may_be_named(self, path: str) -> bool:
        """Whether a reference may name something that is not there."""
        return not self.words.isdisjoint(path.split("."))


def find_removed(outline: ElementOutline, leaves: frozenset[str], nodes: frozenset[str]) -> RemovedElements:
    """Return what goes with some leaves and nodes: composed components and groups of which nothing is left."""
    components = {leaf for leaf in leaves if leaf in outline.components}
    for shell in reversed(list(outline.shells.values())):  # inner ones first
        if shell.children and components.issuperset(shell.children):
            components.add(shell.id)
    groups = {group_id for group_id, members in outline.members.items() if members and components.issuperset(members)}
    words = {word for component_id in components for word in component_id.split(".")[1:]}
    words.update(name for component_id in sorted(components) for name in outline.outputs[component_id])
    return RemovedElements(frozenset(components), nodes, frozenset(groups), frozenset(words | groups))


def find_idle_places(
    root: MappingNode, kept_nodes: MappingNode, outline: ElementOutline, removed_components: frozenset[str]
) -> tuple[frozenset[str], frozenset[str]]:
    """Return the containers and the hosts in which something ran, and in which nothing runs any more."""
    written_nodes = mapping_values.get_mapping(root, "nodes")
    entries = {**outline.components, **{shell.id: shell.entry for shell in outline.shells.values()}}
    kept_entries = [entry for component_id, entry in entries.items() if component_id not in removed_components]
    containers = mapping_values.get_mapping(root, "containers")
    was_used = set(_list_places("container", written_nodes, entries.values()))
    is_used = set(_list_places("container", kept_nodes, kept_entries))
    idle_containers = frozenset(was_used - is_used) & containers.entries.keys()
    kept_containers = [entry for entry in containers if entry.key not in idle_containers]
    hosts_before = {*_list_places("host", written_nodes, entries.values()), *_list_hosts(containers)}
    hosts_after = {*_list_places("host", kept_nodes, kept_entries), *_list_hosts(kept_containers)}
    known_hosts = mapping_values.get_mapping(root, "hosts").entries.keys()
    return idle_containers, frozenset(hosts_before - hosts_after) & known_hosts


def _list_places(key: str, nodes: MappingNode, components: Iterable[MappingEntry]) -> Iterator[str]:
    """Yield the hosts or containers that nodes name, and the nodes of components."""
    bodies = [mapping_values.get_body(entry) for entry in nodes]
    bodies += [mapping_values.get_mapping(mapping_values.get_body(entry), "node") for entry in components]
    return (text for body in bodies if (text := mapping_values.get_text(body, key)) is not None)


def _list_hosts(containers: Iterable[MappingEntry]) -> Iterator[str]:
    hosts = (mapping_values.get_text(mapping_values.get_body(entry), "host") for entry in containers)
    return (host for host in hosts if host is not None)
