"""Who waits for whom in a start-up: containers, what nodes say, servers and sources, managers of lifecycle nodes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.bringup.plan_shapes import Wait, WaitReason
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.node import Node
from archgen.model.port_media import is_physical
from archgen.model.start_up import NO_START, StartTarget

CONTAINER_PREFIX = "container "
"""Stands in front of the ids of containers where a node is called the same."""


class StartWaits:
    """The waits of an architecture's start-up, before any is given up."""

    def __init__(self, architecture: Architecture) -> None:
        """Look up which nodes use each port."""
        self._architecture = architecture
        self._nodes_of: dict[str, list[str]] = defaultdict(list)
        for node in architecture.nodes.values():
            for component_id in node.implements:
                self._nodes_of[component_id].append(node.id)
        self._users_of_port: dict[str, dict[str, str]] = defaultdict(dict)
        for endpoint in architecture.list_endpoints():
            if endpoint.port is not None:
                self._users_of_port[endpoint.port][endpoint.node] = endpoint.flow
        self.managers = {node.id: self._list_managers(node) for node in architecture.nodes.values()}

    def list_waits(self) -> list[Wait]:
        """Return all waits, those that say the same only once: in the order of what is written."""
        waits: dict[tuple[str, str, WaitReason], Wait] = {}
        for wait in (*self._list_written_waits(), *self._list_data_waits()):
            waits.setdefault((wait.awaited, wait.waiting, wait.reason), wait)
        return list(waits.values())

    def find_nodes(self, target: StartTarget) -> Iterator[str]:
        """Yield the nodes that are meant where a start-up names a node or a component."""
        if target.kind == "node":
            yield target.id
        else:
            for leaf in self._architecture.leaves_of(target.id):
                yield from self._nodes_of.get(leaf, ())

    def _list_managers(self, node: Node) -> tuple[str, ...]:
        manager = (node.start or NO_START).by
        return tuple(dict.fromkeys(self.find_nodes(manager))) if manager else ()

    def _list_written_waits(self) -> Iterator[Wait]:
        for node in self._architecture.nodes.values():
            if node.container is not None:
                yield Wait(
                    name_container(self._architecture, node.container), node.id, "container", at=node.container_at
                )
            for target in (node.start or NO_START).after:
                awaited = dict.fromkeys(self.find_nodes(target))
                if len(awaited) > 1:
                    awaited.pop(node.id, None)  # one of several nodes of a component waits for the others
                for each in awaited:
                    yield Wait(each, node.id, "after", at=target.at)
            for manager in self.managers[node.id]:
                if manager != node.id:
                    yield Wait(node.id, manager, "manages", at=node.at)

    def _list_data_waits(self) -> Iterator[Wait]:
        grouped: dict[tuple[str, str, WaitReason], list[PortEdge]] = defaultdict(list)
        for edge in self._architecture.edges:
            if is_physical(self._architecture.outputs[edge.output]):
                continue
            for awaited, waiting, reason in self._list_edge_waits(edge):
                grouped[awaited, waiting, reason].append(edge)
        for (awaited, waiting, reason), edges in grouped.items():
            ports = tuple((edge.output, edge.input) for edge in edges)
            yield Wait(awaited, waiting, reason, ports, edges[0].at)
            yield from self._wait_for_managers(awaited, waiting, ports, edges[0])

    def _list_edge_waits(self, edge: PortEdge) -> Iterator[tuple[str, str, WaitReason]]:
        writers, readers = self._find_users(edge.output), self._find_users(edge.input)
        for writer, flow in writers.items():
            for reader in readers:
                if writer != reader:
                    yield writer, reader, self._judge_need(edge, self._architecture.nodes[reader], flow)

    def _find_users(self, port_id: str) -> Mapping[str, str]:
        """Return the nodes that use a port, each with the kind of flow; where none says so, those of its component."""
        users = self._users_of_port.get(port_id)
        return users or dict.fromkeys(self._nodes_of.get(port_id.rpartition(".")[0], ()), "topic")

    def _judge_need(self, edge: PortEdge, reader: Node, flow: str) -> WaitReason:
        port = self._architecture.inputs[edge.input]
        if port.optional:
            return "optional"
        if flow != "topic":
            return "service"
        timing = reader.timing.get(port.component)
        if timing is None:
            return "data"
        named = timing.trigger.inputs if timing.trigger else None
        is_clocked = timing.period is not None or timing.rate is not None or timing.behaviour in {"periodic", "once"}
        return "sampled" if is_clocked or (named is not None and edge.input not in named) else "data"

    def _wait_for_managers(
        self, awaited: str, waiting: str, ports: tuple[tuple[str, str], ...], edge: PortEdge
    ) -> Iterator[Wait]:
        """Yield that a reader waits for who activates its source, unless that one manages the reader as well."""
        managers = self.managers[awaited]
        if waiting not in managers and not set(managers) & set(self.managers[waiting]):
            for manager in managers:
                yield Wait(manager, waiting, "managed", ports, edge.at)


def name_container(architecture: Architecture, container_id: str) -> str:
    """Return what the step of a container is called: its id, with the kind in front where a node has the same."""
    return f"{CONTAINER_PREFIX}{container_id}" if container_id in architecture.nodes else container_id


def group_by_waiting(waits: Iterable[Wait]) -> dict[str, list[Wait]]:
    """Return the waits of each step, those that are needed most first."""
    grouped: dict[str, list[Wait]] = defaultdict(list)
    for wait in sorted(waits, key=lambda each: -each.need):
        grouped[wait.waiting].append(wait)
    return grouped
