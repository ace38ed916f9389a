"""The nodes of a project once the components around others are gone: each says itself what it had from around it.

What other programs see stays as it is: ids and names of nodes, their namespaces, and the names of topics and services.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen import derivation
from archgen.derivation.ros_names import default_port_name
from archgen.diagnostics import Span
from archgen.link import mapping_values
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.passes.linked_tree import LinkedTree
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

_USES = {"publishes": "topic", "subscribes": "topic", "serves": "name", "calls": "name"}
_TIMED_BY_COMPONENT = ("timing", "callback_groups")


class FlatNodes:
    """Writes the nodes of a project whose leaves get other ids."""

    def __init__(self, linked: LinkedTree, flat_ids: Mapping[str, str]) -> None:
        """Take what the linker knows, and the complete ids that leaves get."""
        self._linked = linked
        self._flat_ids = flat_ids
        self._architecture: Architecture = derivation.derive_low_level(linked.architecture)
        self._written_nodes = mapping_values.get_mapping(linked.expansion.root, "nodes")
        self._targets = linked.node_targets
        self._made = linked.component_nodes
        self._node_by_leaf = {ids[0]: node_id for node_id, ids in self._made.implements.items()}
        planned_nodes = [each for each in self._architecture.nodes.values() if not each.written]
        self._planned_ids = {each.implements[0]: each.id for each in planned_nodes if len(each.implements) == 1}
        self._endpoints: dict[str, list[Endpoint]] = {}
        for endpoint in self._architecture.endpoints:
            self._endpoints.setdefault(endpoint.node, []).append(endpoint)

    def find_containers(self, root: MappingNode) -> dict[str, MappingEntry]:
        """Return the section of containers with those that components bring along; nothing where none does."""
        return self._made.list_container_section(root)

    def write_own_node(self, leaf_id: str) -> MappingEntry | None:
        """Return what a leaf says of the node that it brings along, with what it has from around it."""
        node_id = self._node_by_leaf.get(leaf_id)
        planned_id = self._planned_ids.get(leaf_id)
        shell = self._linked.outline.shells.get(leaf_id)
        place = (shell.entry if shell else self._linked.outline.components[leaf_id]).key_span
        entries: dict[str, MappingEntry] = {}
        if node_id is not None:
            entries = {e.key: e for e in mapping_values.get_body(self._made.entries[node_id]) if e.key != "implements"}
            name = mapping_values.get_text(MappingNode(entries, place), "name")
            if name == self._flat_ids[leaf_id].partition(".")[2] and "namespace" not in entries:
                del entries["name"]
        entries = self._keep_names(node_id or planned_id or "", (leaf_id,), entries, place)
        return MappingEntry("node", place, MappingNode(entries, place)) if entries else None

    def complete_start(self, node: MappingEntry, leaf_id: str) -> MappingEntry:
        """Return what a leaf says of its node, as it is written, with complete ids of what it starts after."""
        if not isinstance(node.value, MappingNode) or "start" not in node.value.entries:
            return node
        start = self._made.find_body(leaf_id).entries["start"]
        return node.with_entries({**node.value.entries, "start": start})

    def list_implemented(self, node_id: str) -> tuple[str, ...]:
        """Return the leaves that a node implements, by their complete ids before."""
        return self._list_leaves((*self._targets.get(node_id, ()), *self._made.implements.get(node_id, ())))

    def write_section(self) -> dict[str, MappingEntry]:
        """Return the nodes of the project: those that are written, and those that run a composed component as one."""
        section: dict[str, MappingEntry] = {}
        for entry in self._written_nodes:
            targets = self._targets.get(entry.key, ())
            leaves = self._list_leaves(targets)
            is_touched = any(
                each in self._linked.outline.shells or self._flat_ids.get(each) != each for each in targets
            )
            section[entry.key] = self._write_node(self._made.entries[entry.key], leaves) if is_touched else entry
        for node_id, targets in self._made.implements.items():
            if targets[0] in self._linked.outline.shells:
                section[node_id] = self._write_node(self._made.entries[node_id], self._list_leaves(targets))
        return section

    def list_run_leaves(self) -> set[str]:
        """Return the leaves of which a node of the section says all: what they say of a node of their own is in it."""
        leaves: set[str] = set()
        for node_id, targets in {**self._targets, **self._made.implements}.items():
            is_whole = any(each in self._linked.outline.shells for each in targets)
            is_deep = any(self._flat_ids.get(each) != each for each in targets)
            if is_whole or (is_deep and node_id in self._targets):
                leaves.update(self._list_leaves(targets))
        return leaves

    def _list_leaves(self, targets: Sequence[str]) -> tuple[str, ...]:
        leaves = [
            each
            for target in targets
            for each in (target, *self._linked.outline.list_inside(target))
            if each in self._flat_ids
        ]
        return tuple(dict.fromkeys(leaves))

    def _write_node(self, entry: MappingEntry, leaves: tuple[str, ...]) -> MappingEntry:
        body = mapping_values.get_body(entry)
        written = body.entries.get("implements")
        place = written.key_span if written else entry.key_span
        names = [ScalarNode(self._flat_ids[each], self._flat_ids[each], place) for each in leaves]
        entries = {"implements": MappingEntry("implements", place, SequenceNode(list(names), place))}
        entries |= {key: each for key, each in body.entries.items() if key != "implements"}
        for key in _TIMED_BY_COMPONENT:
            if key in entries and isinstance(entries[key].value, MappingNode):
                entries[key] = self._rename_components(entries[key], leaves)
        entries = self._keep_names(entry.key, leaves, entries, entry.key_span)
        if "internal" in entries:
            entries["internal"] = self._keep_internal_names(entry.key, entries["internal"])
        return entry.with_value(MappingNode(entries, body.span))

    def _rename_components(self, entry: MappingEntry, leaves: tuple[str, ...]) -> MappingEntry:
        """Return what a node says by component, with the names that these get."""
        new_names = {leaf.rpartition(".")[2]: self._flat_ids[leaf].partition(".")[2] for leaf in leaves}
        new_names |= {leaf: self._flat_ids[leaf] for leaf in leaves}
        inner = mapping_values.get_body(entry)
        if entry.key == "timing":
            renamed = ((new_names.get(each.key, each.key), each) for each in inner)
            entries = {name: MappingEntry(name, each.key_span, each.value) for name, each in renamed}
        else:
            entries = {each.key: each.with_value(_rename_items(each.value, new_names)) for each in inner}
        return entry.with_value(MappingNode(entries, inner.span))

    def _keep_internal_names(self, node_id: str, section: MappingEntry) -> MappingEntry:
        """Return the internal topics and services of a node, those named that were called after a component's path."""
        endpoints = [each for each in self._endpoints.get(node_id, ()) if each.internal and each.component]

        def keep_names(written: MappingEntry) -> MappingEntry:
            key = _USES.get(written.key, "")
            return written.change_each(lambda use: self._keep_internal_name(use, key, endpoints))

        return section.change_each(keep_names)

    def _keep_internal_name(self, use: MappingEntry, key: str, endpoints: Sequence[Endpoint]) -> MappingEntry:
        """Return an internal entry; `key` is what names its topic or service."""
        body = mapping_values.get_body(use)
        derived = (each for each in endpoints if each.name == default_port_name(f"{each.component}.{use.key}"))
        endpoint = next(derived, None)
        flat_id = self._flat_ids.get(endpoint.component or "") if endpoint else None
        if endpoint is None or key in body.entries or endpoint.name == default_port_name(f"{flat_id}.{use.key}"):
            return use
        named = {**body.entries, key: _write_name(key, endpoint.label, use.key_span)}
        return use.with_value(MappingNode(named, use.key_span))

    def _keep_names(
        self, node_id: str, leaves: tuple[str, ...], entries: dict[str, MappingEntry], place: Span
    ) -> dict[str, MappingEntry]:
        """Return a node that names each topic and service which would be called otherwise now, and the ports inside."""
        uses: dict[str, dict[str, MappingEntry]] = {}
        written_by_key = {
            use: {each.key: each for each in mapping_values.get_mapping(MappingNode(entries, place), use)}
            for use in _USES
        }
        renamed: set[tuple[str, str]] = set()
        for endpoint in self._endpoints.get(node_id, ()):
            if endpoint.port is None or endpoint.internal or endpoint.component not in self._flat_ids:
                continue
            component_id, _, name = endpoint.port.rpartition(".")
            if component_id not in self._flat_ids:
                continue
            flat_id = self._flat_ids[component_id]
            key = name if len(leaves) == 1 else f"{flat_id.partition('.')[2]}.{name}"
            old_key, written = _find_written(written_by_key[endpoint.use], endpoint.port)
            body = dict(mapping_values.get_body(written).entries) if written else {}
            # A reader follows what it reads; what nothing in the project feeds is named after the port alone.
            is_named_by_port = endpoint.use in {"publishes", "serves"} or not endpoint.sources
            # `remaps` stay as they are: what they are applied to is written.
            model_name = endpoint.name if endpoint.own_name else endpoint.program_name
            is_otherwise = (
                is_named_by_port and model_name is not None and model_name != default_port_name(f"{flat_id}.{name}")
            )
            if written is None and not is_otherwise:
                continue
            naming_key = _USES[endpoint.use]
            if is_otherwise and model_name and naming_key not in body:
                body[naming_key] = _write_name(naming_key, model_name, place)
            if old_key is not None:
                renamed.add((endpoint.use, old_key))
            span = written.key_span if written else place
            uses.setdefault(endpoint.use, {})[key] = MappingEntry(key, span, MappingNode(body, span))
        for use, made in uses.items():
            kept = {key: each for key, each in written_by_key[use].items() if (use, key) not in renamed}
            key_span = entries[use].key_span if use in entries else place
            entries = {**entries, use: MappingEntry(use, key_span, MappingNode({**kept, **made}, key_span))}
        return entries


def _write_name(key: str, name: str, place: Span) -> MappingEntry:
    """Return the `topic` or `name` of an end."""
    text = ScalarNode(name, name, place)
    return MappingEntry(key, place, SequenceNode([text], place) if key == "topic" else text)


def _find_written(written: Mapping[str, MappingEntry], port_id: str) -> tuple[str | None, MappingEntry | None]:
    """Return what a node says of a port, with the key: the longest end of the port's path that is there."""
    words = port_id.split(".")
    for start in range(len(words)):
        key = ".".join(words[start:])
        if key in written:
            return key, written[key]
    return None, None


def _rename_items(node: object, names: Mapping[str, str]) -> SequenceNode | ScalarNode | MappingNode:
    if isinstance(node, SequenceNode):
        return SequenceNode([_rename_items(each, names) for each in node.items], node.span)
    if isinstance(node, ScalarNode) and node.text in names:
        return ScalarNode(names[node.text], names[node.text], node.span)
    return node  # type: ignore[return-value]
