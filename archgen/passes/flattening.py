"""The pass that takes hierarchy away: connections lifted through composed components, which are gone then. Each node says
itself what it had from around it.

What other programs see stays as it is: ids and names of nodes, their namespaces, and the names of topics and services.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from archgen import derivation
from archgen.derivation.ros_names import default_port_name
from archgen.diagnostics import Span
from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.port_sources import OpenShells
from archgen.model.architecture import Architecture
from archgen.model.derived_names import derive_node_ids
from archgen.model.element_ids import MAX_ID_LENGTH, make_id, make_unique_id
from archgen.model.node import Endpoint
from archgen.model.parameter import Parameter
from archgen.passes.flat_references import FlatReferences
from archgen.passes.flat_sources import FlatSources
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import have_same_content, make_node, rebuild_tree
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, change_at

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


_HANDED_KEYS = ("owner", "status")
"""What a leaf has of what is around it, unless it says it itself."""
_JOINED_LISTS = ("requirements", "tags")
"""What a leaf has of what is around it, besides its own."""
_SHELL_KEYS = frozenset({"components", "containers", "autoconnect", "node"})
_WHOLE_KEYS = frozenset({"timing", "performance", "requirements"})
"""What a composed component says of itself as a whole: nothing that is left of it can keep it."""


def _flatten_components(work: PassWork) -> None:
    linked = work.link()
    component_ids = [*linked.outline.components, *_list_open_shells(linked)]
    nodes = mapping_values.get_mapping(work.tree.root, "nodes")
    deep_names = {each.rpartition(".")[2] for each in component_ids if each.count(".") > 1}
    used_names = [name for name in nodes.entries if name not in deep_names]
    all_ids = [*linked.outline.components, *linked.outline.shells]
    flat_ids = name_flat_components(component_ids, all_ids, used_names)
    if not linked.outline.shells and all(flat_ids[each] == each for each in component_ids):
        return
    rebuild_tree(work.tree, _Flattener(work, linked, flat_ids).write_root())


def _list_open_shells(linked: LinkedTree) -> list[str]:
    """Return the composed components that count as a component of their own: ports that nothing inside carries."""
    open_shells = OpenShells(linked.outline, linked.joined_sources)
    return [shell.id for group_id in linked.outline.groups for shell in open_shells.list_in_group(group_id)]


class _Flattener:
    """Writes a project without composed components."""

    def __init__(self, work: PassWork, linked: LinkedTree, flat_ids: dict[str, str]) -> None:
        self._work = work
        self._linked = linked
        self._flat_ids = flat_ids
        self._parents = linked.expansion.parents
        self._sources = FlatSources(linked, flat_ids)
        self._open_shells = OpenShells(linked.outline, linked.joined_sources)
        self._parameters = HandedParameters(linked.outline, [])
        self._nodes = FlatNodes(linked, flat_ids)
        self._run_leaves = self._nodes.list_run_leaves()
        architecture = derivation.derive_low_level(linked.architecture)
        self._references = FlatReferences(linked, flat_ids, architecture)

    def write_root(self) -> MappingNode:
        root = self._work.tree.root
        sections = dict(root.entries)
        written_groups = mapping_values.get_mapping(root, "groups")
        groups = {entry.key: self._write_group(entry) for entry in written_groups}
        sections["groups"] = root.entries["groups"].with_value(MappingNode(groups, written_groups.span))
        sections |= self._nodes.find_containers(self._linked.expansion.root)
        nodes = {
            node_id: self._rewrite_node(entry, self._nodes.list_implemented(node_id))
            for node_id, entry in self._nodes.write_section().items()
        }
        if nodes:
            key_span = sections["nodes"].key_span if "nodes" in sections else root.span
            sections["nodes"] = MappingEntry("nodes", key_span, MappingNode(nodes, key_span))
        sections |= self._references.rewrite_sections(sections)
        return MappingNode(sections, root.span)

    def _write_group(self, group: MappingEntry) -> MappingEntry:
        def write(section: MappingEntry) -> MappingEntry:
            written_ids = [f"{group.key}.{name}" for name in mapping_values.get_body(section).entries]
            flat_names = {each: self._flat_ids[each].partition(".")[2] for each in self._list_in_order(written_ids)}
            return section.with_entries({name: self._write_component(each, name) for each, name in flat_names.items()})

        return group.change_keys({"components": write})

    def _list_in_order(self, component_ids: object) -> list[str]:
        """Return what is left of components, each composed one before what is inside of it."""
        listed: list[str] = []
        for component_id in component_ids if isinstance(component_ids, (list, tuple)) else ():
            if component_id in self._flat_ids:
                listed.append(component_id)
            shell = self._linked.outline.shells.get(component_id)
            listed += self._list_in_order(shell.children) if shell else []
        return listed

    def _write_component(self, component_id: str, flat_name: str) -> MappingEntry:
        shell = self._linked.outline.shells.get(component_id)
        entry = shell.entry if shell else self._linked.outline.components[component_id]
        body = mapping_values.get_body(entry)
        is_deep = component_id in self._parents
        entries = {key: each for key, each in body.entries.items() if not (shell and key in _SHELL_KEYS | _WHOLE_KEYS)}
        entries.pop("containers", None)
        inputs, outputs = self._list_ports(component_id, is_shell=shell is not None)
        for key, names, write in (
            ("inputs", inputs, self._sources.write_inputs),
            ("outputs", outputs, self._sources.write_outputs),
        ):
            if key in entries and isinstance(entries[key].value, MappingNode):
                ports = write(component_id, names, mapping_values.get_mapping(body, key))
                entries[key] = entries[key].with_value(ports)
        if "parameters" in entries and isinstance(entries["parameters"].value, MappingNode):
            filled = fill_in_parameters(entries["parameters"].value, self._parameters.find_parameters(component_id))
            entries["parameters"] = entries["parameters"].with_value(filled)
        if "frames" in entries:
            entries["frames"] = self._references.frames.rewrite_own(entries["frames"], component_id)
        if is_deep:
            self._inherit(component_id, entries)
        is_renamed = self._flat_ids[component_id] != component_id
        if shell is not None or is_deep or is_renamed or component_id in self._run_leaves:
            entries.pop("node", None)
            own_node = None if component_id in self._run_leaves else self._nodes.write_own_node(component_id)
            if own_node is not None:
                entries["node"] = self._rewrite_node(own_node, (component_id,))
        elif "node" in entries:
            own_node = self._nodes.complete_start(entries["node"], component_id)
            entries["node"] = self._rewrite_node(own_node, (component_id,))
        value = MappingNode(entries, body.span) if entries else entry.value
        return MappingEntry(flat_name, entry.key_span, value)

    def _rewrite_node(self, entry: MappingEntry, own_leaves: tuple[str, ...]) -> MappingEntry:
        if not isinstance(entry.value, MappingNode) or "start" not in entry.value.entries:
            return entry
        return entry.with_value(self._references.rewrite_start(entry.value, own_leaves))

    def _list_ports(self, component_id: str, *, is_shell: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the names of the inputs and outputs that a component keeps: of a composed one those that are open."""
        inputs = tuple(self._linked.outline.inputs.get(component_id, ()))
        outputs = tuple(self._linked.outline.outputs.get(component_id, ()))
        if not is_shell:
            return inputs, outputs
        return (
            tuple(each for each in inputs if self._open_shells.is_open(("input", f"{component_id}.{each}"))),
            tuple(each for each in outputs if self._open_shells.is_open(("output", f"{component_id}.{each}"))),
        )

    def _inherit(self, component_id: str, entries: dict[str, MappingEntry]) -> None:
        """Give a leaf what the components around it say for all that is inside: owner, status, lists and properties."""
        parent = self._parents.get(component_id)
        while parent is not None:
            body = mapping_values.get_body(self._linked.outline.shells[parent].entry)
            for key in _HANDED_KEYS:
                if key in body.entries:
                    entries.setdefault(key, body.entries[key])
            for key in _JOINED_LISTS:
                if key in body.entries and _list_items(body.entries[key]):
                    entries[key] = _join_lists(entries.get(key), body.entries[key])
            if "properties" in body.entries:
                entries["properties"] = _lay_over(entries.get("properties"), body.entries["properties"])
            parent = self._parents.get(parent)


