"""What derivation remembers of one version of a project for the next: what follows from the same nodes and components.

Linking takes over the components and nodes that two versions share, as the same objects; so that is what is asked here.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from archgen.derivation.port_endpoints import NodePart, WriterIndex, derive_reading_endpoints, derive_writing_endpoints
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.known_parts import KnownParts
from archgen.model.node import Endpoint, FlowKind, Node, Topic


class _KnownReading(NamedTuple):
    """What a node reads, and what that was derived from besides the node."""

    parts: tuple[NodePart, ...]
    feeds: tuple[object, ...]
    """For each of its inputs, the outputs that feed it, and who writes these."""
    topic_ports: tuple[tuple[str | None, ...], ...]
    """For each endpoint, the ports of all that write on its topic."""
    endpoints: tuple[Endpoint, ...]


class DerivedParts:
    """Parts of the versions of one project that were derived so far, by id."""

    def __init__(self) -> None:
        self._settings: object = None
        self._planned: KnownParts[tuple[Component, Node]] = KnownParts()
        self._forget_parts()

    def _forget_parts(self) -> None:
        self._node_parts: KnownParts[tuple[NodePart, ...]] = KnownParts()
        self._writing: KnownParts[tuple[tuple[NodePart, ...], tuple[Endpoint, ...]]] = KnownParts()
        self._reading: KnownParts[_KnownReading] = KnownParts()
        self._completed: KnownParts[tuple[Node, tuple[Endpoint, ...], object, tuple[Endpoint, ...]]] = KnownParts()
        self._topics: dict[FlowKind, KnownParts[Topic]] = {}

    def start_version(self, architecture: Architecture, shared_topics: frozenset[str]) -> None:
        """Forget everything where types are mapped to other messages, other topics are shared by all nodes, or ROS is another."""
        types = {name: (each.message, each.size and each.size.text) for name, each in architecture.types.items()}
        settings = (types, shared_topics, architecture.distro)
        if self._settings != settings:
            self._settings = settings
            self._forget_parts()

    def find_planned(self, component: Component, node_id: str) -> Node | None:
        """Return the node with this id that was planned for a component in another version."""
        known_parts = self._planned.list_known(component.id)
        return next((node for known, node in known_parts if known is component and node.id == node_id), None)

    def keep_planned(self, component: Component, node: Node) -> None:
        """Remember the node that is planned for a component."""
        self._planned.keep_part(component.id, (component, node))

    def recall_parts(self, node_parts: Mapping[str, tuple[NodePart, ...]]) -> dict[str, tuple[NodePart, ...]]:
        """Return the parts of nodes, as the same objects where they are as in another version."""
        return {node_id: self._recall_part(node_id, parts) for node_id, parts in node_parts.items()}

    def _recall_part(self, node_id: str, parts: tuple[NodePart, ...]) -> tuple[NodePart, ...]:
        for known in self._node_parts.list_known(node_id):
            if len(known) == len(parts) and all(map(_is_same_part, known, parts)):
                return known
        self._node_parts.keep_part(node_id, parts)
        return parts

    def derive_writing(
        self, architecture: Architecture, node_id: str, parts: tuple[NodePart, ...]
    ) -> Sequence[Endpoint]:
        """Return what a node writes."""
        for known_parts, known_endpoints in self._writing.list_known(node_id):
            if known_parts is parts:
                return known_endpoints
        endpoints = tuple(each for part in parts for each in derive_writing_endpoints(architecture, part))
        self._writing.keep_part(node_id, (parts, endpoints))
        return endpoints

    def derive_reading(self, index: WriterIndex, node_id: str, parts: tuple[NodePart, ...]) -> Sequence[Endpoint]:
        """Return what a node reads."""
        feeds = tuple(_list_feeds(index, parts))
        for known in self._reading.list_known(node_id):
            if (
                known.parts is parts
                and known.feeds == feeds
                and known.topic_ports == _list_topic_ports(index, known.endpoints)
            ):
                return known.endpoints
        endpoints = tuple(each for part in parts for each in derive_reading_endpoints(index, part))
        reading = _KnownReading(parts, feeds, _list_topic_ports(index, endpoints), endpoints)
        self._reading.keep_part(node_id, reading)
        return endpoints

    def complete_endpoints(
        self, node: Node, endpoints: tuple[Endpoint, ...], state: object, complete: Callable[[Endpoint], Endpoint]
    ) -> Sequence[Endpoint]:
        """Return the ends of a node with what follows from its state."""
        for known_node, known_endpoints, known_state, completed in self._completed.list_known(node.id):
            if (
                known_node is node
                and known_state == state
                and len(known_endpoints) == len(endpoints)
                and all(map(operator.is_, known_endpoints, endpoints))
            ):
                return completed
        completed = tuple(map(complete, endpoints))
        self._completed.keep_part(node.id, (node, endpoints, state, completed))
        return completed

    def find_topic(
        self, name: str, flow: FlowKind, writers: Sequence[Endpoint], readers: Sequence[Endpoint]
    ) -> Topic | None:
        """Return a topic of another version that has the same users."""
        known_topics = self._topics.setdefault(flow, KnownParts()).list_known(name)
        return next(
            (
                known
                for known in known_topics
                if len(known.writers) == len(writers)
                and len(known.readers) == len(readers)
                and all(map(operator.is_, known.writers, writers))
                and all(map(operator.is_, known.readers, readers))
            ),
            None,
        )

    def keep_topic(self, topic: Topic) -> None:
        """Remember a topic."""
        self._topics.setdefault(topic.flow, KnownParts()).keep_part(topic.name, topic)


def _is_same_part(known_part: NodePart, part: NodePart) -> bool:
    return (
        known_part.node is part.node
        and known_part.component is part.component
        and known_part.is_only_node == part.is_only_node
        and known_part.given_ports == part.given_ports
    )


def _list_feeds(index: WriterIndex, parts: Iterable[NodePart]) -> Iterator[object]:
    """Yield what endpoints that read are derived from, besides the node: outputs, and who writes them."""
    for part in parts:
        for port_id in part.component.inputs:
            input_id = f"{part.component.id}.{port_id}"
            for output in index.outputs_by_input.get(input_id, ()):
                yield input_id, output
                # Nobody writes it: what its own node would is derived from the output.
                yield index.by_output.get(output) or index.architecture.outputs[output]


def _list_topic_ports(index: WriterIndex, endpoints: Iterable[Endpoint]) -> tuple[tuple[str | None, ...], ...]:
    by_name = index.by_name
    return tuple(tuple([w.port for w in by_name.get((each.name or "", each.flow), ())]) for each in endpoints)
