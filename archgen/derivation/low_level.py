"""Derive the low level where it is not written: planned nodes, endpoints with their absolute names, and topics."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.derivation import ros_names
from archgen.derivation.derived_parts import DerivedParts
from archgen.derivation.frame_endpoints import derive_frame_endpoints, index_written_frames
from archgen.derivation.inner_memory import mark_inner_memory
from archgen.derivation.media_channels import derive_channels
from archgen.derivation.parameter_names import name_ports_by_parameters
from archgen.derivation.port_endpoints import NodePart, find_node_parts, index_writers
from archgen.derivation.portless_endpoints import complete_message, count_shared_keys, derive_portless_endpoints
from archgen.derivation.wire.running_state import complete_states
from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.derived_names import derive_node_ids
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, FlowKind, Node, Topic
from archgen.model.port_media import nature_of, uses_ros


def derive_low_level(architecture: Architecture, memory: DerivedParts | None = None) -> Architecture:
    """Add a planned node for each component without any, and the endpoints, topics and channels of all nodes.

    What `memory` knows from another version of the project is taken over where it is the same.
    """
    memory = memory or DerivedParts()
    architecture = name_ports_by_parameters(mark_inner_memory(architecture))
    nodes = dict(architecture.nodes) | {node.id: node for node in _make_planned_nodes(architecture, memory)}
    with_planned = replace(architecture, nodes=nodes)
    shared_topics = ros_names.shared_topic_names(architecture.shared_topics)
    memory.start_version(architecture, shared_topics)
    node_parts = memory.recall_parts(find_node_parts(with_planned))
    endpoints = _derive_endpoints(with_planned, node_parts, shared_topics, memory)
    endpoints = complete_states(with_planned, endpoints, memory)
    return replace(
        with_planned,
        endpoints=endpoints,
        topics=_gather_topics(endpoints, shared_topics, architecture.types, memory),
        channels=derive_channels(with_planned, node_parts),
    )


def _derive_endpoints(
    architecture: Architecture,
    node_parts: Mapping[str, tuple[NodePart, ...]],
    shared_topics: frozenset[str],
    memory: DerivedParts,
) -> tuple[Endpoint, ...]:
    """Derive the endpoints of all nodes, in the order of nodes."""
    # All writing endpoints come first: a reader takes its topic's name and message from those that write it.
    shared_keys = count_shared_keys(architecture)
    writing = {
        node_id: memory.derive_writing(architecture, node_id, node_parts[node_id]) for node_id in architecture.nodes
    }
    portless = {
        node_id: list(derive_portless_endpoints(node, architecture.distro, shared_keys))
        for node_id, node in architecture.nodes.items()
    }
    portless_writers = (e for endpoints in portless.values() for e in endpoints if e.use in {"publishes", "serves"})
    writer_index = index_writers(
        architecture, shared_topics, [*(e for endpoints in writing.values() for e in endpoints), *portless_writers]
    )
    frames_by_node = index_written_frames(architecture)
    # For each node: what it writes, what it reads, what has no port, then what follows from frames.
    all_endpoints: list[Endpoint] = []
    for node_id in architecture.nodes:
        all_endpoints += writing[node_id]
        all_endpoints += memory.derive_reading(writer_index, node_id, node_parts[node_id])
        all_endpoints += (complete_message(endpoint, writer_index) for endpoint in portless[node_id])
        if node_id in frames_by_node:
            own_endpoints = (*writing[node_id], *portless[node_id])
            all_endpoints += derive_frame_endpoints(
                architecture.nodes[node_id], architecture.distro, frames_by_node[node_id], own_endpoints
            )
    return tuple(all_endpoints)


@dataclass(slots=True)
class _EndpointUsers:
    """The endpoints of one topic, service or action."""

    writers: list[Endpoint] = field(default_factory=list)
    readers: list[Endpoint] = field(default_factory=list)


def _gather_topics(
    endpoints: Iterable[Endpoint],
    shared_topics: frozenset[str],
    types: Mapping[str, ConceptualType],
    memory: DerivedParts,
) -> dict[str, Topic]:
    """Gather endpoints by name and flow; where a name is not known, by the model's connections. Further flows with the same name get a key of their own: `/name (service)`."""
    users: dict[tuple[str, FlowKind], _EndpointUsers] = {}
    for endpoint in endpoints:
        name = endpoint.label
        topic_users = users.get((name, endpoint.flow))
        if topic_users is None:
            topic_users = users[name, endpoint.flow] = _EndpointUsers()
        (topic_users.writers if endpoint.use in {"publishes", "serves"} else topic_users.readers).append(endpoint)
    topics: dict[str, Topic] = {}
    for (name, flow), topic_users in users.items():
        key = name if name not in topics else f"{name} ({flow})"
        known = memory.find_topic(name, flow, topic_users.writers, topic_users.readers)
        if known is None:
            is_shared = flow == "topic" and name in shared_topics
            known = _make_topic(name, flow, topic_users, types, is_shared=is_shared)
            memory.keep_topic(known)
        topics[key] = known
    return topics


def _make_topic(
    name: str, flow: FlowKind, users: _EndpointUsers, types: Mapping[str, ConceptualType], *, is_shared: bool
) -> Topic:
    """Make a topic. Its types are those of the writers, else of the readers; its size is the largest known one."""
    type_names = dict.fromkeys(e.type for e in users.writers or users.readers if e.type)
    sizes = [types[type_name].size for type_name in type_names if type_name in types]
    return Topic(
        name=name,
        flow=flow,
        messages=tuple(dict.fromkeys(e.message for e in (*users.writers, *users.readers) if e.message)),
        types=tuple(type_names),
        writers=tuple(users.writers),
        readers=tuple(users.readers),
        size=max((size for size in sizes if size), key=lambda size: size.value, default=None),
        shared=is_shared,
    )


def _make_planned_nodes(architecture: Architecture, memory: DerivedParts) -> Iterator[Node]:
    """Yield the nodes to add, in the order of components."""
    implemented_ids = {component for node in architecture.nodes.values() for component in node.implements}
    components = [each for each in architecture.components.values() if each.id not in implemented_ids]
    node_ids = derive_node_ids(
        [each.id for each in components], {**architecture.components, **architecture.shells}, architecture.nodes
    )
    for component in components:
        node = memory.find_planned(component, node_ids[component.id])
        if node is None:
            node = _make_planned_node(component, node_ids[component.id])
            memory.keep_planned(component, node)
        yield node


def _make_planned_node(component: Component, name: str) -> Node:
    return Node(
        id=name,
        title=component.title,
        implements=(component.id,),
        owner=component.owner,
        co_owners=component.co_owners,
        name=name,
        kinds=("node",) if _needs_ros(component) else ("program",),
        status="planned",
        timing={component.id: component.timing} if component.timing else {},
        written=False,
    )


def _needs_ros(component: Component) -> bool:
    """Whether a node of ROS is planned for a component: none of its ports says that it is anything else, or one is ROS."""
    is_other = any(nature_of(port) == "other" for port in component.ports)
    return not is_other or any(map(uses_ros, component.ports))