def _join_lists(own: MappingEntry | None, around: MappingEntry) -> MappingEntry:
    if own is None:
        return around
    own_items = _list_items(own)
    added = [each for each in _list_items(around) if not any(have_same_content(each, item) for item in own_items)]
    return own.with_value(SequenceNode([*own_items, *added], own.value.span)) if added else own


def _lay_over(own: MappingEntry | None, around: MappingEntry) -> MappingEntry:
    if own is None or not isinstance(own.value, MappingNode) or not isinstance(around.value, MappingNode):
        return own or around
    return own.with_entries({**own.value.entries, **{e.key: e for e in around.value if e.key not in own.value.entries}})


def _list_items(entry: MappingEntry) -> list[YamlNode]:
    return list(entry.value.items) if isinstance(entry.value, SequenceNode) else [entry.value]


FLATTEN = Pass(
    "flatten",
    "Takes composed components away: connections lead from leaf to leaf, and every name is unique.",
    _flatten_components,
    needs=("no_component_sources", "no_autoconnect_ports", "no_autoconnect_types", "no_instances"),
    leaves=("flat", "unique_names"),
)


_PLAIN_DEPTH = 2


def name_flat_components(
    component_ids: Collection[str], all_ids: Collection[str], used_names: Collection[str]
) -> dict[str, str]:
    """Return the complete ids that components get, by their complete ids now.

    What stands directly in its group keeps its name, unless that of another group has it, too: then the group's id is
    put before it. What stands deeper gets the shortest end of its path that is unique, joined by `_`; names are unique
    in the whole project, and none of `used_names` is among those that are made.
    """
    plain_ids = [each for each in component_ids if len(each.split(".")) == _PLAIN_DEPTH]
    deep_ids = [each for each in component_ids if len(each.split(".")) > _PLAIN_DEPTH]
    names = derive_node_ids(plain_ids, all_ids, ())
    taken_names = {*names.values(), *used_names}
    for component_id, name in derive_node_ids(deep_ids, all_ids, taken_names).items():
        short_name = name if len(name) <= MAX_ID_LENGTH else make_unique_id(make_id(name, "part"), taken_names)
        taken_names.add(short_name)
        names[component_id] = short_name
    return {each: f"{each.partition('.')[0]}.{names[each]}" for each in component_ids}


