"""What rules see of the whole model, wherever it is written: nodes, hosts, containers, links, topics, connections.

All of it is read off the linked architecture, so that it holds for what components say, for what is said around them, in
`nodes`, and for what follows by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen import derivation
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.model.architecture import Architecture, list_leaf_ports
from archgen.model.component import Connection
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.pattern_shapes import ViewValue
from archgen.passes.patterns.view_values import read_view_value
from archgen.passes.written_places import path_of_component
from archgen.syntax.yaml_tree import MappingEntry, YamlNode, list_entries

Bodies = dict[str, dict[str, ViewValue]]
_PLAIN_SECTIONS = ("hosts", "links")
_USERS = {"topic": ("publishers", "subscribers")}
"""What those at the two ends of a topic are called; else `servers` and `clients`."""


class ModelFacts:
    """What a linked project says of its nodes, hosts, containers, links, topics and connections."""

    def __init__(self, linked: LinkedTree, view: ArchitectureView) -> None:
        """Take what the linker knows of the tree of a view."""
        self._view = view
        self._architecture: Architecture = derivation.derive_low_level(linked.architecture)
        self._made = linked.component_nodes
        self._keys: dict[str, str] = {}
        nodes = self._architecture.nodes.values()
        self._hosts_by_leaf = {leaf: node.host for node in nodes for leaf in node.implements}
        self._processes_by_leaf = {
            leaf: f"container {node.container}" if node.container else node.id
            for node in nodes
            for leaf in node.implements
        }
        self.edit_count = view.tree.edit_count
        """The edits of the tree that are in it."""
        self.elements: dict[str, Bodies] = {
            section: {entry.key: _read_body(entry.value) for entry in list_entries(view.tree.root, section)}
            for section in _PLAIN_SECTIONS
        }
        written = mapping_values.get_mapping(linked.expansion.root, "containers")
        held = self._made.list_container_section(linked.expansion.root).get("containers")
        containers: Iterable[MappingEntry] = written if held is None else mapping_values.get_body(held)
        self.elements["containers"] = {entry.key: _read_body(entry.value) for entry in containers}
        self.elements["nodes"] = {node_id: self._make_node(node_id) for node_id in self._architecture.nodes}
        self.elements["topics"] = dict(self._list_topics())
        self.elements["connections"] = self._list_connections()
        self.hosts = self._find_hosts()
        """Where each component runs, by the path that rules know it by: where all of it runs on one host."""

    # What edits ask.

    def find_path(self, section: str, name: str) -> TreePath | None:
        """Return where an element is written, or is to be; None for a container that a component brings along."""
        own_path = (section, name)
        if self._view.tree.get(own_path) is not None or name not in self.elements[section]:
            return own_path
        if section == "nodes":
            # The component that brings it along, or that it is planned for.
            runners = self._made.implements.get(name) or self._architecture.nodes[name].implements
            return (*path_of_component(runners[0]), "node")
        return None

    def note_edit(self, section: str, name: str, path: TreePath) -> None:
        """Read an element again that was written; what follows from it is seen when the rule runs next."""
        node = self._view.tree.get(path)
        if node is None:
            self.elements[section].pop(name, None)
        else:
            self.elements[section][name] = {**self.elements[section].get(name, {}), **_read_body(node)}

    def list_host_paths(self, key: str) -> list[TreePath]:
        """Return where it is written on which host a component runs: at its nodes, or at the containers that hold these."""
        element = self._view.elements[key]
        own_path = (*element.path, "node", "host")
        if element.type_name is not None:
            return [own_path]
        paths: dict[TreePath, None] = {}
        leaves = set(self._list_leaves(key))
        for node in self._architecture.nodes.values():
            if leaves.isdisjoint(node.implements):
                continue
            node_path = self.find_path("nodes", node.id)
            box_path = self.find_path("containers", node.container) if node.container else None
            # What runs in a container says itself on which host only where that is written.
            says_itself = node_path is not None and self._view.tree.get((*node_path, "host")) is not None
            if node_path is not None and (box_path is None or says_itself):
                paths[*node_path, "host"] = None
            if box_path is not None:
                paths[*box_path, "host"] = None
        return list(paths) or [own_path]

    # How it is worked out.

    def _list_leaves(self, component_id: str) -> tuple[str, ...]:
        group = self._architecture.groups.get(component_id)
        if group is None:
            return self._architecture.leaves_of(component_id)
        return tuple(each for each in self._architecture.components if each.startswith(f"{component_id}."))

    def _make_node(self, node_id: str) -> dict[str, ViewValue]:
        node, entry = self._architecture.nodes[node_id], self._made.entries.get(node_id)
        body = _read_body(entry.value) if entry else {}
        targets = (*node.wholes, *node.implements)
        body["implements"] = list(dict.fromkeys(self._find_key(each) for each in targets))
        body |= {key: value for key in ("host", "container") if (value := getattr(node, key)) is not None}
        return body

    def _list_topics(self) -> Iterator[tuple[str, dict[str, ViewValue]]]:
        for name, topic in self._architecture.topics.items():
            writers, readers = _USERS.get(topic.flow, ("servers", "clients"))
            yield (
                name,
                {
                    "flow": topic.flow,
                    "messages": list(topic.messages),
                    "types": list(topic.types),
                    writers: list(dict.fromkeys(each.node for each in topic.writers)),
                    readers: list(dict.fromkeys(each.node for each in topic.readers)),
                },
            )

    def _list_connections(self) -> Bodies:
        """Return connections between components, each once: not what a composed one hands on to what is inside of it."""
        inner = [port.connections for shell in self._architecture.shells.values() for port in shell.inputs.values()]
        found: Bodies = {}
        for connection in (each for each_list in (self._architecture.connections, *inner) for each in each_list):
            for source in self._list_sources(connection):
                names = [self._find_port(source), self._find_port(connection.input)]
                body = found.setdefault(" -> ".join(names), {"from": names[0], "to": names[1], "crosses": []})
                output = self._architecture.outputs.get(next(self._list_ends("output", source), ""))
                if output is not None and output.type is not None:
                    body["type"] = output.type
                crossed = body["crosses"]
                if isinstance(crossed, list):
                    crossed += [each for each in self._list_crossed(source, connection.input) if each not in crossed]
        return found

    def _list_sources(self, connection: Connection) -> Iterator[str]:
        """Yield the outputs that a connection reads, as they are seen beside its reader."""
        shell_port, ports = connection.shell_port, self._architecture.shell_ports
        if shell_port is not None and f"output {shell_port}" in ports:
            yield shell_port
        elif shell_port is None or f"input {shell_port}" not in ports:
            yield from (self._lift_output(each, connection.input) for each in connection.outputs)

    def _lift_output(self, output: str, reader: str) -> str:
        """Return the output of the outermost composed component that passes an output on, and does not hold the reader."""
        component_id = output.rpartition(".")[0]
        parent = component_id.rpartition(".")[0]
        while parent in self._architecture.shells and not reader.startswith(f"{parent}."):
            passed = (f"{parent}.{name}" for name in self._architecture.shells[parent].outputs)
            lifted = next((each for each in passed if output in self._list_ends("output", each)), None)
            if lifted is None:
                break
            output, parent = lifted, parent.rpartition(".")[0]
        return output

    def _list_ends(self, kind: str, port: str) -> Iterator[str]:
        """Yield the ports of leaves behind a port; of a leaf, its own."""
        architecture = self._architecture
        yield from tuple(list_leaf_ports(architecture.shells, architecture.shell_ports, kind, port)) or (port,)

    def _list_crossed(self, source: str, reader: str) -> Iterator[str]:
        pairs = [
            (first.rpartition(".")[0], second.rpartition(".")[0])
            for first in self._list_ends("output", source)
            for second in self._list_ends("input", reader)
        ]
        owners = {each: self._architecture.components[each].owner for pair in pairs for each in pair}
        for word, places in (("host", self._hosts_by_leaf), ("partner", owners), ("process", self._processes_by_leaf)):
            ends = ((places.get(first), places.get(second)) for first, second in pairs)
            if any(first is not None and second is not None and first != second for first, second in ends):
                yield word

    def _find_hosts(self) -> dict[str, str]:
        found: dict[str, set[str | None]] = {}
        for leaf in self._architecture.components:
            for around in _list_paths(leaf):
                found.setdefault(self._find_key(around), set()).add(self._hosts_by_leaf.get(leaf))
        return {key: host for key, each in found.items() if len(each) == 1 and (host := next(iter(each))) is not None}

    def _find_port(self, port: str) -> str:
        component_id, _, name = port.rpartition(".")
        return f"{self._find_key(component_id)}.{name}"

    def _find_key(self, component_id: str) -> str:
        """Return the path that rules know a component by: inside of an instance, that in its type."""
        if component_id not in self._keys:
            self._keys[component_id] = self._view.find_key(component_id) or component_id
        return self._keys[component_id]


def _read_body(node: YamlNode) -> dict[str, ViewValue]:
    value = read_view_value(node, lambda _: None, {})
    return value if isinstance(value, dict) else {}


def _list_paths(component_id: str) -> Iterator[str]:
    """Yield a component and all that is around it."""
    while component_id:
        yield component_id
        component_id = component_id.rpartition(".")[0]
