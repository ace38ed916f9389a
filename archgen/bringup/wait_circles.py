"""Take waits into a plan so that none closes a circle: of each circle the wait that is needed least stays out.

Waits come in by need. The order of what is taken so far is kept up to date with each (Pearce and Kelly, A dynamic
topological sort algorithm for directed acyclic graphs, 2006), so that a wait is looked at only between its two ends. It
begins with an order that goes against few and little needed waits (the greedy rule of Eades, Lin and Smyth, kept to one
loop at a time), which leaves little to put right.

Who waits for whom in a start-up: containers, what nodes say, servers and sources, managers of lifecycle nodes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from heapq import heapify, heappop, heappush

from archgen.bringup.plan_shapes import DroppedWait, Wait, WaitReason
from archgen.diagnostics import order_naturally
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.graph_search import find_strong_components
from archgen.model.node import NO_START, Node, StartTarget
from archgen.model.port_media import is_physical

_WEIGHT_BASE = 1 << 12
"""More waits of less need than this do not outweigh one of more need."""


def keep_acyclic(step_ids: Sequence[str], waits: Sequence[Wait]) -> tuple[list[Wait], list[DroppedWait]]:
    """Return the waits without those that close a circle with others that are needed more, and those with their circles.

    Of waits that are needed alike, the first ones stay.
    """
    successors: dict[str, list[str]] = {step_id: [] for step_id in step_ids}
    for wait in waits:
        successors[wait.awaited].append(wait.waiting)
    loops = find_strong_components(step_ids, successors.__getitem__)
    loop_of = {step_id: index for index, loop in enumerate(loops) for step_id in loop}
    inner_waits: dict[int, list[Wait]] = defaultdict(list)
    for wait in waits:
        if loop_of[wait.awaited] == loop_of[wait.waiting]:
            inner_waits[loop_of[wait.awaited]].append(wait)
    dropped: list[DroppedWait] = []
    for index in sorted(inner_waits):
        dropped += _find_closing_waits(loops[index], inner_waits[index])
    dropped_waits = {id(each.wait) for each in dropped}
    return [wait for wait in waits if id(wait) not in dropped_waits], dropped


def _find_closing_waits(step_ids: Sequence[str], waits: Sequence[Wait]) -> Iterator[DroppedWait]:
    """Yield the waits of one loop that stay out."""
    # Which set of waits costs least to leave out is NP-hard (minimum feedback arc set). So: what is needed most is taken in
    # first, and among equals what goes forward in a greedy order; a wait that closes a circle with those stays out.
    order = _KeptOrder(_order_greedily(step_ids, waits))
    is_backward = [order.positions[wait.awaited] >= order.positions[wait.waiting] for wait in waits]
    for index in sorted(range(len(waits)), key=lambda each: (-waits[each].need, is_backward[each], each)):
        circle = order.add(waits[index].awaited, waits[index].waiting)
        if circle:
            yield DroppedWait(waits[index], circle)


class _KeptOrder:
    """Steps in an order that all pairs taken in so far follow."""

    def __init__(self, step_ids: Sequence[str]) -> None:
        self.positions = {step_id: index for index, step_id in enumerate(step_ids)}
        self._successors: dict[str, list[str]] = {step_id: [] for step_id in step_ids}
        self._predecessors: dict[str, list[str]] = {step_id: [] for step_id in step_ids}

    def add(self, awaited: str, waiting: str) -> tuple[str, ...]:
        """Take a pair in, and return nothing; or return the way back that it would close to a circle."""
        if awaited == waiting:
            return (awaited,)
        # Pearce and Kelly, "A dynamic topological sort algorithm for directed acyclic graphs" (2006): only steps between the
        # two places of a new pair can have to move.
        lowest, highest = self.positions[waiting], self.positions[awaited]
        if highest >= lowest:
            way = self._find_way(waiting, awaited)
            if way:
                return way
            forward = self._reach(self._successors, waiting, lowest, highest)
            self._reorder(self._reach(self._predecessors, awaited, lowest, highest), forward)
        self._successors[awaited].append(waiting)
        self._predecessors[waiting].append(awaited)
        return ()

    def _find_way(self, first: str, last: str) -> tuple[str, ...]:
        """Return a shortest way from one step to another; nothing where there is none.

        It is searched from both ends, always on at the end with less to look at: most ways are short, and one end alone
        would look at most of the graph.
        """
        positions = self.positions
        lowest, highest = positions[first], positions[last]
        forward: dict[str, str | None] = {first: None}
        backward: dict[str, str | None] = {last: None}
        ahead, behind = [first], [last]
        while ahead and behind:
            is_forward = len(ahead) <= len(behind)
            neighbours = self._successors if is_forward else self._predecessors
            own, other = (forward, backward) if is_forward else (backward, forward)
            edge = []
            for step_id in ahead if is_forward else behind:
                for neighbour in neighbours[step_id]:
                    if neighbour not in own and lowest <= positions[neighbour] <= highest:
                        own[neighbour] = step_id
                        if neighbour in other:
                            return (*_walk_back(forward, neighbour), *reversed(_walk_back(backward, neighbour)[:-1]))
                        edge.append(neighbour)
            ahead, behind = (edge, behind) if is_forward else (ahead, edge)
        return ()

    def _reach(self, neighbours: dict[str, list[str]], start: str, lowest: int, highest: int) -> set[str]:
        """Return what can be reached between two positions."""
        found = {start}
        queue = [start]
        for step_id in queue:
            for neighbour in neighbours[step_id]:
                if neighbour not in found and lowest <= self.positions[neighbour] <= highest:
                    found.add(neighbour)
                    queue.append(neighbour)
        return found

    def _reorder(self, before: Collection[str], behind: Collection[str]) -> None:
        """Put what leads to a step before what follows another, in the places that both have."""
        position = self.positions.__getitem__
        moved = [*sorted(before, key=position), *sorted(behind, key=position)]
        self.positions.update(zip(moved, sorted(map(position, moved)), strict=True))


def _walk_back(steps_before: dict[str, str | None], last: str) -> tuple[str, ...]:
    way: list[str] = []
    step: str | None = last
    while step is not None:
        way.append(step)
        step = steps_before[step]
    return tuple(reversed(way))


def _order_greedily(step_ids: Sequence[str], waits: Sequence[Wait]) -> list[str]:
    """Order steps one by one: always that of which the open waits weigh least, the first of equals."""
    weights: dict[str, int] = dict.fromkeys(step_ids, 0)
    followers: dict[str, list[tuple[str, int]]] = {step_id: [] for step_id in step_ids}
    for wait in waits:
        if wait.awaited != wait.waiting:
            weight = _WEIGHT_BASE**wait.need
            weights[wait.waiting] += weight
            followers[wait.awaited].append((wait.waiting, weight))
    places = {step_id: index for index, step_id in enumerate(step_ids)}
    heap = [(weight, places[step_id], step_id) for step_id, weight in weights.items()]
    heapify(heap)
    ordered: list[str] = []
    while heap:
        weight, _, step_id = heappop(heap)
        if weights.get(step_id) != weight:
            continue  # an older entry of a step that weighs less by now, or is placed
        del weights[step_id]
        ordered.append(step_id)
        for follower, share in followers[step_id]:
            if follower in weights:
                weights[follower] -= share
                heappush(heap, (weights[follower], places[follower], follower))
    return ordered


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
        """Return all waits, those that say the same only once: by the names of the steps, so that lists in another order change nothing."""
        waits: dict[tuple[str, str, WaitReason], Wait] = {}
        for wait in (*self._list_written_waits(), *self._list_data_waits()):
            waits.setdefault((wait.awaited, wait.waiting, wait.reason), wait)
        return sorted(
            waits.values(),
            key=lambda wait: (order_naturally(wait.awaited), order_naturally(wait.waiting), wait.reason),
        )

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
    return group_pairs((wait.waiting, wait) for wait in sorted(waits, key=lambda each: -each.need))