_DECLARING_KEYS = frozenset({"value", "type", "choices", "from"})


def fill_in_parameters(written: MappingNode, parameters: Mapping[str, Parameter], prefix: str = "") -> MappingNode:
    """Return declarations of parameters without `from` and `$(self.x)`: with the values that these stand for."""

    def fill_in(entry: MappingEntry) -> MappingEntry:
        name = f"{prefix}{entry.key}"
        if name in parameters:
            return entry.with_value(_fill_in_declaration(entry.value, parameters[name], entry.key_span))
        if isinstance(entry.value, MappingNode):
            return entry.with_value(fill_in_parameters(entry.value, parameters, f"{name}."))
        return entry

    return written.change_each(fill_in)


def _fill_in_declaration(node: YamlNode, parameter: Parameter, place: Span) -> YamlNode:
    if not isinstance(node, MappingNode) or _DECLARING_KEYS.isdisjoint(node.entries):
        return _fill_in_value(node, parameter)
    if "from" not in node.entries:
        return change_at(node, ("value",), lambda value: _fill_in_value(value, parameter))
    entries = {key: each for key, each in node.entries.items() if key != "from"}
    handed: dict[str, object] = {
        "type": parameter.type,
        "value": parameter.value,
        "unit": parameter.unit,
        "range": list(parameter.range) if parameter.range else None,
        "choices": list(parameter.choices) if parameter.choices else None,
    }
    for key, value in handed.items():
        if value is not None and key not in entries:
            value_place = parameter.value_at if key == "value" else place
            entries[key] = MappingEntry(key, place, make_node(value, value_place))  # type: ignore[arg-type]
    return MappingNode(entries, node.span)


def _fill_in_value(node: YamlNode, parameter: Parameter) -> YamlNode:
    if (
        isinstance(node, ScalarNode)
        and isinstance(node.value, str)
        and "$(" in node.value
        and parameter.value is not None
    ):
        return make_node(parameter.value, node.span)  # type: ignore[arg-type]
    return node
