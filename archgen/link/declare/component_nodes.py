"""Make nodes of what components say of theirs: `node` at a component, at its type, and at what is composed around it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.compose.expanded_project import ExpandedProject
from archgen.compose.instance_overlay import lay_node
from archgen.diagnostics import Diagnostic, Label
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.link.declare.component_declaration import DeclaredGroups
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.declare.start_declaration import diagnose_idle_start, inherit_start, resolve_start
from archgen.link.element_outline import ElementOutline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.derived_names import derive_node_ids
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

_INHERITED_KEYS = frozenset({"host", "container", "namespace", "parameters", "start"})
"""What a composed component says for all nodes inside."""
_CONTAINER_KEYS = ("host", "namespace")
"""What it says for the containers inside as well."""
_MAPPING_KEYS = frozenset({"package", "executable", "plugin", "command"})
"""Keys of a node that say what runs: with one of them its component is mapped."""


class ImplementingNodes(NamedTuple):
    """The nodes of a project in normal form, and what each implements."""

    root: MappingNode
    """The merged project, with the nodes that components bring along among its `nodes`."""
    implements: dict[str, tuple[str, ...]]
    """Leaves by node id, those inside of a composed component included."""
    wholes: dict[str, tuple[str, ...]]
    """Composed components that a node implements as one process, by node id."""
    leaf_ports: Callable[[str, str], tuple[str, ...]]
    """Returns the ports of leaves behind a port: its kind (`input`, `output`) and complete id."""
    planned_ids: frozenset[str] = frozenset()
    """Nodes of components that say where they run, but not what."""


def declare_component_nodes(  # noqa: PLR0913, PLR0917 - what nodes are made of
    outline: ElementOutline,
    expansion: ExpandedProject,
    written_targets: dict[str, tuple[str, ...]],
    declared_groups: DeclaredGroups,
    parameters: HandedParameters,
    resolver: ReferenceResolver,
) -> ImplementingNodes:
    """Return all nodes: those that are written, and those that components bring along."""
    root = expansion.root
    if expansion.is_plain:
        return ImplementingNodes(root, written_targets, {}, lambda _kind, port: (port,))
    written_nodes = mapping_values.get_mapping(root, "nodes")
    made = ComponentNodes(outline, expansion, written_nodes, written_targets, parameters, resolver)
    targets = {**written_targets, **made.implements}
    sections = {**root.entries, **made.list_container_section(root)}
    sections["nodes"] = MappingEntry("nodes", written_nodes.span, MappingNode(made.entries, written_nodes.span))
    return ImplementingNodes(
        MappingNode(sections, root.span),
        {
            node_id: tuple(dict.fromkeys(leaf for each in ids for leaf in declared_groups.list_leaves(each)))
            for node_id, ids in targets.items()
        },
        {node_id: tuple(each for each in ids if each in outline.shells) for node_id, ids in targets.items()},
        declared_groups.list_leaf_ports,
        frozenset(made.planned_ids),
    )


class ComponentNodes:
    """The nodes that components bring along: `entries` in normal form by node id, `implements` by node id."""

    def __init__(  # noqa: PLR0913, PLR0917 - what nodes are made of
        self,
        outline: ElementOutline,
        expansion: ExpandedProject,
        written_nodes: MappingNode,
        implements: Mapping[str, tuple[str, ...]],
        parameters: HandedParameters,
        resolver: ReferenceResolver,
    ) -> None:
        """Make them: for components that no written node implements, and under those of written nodes."""
        self.entries: dict[str, MappingEntry] = {}
        self.implements: dict[str, tuple[str, ...]] = {}
        self.planned_ids: set[str] = set()
        """Nodes of which nothing says yet what runs."""
        self._outline = outline
        self._expansion = expansion
        self._parameters = parameters
        self._resolver = resolver
        self._diagnostics = parameters.diagnostics
        self._bodies: dict[str, MappingNode] = {}
        self._lay_under_written(written_nodes, implements)
        self._make_nodes(written_nodes, implements)

    def list_container_section(self, root: MappingNode) -> dict[str, MappingEntry]:
        """Return the section of containers, those of components with what these say of all that runs inside."""
        if not self._expansion.container_holders:
            return {}
        section = root.entries["containers"]
        entries = {entry.key: self._finish_container(entry) for entry in mapping_values.get_mapping(root, "containers")}
        return {"containers": MappingEntry("containers", section.key_span, MappingNode(entries, section.value.span))}

    def _finish_container(self, entry: MappingEntry) -> MappingEntry:
        holder_id = self._expansion.container_holders.get(entry.key)
        if holder_id is None:
            return entry
        own = self._parameters.fill_in_body(mapping_values.get_body(entry), holder_id)
        around = self.find_body(holder_id).entries
        inherited = {key: around[key] for key in _CONTAINER_KEYS if key in around}
        body = MappingNode({**inherited, **own.entries}, own.span)
        _join_namespaces(body, inherited, own)
        return entry.with_value(body)

    def _lay_under_written(self, written_nodes: MappingNode, implements: Mapping[str, tuple[str, ...]]) -> None:
        for entry in written_nodes:
            body = mapping_values.get_body(entry)
            component_ids = implements.get(entry.key, ())
            own_bodies = [(each, self.find_body(each)) for each in component_ids]
            if len(own_bodies) == 1 and own_bodies[0][1].entries:
                body = lay_node(own_bodies[0][1], body)
            for component_id in component_ids:
                self._report_unused(component_id, entry, is_one=len(component_ids) == 1)
            self.entries[entry.key] = entry.with_value(body.without("whole"))

    def _report_unused(self, component_id: str, node: MappingEntry, *, is_one: bool) -> None:
        """Report `node` inside of what a node implements as a whole, and at one of several components of a node."""
        own_ids = () if is_one else (component_id,)
        for unused_id in (*own_ids, *self._outline.list_inside(component_id)):
            if self._own_node(unused_id).entries:
                self._diagnostics.append(
                    Diagnostic(
                        "unused-node",
                        f"the node `{node.key}` runs `{unused_id}`: what `{unused_id}` says of a node of its own is not used",
                        self._entry_of(unused_id).key_span,
                        labels=(Label(node.key_span, "the node"),),
                        help="take one of the two out",
                        element=unused_id,
                    )
                )

    def _make_nodes(self, written_nodes: MappingNode, implements: Mapping[str, tuple[str, ...]]) -> None:
        implemented = {part for ids in implements.values() for each in ids for part in self._list_below(each)}
        wholes: list[str] = []
        for shell_id in self._outline.shells:
            if shell_id not in implemented and mapping_values.get_flag(self._own_node(shell_id), "whole"):
                wholes.append(shell_id)
                implemented.update(self._list_below(shell_id))
            elif shell_id not in implemented:
                self._diagnostics += diagnose_idle_start(self._own_node(shell_id), shell_id)
        single_ids = [
            each for each in self._outline.components if each not in implemented and self.find_body(each).entries
        ]
        all_ids = (*self._outline.components, *self._outline.shells)
        node_ids = derive_node_ids([*single_ids, *wholes], all_ids, written_nodes.entries)
        used_names: set[tuple[str, str]] = set()
        for component_id, node_id in node_ids.items():
            self._add_node(component_id, node_id, used_names)
            self._report_unused(component_id, self.entries[node_id], is_one=True)

    def _add_node(self, component_id: str, node_id: str, used_names: set[tuple[str, str]]) -> None:
        body, entry = self.find_body(component_id).without("whole"), self._entry_of(component_id)
        reference = ScalarNode(component_id, component_id, entry.key_span)
        entries = {"implements": MappingEntry("implements", entry.key_span, SequenceNode([reference], entry.key_span))}
        if "name" not in body.entries:
            name = _find_free_name(component_id, node_id, mapping_values.get_text(body, "namespace") or "", used_names)
            entries["name"] = MappingEntry("name", entry.key_span, ScalarNode(name, name, entry.key_span))
        self.entries[node_id] = MappingEntry(
            node_id, entry.key_span, MappingNode({**entries, **body.entries}, body.span)
        )
        self.implements[node_id] = (component_id,)
        if _MAPPING_KEYS.isdisjoint(body.entries):
            self.planned_ids.add(node_id)

    def _list_below(self, component_id: str) -> list[str]:
        """Return a component and all that is inside of it, leaves and composed ones."""
        return [component_id, *self._outline.list_inside(component_id)]

    def _entry_of(self, component_id: str) -> MappingEntry:
        shell = self._outline.shells.get(component_id)
        return shell.entry if shell else self._outline.components[component_id]

    def _own_node(self, component_id: str) -> MappingNode:
        return mapping_values.get_mapping(mapping_values.get_body(self._entry_of(component_id)), "node")

    def find_body(self, component_id: str) -> MappingNode:
        """Return what a component's node has: its own keys over those of what is around it."""
        if component_id not in self._bodies:
            filled = self._parameters.fill_in_body(self._own_node(component_id), component_id)
            own = resolve_start(filled, self._resolver, component_id)
            parent = self._expansion.parents.get(component_id)
            around = self.find_body(parent) if parent else mapping_values.EMPTY_MAPPING
            inherited = _list_inherited(around)
            body = lay_node(MappingNode(inherited, around.span), own) if inherited else own
            if inherited and own.entries:
                _join_namespaces(body, inherited, own)
            self._bodies[component_id] = body
        return self._bodies[component_id]


