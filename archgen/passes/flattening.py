"""The pass that takes hierarchy away: connections lifted through composed components, which are gone then."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from archgen import derivation
from archgen.diagnostics import Span
from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.port_sources import OpenShells
from archgen.model.derived_names import derive_node_ids
from archgen.model.element_ids import MAX_ID_LENGTH, make_id, make_unique_id
from archgen.model.parameter import Parameter
from archgen.passes.flat_nodes import FlatNodes
from archgen.passes.flat_references import FlatReferences
from archgen.passes.flat_sources import FlatSources
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import have_same_content, make_node
from archgen.passes.tree_rebuilding import rebuild_tree
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, change_at

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
