"""Which names of a program become others where a launch file starts it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.bringup.ros_launches import ACTION_PARTS
from archgen.derivation.ros_names import resolve_ros_name
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node
from archgen.views.generation.node_programs import is_generated, name_package, name_program
from archgen.views.generation.program_ports import record_ports


class LaunchRemaps:
    """Knows the endpoints of all nodes, and which nodes share a program that is generated."""

    def __init__(self, architecture: Architecture, ros: int) -> None:
        self._architecture = architecture
        self._ros = ros
        self._endpoints: dict[str, list[Endpoint]] = {}
        for endpoint in architecture.endpoints:
            if endpoint.medium == "ros":
                self._endpoints.setdefault(endpoint.node, []).append(endpoint)
        self._nodes_by_program: dict[tuple[str, str], list[Node]] = {}
        for node in architecture.nodes.values():
            if is_generated(node):
                self._nodes_by_program.setdefault(self._name_both(node), []).append(node)
        self._shared_names: dict[tuple[str, str], dict[str, list[tuple[str, str, str]]]] = {}

    def list_remaps(self, node: Node) -> list[dict[str, str]]:
        """Return the new names of a node: `own_name` is what its program says, `name` what that becomes."""
        names: dict[str, str] = {}
        for flow, own_name, name in self._list_names(node):
            # What the program says resolves to the name by itself: there is nothing to tell.
            if resolve_ros_name(own_name, node) == name:
                continue
            suffixes = ACTION_PARTS[self._ros] if flow == "action" else ("",)
            for suffix in suffixes:
                names.setdefault(f"{own_name}{suffix}", f"{name}{suffix}")
        for own_name, name in node.remaps.items():
            names.setdefault(own_name, name)
        return [{"own_name": own_name, "name": name} for own_name, name in names.items()]

    def _list_names(self, node: Node) -> Iterator[tuple[str, str, str]]:
        if is_generated(node) and len(self._nodes_by_program[self._name_both(node)]) > 1:
            yield from self._name_shared_ports(self._name_both(node)).get(node.id, ())
            return
        for endpoint in self._endpoints.get(node.id, ()):
            if endpoint.own_name is not None:
                yield endpoint.flow, endpoint.own_name, endpoint.name

    def _name_shared_ports(self, program: tuple[str, str]) -> Mapping[str, Iterable[tuple[str, str, str]]]:
        """Return what each node of a program remaps, as that is generated: flow, own name and name."""
        if program not in self._shared_names:
            names = self._shared_names.setdefault(program, {})
            # What is left out there is told by who writes the program.
            sections, _ = record_ports(self._architecture, self._nodes_by_program[program], self._endpoints)
            for section, ports in sections.items():
                flow = "action" if section.startswith("action_") else "other"
                for port in ports:
                    topics = port["topics"]
                    for node_id, name in topics.items() if isinstance(topics, Mapping) else ():
                        names.setdefault(node_id, []).append((flow, str(port["topic"]), name))
        return self._shared_names[program]

    def _name_both(self, node: Node) -> tuple[str, str]:
        return name_package(self._architecture, node), name_program(self._architecture, node)