def _list_inherited(around: MappingNode) -> dict[str, MappingEntry]:
    """Return what the nodes inside have of what a composed component says."""
    entries = {key: entry for key, entry in around.entries.items() if key in _INHERITED_KEYS}
    if "start" in entries:
        start = inherit_start(entries.pop("start"))
        entries |= {"start": start} if start else {}
    return entries


def _join_namespaces(body: MappingNode, around: Mapping[str, MappingEntry], own: MappingNode) -> None:
    """Put the namespace of what is around in front of a node's own, unless that is absolute."""
    outer, inner = around.get("namespace"), own.entries.get("namespace")
    if (
        outer is None
        or inner is None
        or not isinstance(outer.value, ScalarNode)
        or not isinstance(inner.value, ScalarNode)
    ):
        return
    if not inner.value.text.startswith("/"):
        text = f"{outer.value.text.rstrip('/')}/{inner.value.text}"
        body.entries["namespace"] = MappingEntry("namespace", inner.key_span, ScalarNode(text, text, inner.value.span))


def _find_free_name(component_id: str, node_id: str, namespace: str, used_names: set[tuple[str, str]]) -> str:
    """Return the shortest end of a component's path that is a name of its own in its namespace."""
    parts = component_id.split(".")
    place = "/" + namespace.strip("/")
    ends = ["_".join(parts[start:]) for start in range(len(parts) - 1, -1, -1)]
    name = node_id if place == "/" else next((end for end in ends if (place, end) not in used_names), node_id)
    used_names.add((place, name))
    return name
