"""Take components and nodes out of a merged project, with all that then serves nobody, and the references to them.

What a component type brings along cannot be taken out of an instance by itself: such an instance is written out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.compose import ExpandedProject
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline, build_outline
from archgen.link.inner_names import find_inner_component
from archgen.link.link_memory import LinkMemory
from archgen.link.project_linking import make_resolver
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.source_references import SOURCE_KINDS, SourceReferences
from archgen.link.variants.variant_selectors import RemovedElements, find_idle_places, find_removed
from archgen.model.architecture import Architecture
from archgen.model.path_resolver import ElementRef
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

_HOLDING_KEYS = frozenset({"from", "node", "components"})
_TYPE_KEYS = frozenset({"is", "same_as"})
_USE_KEYS = ("publishes", "subscribes", "serves", "calls")
_START_REFERENCES = frozenset({"after", "by"})
_LEAST_ENDS = 2
"""A link between fewer ends joins nothing."""


class ElementRemover:
    """Takes elements out of one merged project; `removed` says afterwards which."""

    def __init__(
        self,
        expansion: ExpandedProject,
        leaves: frozenset[str],
        nodes: frozenset[str],
        memory: LinkMemory | None = None,
        architecture: Architecture | None = None,
    ) -> None:
        """Take the project with all types written out, and the leaves and nodes that go by complete ids.

        `architecture` is its architecture, where that is known.
        """
        self._outline: ElementOutline = build_outline(expansion, memory)
        self._expansion = expansion
        self.removed: RemovedElements = find_removed(self._outline, leaves, nodes)
        self._resolver: ReferenceResolver = make_resolver(expansion.root, self._outline, [], memory=memory)
        self._sources = SourceReferences(self._outline, self._resolver) if self._outline.expansion else None
        self._changed_shells = self._list_changed_shells()
        self._untouched = self._list_untouched(architecture) if architecture and expansion.is_plain else frozenset()
        self._gone_nodes: frozenset[str] = frozenset()

    def _list_untouched(self, architecture: Architecture) -> frozenset[str]:
        """Return the components that read nothing of what goes."""
        if self._outline.undeclared_inputs:  # what they read is in no architecture
            return frozenset()
        touched = {
            each.input.rpartition(".")[0]
            for each in architecture.connections
            if self._is_removed(ElementRef(each.kind, each.target))
        }
        return frozenset(self._outline.components.keys() - touched)

    def _list_changed_shells(self) -> frozenset[str]:
        """Return the composed components that stay, and in which something goes."""
        changed: set[str] = set()
        for component_id in self.removed.components:
            parent = self._expansion.parents.get(component_id)
            while parent is not None and parent not in changed:
                changed.add(parent)
                parent = self._expansion.parents.get(parent)
        return frozenset(changed)

    def remove_from(self, root: MappingNode) -> MappingNode:
        """Return the merged project, as it was before types were written out, without what goes."""
        entries = dict(root.entries)
        # First: what components say of the start-up names nodes, too.
        nodes = self._prune_nodes(mapping_values.get_mapping(root, "nodes"))
        if "groups" in entries:
            entries["groups"] = self._prune_groups(entries["groups"])
        containers, hosts = find_idle_places(root, nodes, self._outline, self.removed.components)
        if "nodes" in entries:
            entries["nodes"] = entries["nodes"].with_value(nodes)
        _keep_entries(entries, "containers", lambda entry: entry.key not in containers)
        _keep_entries(entries, "hosts", lambda entry: entry.key not in hosts)
        _keep_entries(
            entries,
            "resources",
            lambda entry: mapping_values.get_text(mapping_values.get_body(entry), "host") not in hosts,
        )
        if "links" in entries:
            entries["links"] = self._prune_links(entries["links"], hosts)
        return root.with_entries(entries)

    def _prune_groups(self, section: MappingEntry) -> MappingEntry:
        groups = {
            group.key: self._prune_group(group)
            for group in mapping_values.get_body(section)
            if group.key not in self.removed.groups
        }
        return section.with_entries(groups)

    def _prune_group(self, group: MappingEntry) -> MappingEntry:
        body = mapping_values.get_body(group)
        if "components" not in body.entries:
            return group
        parts = self._prune_parts(mapping_values.get_mapping(body, "components"), group.key)
        components = body.entries["components"].with_value(parts)
        return group.with_value(body.with_entries({**body.entries, "components": components}))

    def _prune_parts(self, parts: MappingNode, holder_id: str) -> MappingNode:
        kept = {
            part.key: self._prune_component(part, f"{holder_id}.{part.key}")
            for part in parts
            if f"{holder_id}.{part.key}" not in self.removed.components
        }
        return parts.with_entries(kept)

    def _prune_component(self, part: MappingEntry, component_id: str) -> MappingEntry:
        body = mapping_values.get_body(part)
        if component_id in self._untouched and _HOLDING_KEYS.isdisjoint(body.entries):
            return part
        if component_id in self._changed_shells and not _TYPE_KEYS.isdisjoint(body.entries):
            body = self._write_out(component_id, body)
        entries = dict(body.entries)
        for side in ("inputs", "outputs"):
            if side in entries:
                entries[side] = self._prune_ports(entries[side], component_id, side)
        self._prune_sources(entries, lambda scalar: self._find_source(scalar, component_id))
        if (component_id in self._changed_shells and "components" in entries) or (
            "components" in entries and not _TYPE_KEYS.intersection(body.entries)
        ):
            inner = self._prune_parts(mapping_values.get_mapping(body, "components"), component_id)
            entries["components"] = entries["components"].with_value(inner)
        if "node" in entries:
            entries["node"] = self._prune_start(entries["node"], component_id)
        is_same = len(entries) == len(body.entries) and all(entries[key] is body.entries[key] for key in entries)
        if is_same and body is part.value:
            return part
        return part.with_value(body.with_entries(entries))

    def _write_out(self, component_id: str, body: MappingNode) -> MappingNode:
        """Return an instance as if all that it has of its type had been written at it; what is inside stays as written."""
        shell = self._expansion.shells[component_id]
        full_body = mapping_values.get_body(shell.entry)
        entries = {entry.key: entry for entry in full_body if entry.key not in _TYPE_KEYS}
        entries["components"] = MappingEntry(
            "components", shell.entry.key_span, MappingNode(dict(shell.parts), full_body.span)
        )
        return body.with_entries(entries)

    def _prune_ports(self, ports: MappingEntry, component_id: str, side: str) -> MappingEntry:
        kept: dict[str, MappingEntry] = {}
        for port in mapping_values.get_body(ports):
            if "from" not in mapping_values.get_body(port).entries:
                kept[port.key] = port
                continue
            entries = dict(mapping_values.get_body(port).entries)
            find_target = self._find_source if side == "inputs" else self._find_given
            self._prune_sources(entries, lambda scalar, find=find_target: find(scalar, component_id))  # type: ignore[misc]
            is_same = len(entries) == len(mapping_values.get_body(port).entries) and all(
                entries[key] is each for key, each in mapping_values.get_body(port).entries.items()
            )
            kept[port.key] = port if is_same else port.with_entries(entries)
        if all(kept[port.key] is port for port in mapping_values.get_body(ports)):
            return ports
        return ports.with_entries(kept)

    def _prune_sources(
        self, entries: dict[str, MappingEntry], find_target: Callable[[ScalarNode], ElementRef | None]
    ) -> None:
        """Take references to what goes out of `from`; where none is left, nothing is written there."""
        entry = entries.get("from")
        if entry is None:
            return
        items = entry.value.items if isinstance(entry.value, SequenceNode) else [entry.value]
        kept = [
            item
            for item in items
            if not isinstance(item, ScalarNode)
            or not self.removed.may_be_named(item.text)
            or not self._is_removed(find_target(item))
        ]
        if not kept and items:
            del entries["from"]
        elif len(kept) < len(items):
            entries["from"] = entry.with_value(SequenceNode(kept, entry.value.span))

    def _find_source(self, scalar: ScalarNode, component_id: str) -> ElementRef | None:
        if self._sources is not None:
            return self._sources.resolve_source(scalar, component_id)
        return self._resolver.resolve_reference(scalar, SOURCE_KINDS, component_id, component_id)

    def _find_given(self, scalar: ScalarNode, component_id: str) -> ElementRef | None:
        known = self._sources is not None and component_id in self._outline.shells
        return self._sources.resolve_given(scalar, component_id) if self._sources and known else None

    def _is_removed(self, target: ElementRef | None) -> bool:
        if target is None:
            return False
        if target.kind == "group":
            return target.id in self.removed.groups
        if target.kind == "node":
            return target.id in self.removed.nodes
        component_id = target.id if target.kind == "component" else target.id.rpartition(".")[0]
        return component_id in self.removed.components

    def _prune_nodes(self, nodes: MappingNode) -> MappingNode:
        kept: dict[str, MappingEntry] = {}
        for node in nodes:
            body = mapping_values.get_body(node)
            scalars = mapping_values.get_scalars(body, "implements")
            targets = {
                scalar.text: self._resolver.resolve_reference(scalar, ("component",), node.key)
                for scalar in scalars
                if self.removed.may_be_named(scalar.text)
            }
            gone = [scalar for scalar in scalars if self._is_removed(targets.get(scalar.text))]
            if len(gone) < len(scalars) or (not scalars and node.key not in self.removed.nodes):
                gone_ids = [target.id for scalar in gone if (target := targets[scalar.text])]
                kept[node.key] = self._prune_node(node, body, gone, gone_ids) if gone else node
        self._gone_nodes = frozenset(nodes.entries.keys() - kept.keys())
        pruned = {key: self._prune_start(entry, None) for key, entry in kept.items()}
        return nodes.with_entries(pruned)

    def _prune_node(
        self, node: MappingEntry, body: MappingNode, gone: list[ScalarNode], gone_ids: list[str]
    ) -> MappingEntry:
        """Return a node that implements less than before: without topics and services of what is gone."""
        entries = dict(body.entries)
        implements = entries["implements"]
        items = [each for each in mapping_values.get_scalars(body, "implements") if each not in gone]
        entries["implements"] = implements.with_value(SequenceNode([*items], implements.value.span))
        kept_targets = (self._resolver.resolve_reference(each, ("component",), node.key) for each in items)
        kept_ports = {name for target in kept_targets if target for name in self._list_ports(target.id)}
        gone_ports = {name for component_id in gone_ids for name in self._list_ports(component_id)} - kept_ports
        gone_names = {component_id.rpartition(".")[2] for component_id in gone_ids}
        for key in _USE_KEYS:
            _keep_entries(
                entries,
                key,
                lambda use: use.key not in gone_ports and not ("." in use.key and use.key.split(".")[-2] in gone_names),
            )
        return node.with_value(body.with_entries(entries))

    def _list_ports(self, component_id: str) -> Iterator[str]:
        yield from self._outline.inputs.get(component_id, ())
        yield from self._outline.outputs.get(component_id, ())

    def _prune_start(self, holder: MappingEntry, component_id: str | None) -> MappingEntry:
        """Return a node, of a component or by itself, that waits for nothing, and is activated by nothing, that is gone."""
        body = mapping_values.get_body(holder)
        start = mapping_values.get_mapping(body, "start")
        pruned = {
            entry.key: kept
            for entry in start
            if (kept := self._prune_targets(entry, component_id) if entry.key in _START_REFERENCES else entry)
        }
        if len(pruned) == len(start.entries) and all(pruned[entry.key] is entry for entry in start):
            return holder
        laid = body.entries["start"].with_value(MappingNode(pruned, start.span))
        entries = {key: laid if key == "start" else entry for key, entry in body.entries.items()}
        if not pruned:
            del entries["start"]
        return holder.with_value(body.with_entries(entries))

    def _prune_targets(self, entry: MappingEntry, component_id: str | None) -> MappingEntry | None:
        """Return a key that names nodes and components without what is gone; None where nothing else is named."""
        items = entry.value.items if isinstance(entry.value, SequenceNode) else [entry.value]
        kept = [
            item
            for item in items
            if not (isinstance(item, ScalarNode) and self._is_gone_target(item.text, component_id))
        ]
        if len(kept) == len(items):
            return entry
        return entry.with_value(SequenceNode(kept, entry.value.span)) if kept else None

    def _is_gone_target(self, text: str, component_id: str | None) -> bool:
        inner_id = find_inner_component(text, self._resolver, component_id) if component_id else None
        if inner_id is not None or text in self._gone_nodes:
            return inner_id is None or inner_id in self.removed.components
        return self.removed.may_be_named(text) and self._is_removed(
            self._resolver.names.resolve_path(text, ("node", "component")).unique_element
        )

    def _prune_links(self, section: MappingEntry, gone_hosts: frozenset[str]) -> MappingEntry:
        kept: dict[str, MappingEntry] = {}
        hosts = self._resolver.plain_spans["host"]
        for link in mapping_values.get_body(section):
            body = mapping_values.get_body(link)
            ends = mapping_values.get_scalars(body, "connects")
            staying = [
                end
                for end in ends
                if end.text not in gone_hosts
                and not (
                    end.text not in hosts
                    and self.removed.may_be_named(end.text)
                    and self._is_removed(self._resolver.names.resolve_path(end.text, ("component",)).unique_element)
                )
            ]
            if len(staying) == len(ends):
                kept[link.key] = link
            elif len(staying) >= _LEAST_ENDS:
                connects = body.entries["connects"]
                shorter = connects.with_value(SequenceNode([*staying], connects.value.span))
                kept[link.key] = link.with_value(body.with_entries({**body.entries, "connects": shorter}))
        return section.with_entries(kept)


def _keep_entries(entries: dict[str, MappingEntry], key: str, is_kept: Callable[[MappingEntry], bool]) -> None:
    """Leave out some of the entries of the mapping at a key."""
    section = entries.get(key)
    if section is None or not isinstance(section.value, MappingNode):
        return
    kept = {entry.key: entry for entry in section.value if is_kept(entry)}
    if len(kept) < len(section.value.entries):
        entries[key] = section.with_value(section.value.with_entries(kept))
