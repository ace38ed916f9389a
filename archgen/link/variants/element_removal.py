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
from archgen.syntax.yaml_tree import EntryChange, MappingEntry, MappingNode, ScalarNode, SequenceNode, list_entries

_HOLDING_KEYS = frozenset({"from", "node", "components"})
_TYPE_KEYS = frozenset({"is", "same_as"})
_USE_KEYS = ("publishes", "subscribes", "serves", "calls")
_START_REFERENCES = ("after", "by")
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
        # First: what components say of the start-up names nodes, too.
        nodes = self._prune_nodes(mapping_values.get_mapping(root, "nodes"))
        containers, hosts = find_idle_places(root, nodes, self._outline, self.removed.components)
        changes: dict[str, EntryChange] = {
            "groups": self._prune_group,
            "nodes": lambda node: nodes.entries.get(node.key),
            "containers": lambda container: None if container.key in containers else container,
            "hosts": lambda host: None if host.key in hosts else host,
            "resources": lambda each: (
                None if mapping_values.get_text(mapping_values.get_body(each), "host") in hosts else each
            ),
            "links": lambda link: self._prune_link(link, hosts),
        }
        return root.change_keys(dict.fromkeys(changes, lambda section: section.change_each(changes[section.key])))

    def _prune_group(self, group: MappingEntry) -> MappingEntry | None:
        if group.key in self.removed.groups:
            return None
        return group.change_keys({"components": lambda parts: self._prune_parts(parts, group.key)})

    def _prune_parts(self, parts: MappingEntry, holder_id: str) -> MappingEntry:
        return parts.change_each(lambda part: self._prune_component(part, f"{holder_id}.{part.key}"))

    def _prune_component(self, part: MappingEntry, component_id: str) -> MappingEntry | None:
        if component_id in self.removed.components:
            return None
        body = mapping_values.get_body(part)
        if component_id in self._untouched and _HOLDING_KEYS.isdisjoint(body.entries):
            return part
        if component_id in self._changed_shells and not _TYPE_KEYS.isdisjoint(body.entries):
            body = self._write_out(component_id, body)

        def prune_sources(entry: MappingEntry) -> MappingEntry | None:
            return self._prune_sources(entry, component_id, self._find_source)

        def prune_given(entry: MappingEntry) -> MappingEntry | None:
            return self._prune_sources(entry, component_id, self._find_given)

        changes: dict[str, EntryChange] = {
            "inputs": lambda ports: ports.change_each(lambda port: port.change_keys({"from": prune_sources})),
            "outputs": lambda ports: ports.change_each(lambda port: port.change_keys({"from": prune_given})),
            "from": prune_sources,
            "node": lambda node: self._prune_start(node, component_id),
        }
        if _TYPE_KEYS.isdisjoint(body.entries):
            changes["components"] = lambda parts: self._prune_parts(parts, component_id)
        return (part if body is part.value else part.with_value(body)).change_keys(changes)

    def _write_out(self, component_id: str, body: MappingNode) -> MappingNode:
        """Return an instance as if all that it has of its type had been written at it; what is inside stays as written."""
        shell = self._expansion.shells[component_id]
        full_body = mapping_values.get_body(shell.entry)
        entries = {entry.key: entry for entry in full_body if entry.key not in _TYPE_KEYS}
        entries["components"] = MappingEntry(
            "components", shell.entry.key_span, MappingNode(dict(shell.parts), full_body.span)
        )
        return body.with_entries(entries)

    def _prune_sources(
        self, entry: MappingEntry, component_id: str, find_target: Callable[[ScalarNode, str], ElementRef | None]
    ) -> MappingEntry | None:
        """Take references to what goes out of `from`; where none is left, nothing is written there."""
        return entry.keep_items(
            lambda item: (
                not isinstance(item, ScalarNode)
                or not self.removed.may_be_named(item.text)
                or not self._is_removed(find_target(item, component_id))
            )
        )

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
        items = [each for each in mapping_values.get_scalars(body, "implements") if each not in gone]
        kept_targets = (self._resolver.resolve_reference(each, ("component",), node.key) for each in items)
        kept_ports = {name for target in kept_targets if target for name in self._list_ports(target.id)}
        gone_ports = {name for component_id in gone_ids for name in self._list_ports(component_id)} - kept_ports
        gone_names = {component_id.rpartition(".")[2] for component_id in gone_ids}

        def prune_use(use: MappingEntry) -> MappingEntry | None:
            is_gone = use.key in gone_ports or ("." in use.key and use.key.split(".")[-2] in gone_names)
            return None if is_gone else use

        changes: dict[str, EntryChange] = dict.fromkeys(_USE_KEYS, lambda uses: uses.change_each(prune_use))
        changes["implements"] = lambda entry: entry.with_value(SequenceNode([*items], entry.value.span))
        return node.change_keys(changes)

    def _list_ports(self, component_id: str) -> Iterator[str]:
        yield from self._outline.inputs.get(component_id, ())
        yield from self._outline.outputs.get(component_id, ())

    def _prune_start(self, holder: MappingEntry, component_id: str | None) -> MappingEntry:
        """Return a node, of a component or by itself, that waits for nothing, and is activated by nothing, that is gone."""

        def prune_targets(entry: MappingEntry) -> MappingEntry | None:
            return entry.keep_items(
                lambda item: not (isinstance(item, ScalarNode) and self._is_gone_target(item.text, component_id))
            )

        def prune_start(start: MappingEntry) -> MappingEntry | None:
            kept = start.change_keys(dict.fromkeys(_START_REFERENCES, prune_targets))
            return kept if kept is start or list_entries(kept.value) else None

        return holder.change_keys({"start": prune_start})

    def _is_gone_target(self, text: str, component_id: str | None) -> bool:
        inner_id = find_inner_component(text, self._resolver, component_id) if component_id else None
        if inner_id is not None or text in self._gone_nodes:
            return inner_id is None or inner_id in self.removed.components
        return self.removed.may_be_named(text) and self._is_removed(
            self._resolver.names.resolve_path(text, ("node", "component")).unique_element
        )

    def _prune_link(self, link: MappingEntry, gone_hosts: frozenset[str]) -> MappingEntry | None:
        hosts = self._resolver.plain_spans["host"]
        ends = mapping_values.get_scalars(mapping_values.get_body(link), "connects")
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
            return link
        if len(staying) < _LEAST_ENDS:
            return None
        return link.change_keys(
            {"connects": lambda entry: entry.with_value(SequenceNode([*staying], entry.value.span))}
        )
