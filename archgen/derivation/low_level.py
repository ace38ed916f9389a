"""Derive the low level where it is not written: planned nodes, endpoints with their absolute names, and topics.

Endpoints that follow from coordinate frames: who writes one publishes `/tf`, of a static one `/tf_static`.

Endpoints without a port: `internal` topics and services, and everything that a node without a component uses.

What passes between components of one node stays in its memory: nobody publishes it, and no message is asked for.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from archgen.derivation import ros_names
from archgen.derivation.derived_parts import DerivedParts
from archgen.derivation.media_channels import derive_channels
from archgen.derivation.parameter_names import name_ports_by_parameters
from archgen.derivation.port_endpoints import (
    DEFAULT_QOS,
    NodePart,
    WriterIndex,
    find_node_parts,
    flow_of_use,
    index_writers,
)
from archgen.derivation.wire.running_state import complete_states, list_discovery_servers
from archgen.derivation.wire.wire_names import NodeNames
from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group, Input, Output
from archgen.model.coordinate_frames import Frame
from archgen.model.derived_names import derive_node_ids
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, FlowKind, Node, PortUse, Qos, ReadyConditions, StartUp, Topic, UseKind
from archgen.model.port_media import MEMORY, nature_of, uses_ros
from archgen.model.runtime_facts import TRANSFORM_MESSAGE

_Port = TypeVar("_Port", Input, Output)


def mark_inner_memory(architecture: Architecture) -> Architecture:
    """Give ports the medium `memory` where all that they exchange stays within one node, and nobody wrote otherwise.

    A port that the node lists, with a topic of its own or not, is published or read over ROS.
    """
    only_nodes = _find_only_nodes(architecture)
    if not only_nodes:
        return architecture
    listed = {
        (use.use in {"publishes", "serves"}, use.port) for node in architecture.nodes.values() for use in node.uses
    }
    outside: tuple[set[str], set[str]] = set(), set()
    inside: tuple[set[str], set[str]] = set(), set()
    for edge in architecture.edges:
        output, entry = architecture.outputs[edge.output], architecture.inputs[edge.input]
        node = only_nodes.get(output.component)
        is_inside = (
            node is not None
            and node == only_nodes.get(entry.component)
            and not (_is_settled(output) or _is_settled(entry))
            and (True, output.id) not in listed
            and (False, entry.id) not in listed
        )
        written, read = inside if is_inside else outside
        written.add(output.id)
        read.add(entry.id)
    outputs, inputs = inside[0] - outside[0], inside[1] - outside[1]
    return _replace_ports(architecture, inputs, outputs) if inputs or outputs else architecture


def _is_settled(port: Input | Output) -> bool:
    """Whether a port's medium is not open any more: it is written, is no ROS, or reaches outside of the system."""
    return port.medium_written or not uses_ros(port) or port.external is not None


def _find_only_nodes(architecture: Architecture) -> Mapping[str, str]:
    """Return the node of each component that has one alone, as far as it implements others besides."""
    nodes_by_component: dict[str, list[str]] = {}
    for node in architecture.nodes.values():
        for component in node.implements:
            nodes_by_component.setdefault(component, []).append(node.id)
    shared = {node.id for node in architecture.nodes.values() if len(node.implements) > 1}
    return {
        component: nodes[0] for component, nodes in nodes_by_component.items() if len(nodes) == 1 and nodes[0] in shared
    }


def _replace_ports(architecture: Architecture, inputs: Collection[str], outputs: Collection[str]) -> Architecture:
    """Return the architecture with the medium `memory` at these ports."""
    changed = {name.rpartition(".")[0] for name in (*inputs, *outputs)}
    components = dict(architecture.components)
    for name in sorted(changed):
        component = components[name]
        components[name] = replace(
            component, inputs=_mark_ports(component.inputs, inputs), outputs=_mark_ports(component.outputs, outputs)
        )
    return replace(
        architecture,
        components=components,
        groups={name: _replace_components(group, components, changed) for name, group in architecture.groups.items()},
        inputs={name: components[port.component].inputs[port.name] for name, port in architecture.inputs.items()},
        outputs={name: components[port.component].outputs[port.name] for name, port in architecture.outputs.items()},
    )


def _mark_ports(ports: Mapping[str, _Port], ids: Collection[str]) -> dict[str, _Port]:
    return {name: replace(port, medium=MEMORY) if port.id in ids else port for name, port in ports.items()}


def _replace_components(group: Group, components: Mapping[str, Component], changed: Collection[str]) -> Group:
    members = {name: components[each.id] for name, each in group.components.items()}
    return replace(group, components=members) if any(each.id in changed for each in members.values()) else group


SharedKeyCounts = Mapping[tuple[str, str], int]
"""The number of nodes with an internal entry, by component id and the entry's key."""
_USE_BY_FLOW: Mapping[UseKind, Mapping[bool, UseKind]] = {
    "publishes": {True: "publishes", False: "serves"},
    "serves": {True: "publishes", False: "serves"},
    "subscribes": {True: "subscribes", False: "calls"},
    "calls": {True: "subscribes", False: "calls"},
}
"""What a use becomes for a topic (True) and for a service or action (False): the direction stays as written."""


def count_shared_keys(architecture: Architecture) -> SharedKeyCounts:
    """Count the nodes of each component that have an internal entry with the same key."""
    node_counts: dict[tuple[str, str], int] = defaultdict(int)
    for node in architecture.nodes.values():
        for key in dict.fromkeys(use.key for use in node.uses if use.internal):
            for component in node.implements:
                node_counts[component, key] += 1
    return node_counts


def derive_portless_endpoints(node: Node, distro: str | None, shared_keys: SharedKeyCounts) -> Iterator[Endpoint]:
    """Yield the endpoints of a node that have no port. `complete_message` adds the messages of readers later."""
    portless_uses = [use for use in node.uses if use.is_open and (use.internal or not node.implements)]
    if portless_uses:
        names = NodeNames(node, distro)
        for use in portless_uses:
            yield from _endpoints_of_use(node, names, use, shared_keys)


def _endpoints_of_use(node: Node, names: NodeNames, use: PortUse, shared_keys: SharedKeyCounts) -> Iterator[Endpoint]:
    """Yield the endpoints of one entry, one for each name that it lists."""
    # Below the component's name, so that internal topics of two components with the same key never meet.
    component = _find_owning_component(node, use.key, shared_keys) if use.internal else None
    default_name = ros_names.default_port_name(f"{component}.{use.key}") if component else names.expand(use.key)
    flow_kind = flow_of_use(use.message, use)
    for wire in names.name_use(use, flow_kind, default_name):
        yield Endpoint(
            node=node.id,
            use=_USE_BY_FLOW[use.use][flow_kind == "topic"],
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow=flow_kind,
            port=None,
            component=component,
            message=use.message,
            qos=use.qos or DEFAULT_QOS,
            own_name=use.own_name,
            internal=use.internal,
            written=True,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )


def _find_owning_component(node: Node, key: str, shared_keys: SharedKeyCounts) -> str | None:
    """Return the component of an internal entry: the first one of which another node has the same entry, if any."""
    shared_components = [component for component in node.implements if shared_keys[component, key] > 1]
    return next(iter(shared_components or node.implements), None)


def complete_message(endpoint: Endpoint, writer_index: WriterIndex) -> Endpoint:
    """Add the message, type and flow of a writer with the same name to a reading endpoint that has no message."""
    if endpoint.message is not None or endpoint.name is None or endpoint.use in {"publishes", "serves"}:
        return endpoint
    # A caller without a message does not say whether it calls a service or an action.
    flows: tuple[FlowKind, ...] = ("topic",) if endpoint.flow == "topic" else ("service", "action")
    for flow_kind in flows:
        for writer in writer_index.by_name.get((endpoint.name, flow_kind), ()):
            if writer.message:
                return replace(endpoint, message=writer.message, flow=flow_kind, type=writer.type)
    return endpoint


# tf2_ros/qos.hpp: DynamicBroadcasterQoS and StaticBroadcasterQoS.
_QOS_BY_TOPIC = {"/tf": Qos(depth=100), "/tf_static": Qos(durability="transient_local", depth=1)}


def index_written_frames(architecture: Architecture) -> Mapping[str, tuple[Frame, ...]]:
    """Return the frames that each node writes, by node id.

    Of a component with several nodes nobody knows which one writes them: as with ports, each has to say what it carries.
    """
    if not architecture.frames:
        return {}
    writing_nodes: dict[tuple[str, str], list[str]] = {}
    for node in architecture.nodes.values():
        writing_nodes.setdefault(("node", node.id), []).append(node.id)
        for component in (*node.implements, *node.wholes):
            writing_nodes.setdefault(("component", component), []).append(node.id)
    frames_by_node: dict[str, tuple[Frame, ...]] = {}
    for frame in architecture.frames.values():
        nodes = writing_nodes.get((frame.by_kind, frame.by or ""), ())
        # A root is placed in nothing: there is nothing to write.
        if len(nodes) == 1 and frame.parent is not None:
            frames_by_node[nodes[0]] = (*frames_by_node.get(nodes[0], ()), frame)
    return frames_by_node


def derive_frame_endpoints(
    node: Node, distro: str | None, written_frames: Iterable[Frame], own_endpoints: Sequence[Endpoint]
) -> Iterator[Endpoint]:
    """Yield what a node publishes for its frames, less the topics that it names itself (in a namespace too)."""
    written_topics = {endpoint.label.rpartition("/")[2] for endpoint in own_endpoints if endpoint.use == "publishes"}
    first_frames: dict[str, Frame] = {}
    for frame in written_frames:
        if frame.topic.removeprefix("/") not in written_topics:
            first_frames.setdefault(frame.topic, frame)
    names = NodeNames(node, distro)
    for topic, frame in first_frames.items():
        wire = names.name_end(topic, None, "topic")
        yield Endpoint(
            node=node.id,
            use="publishes",
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow="topic",
            port=None,
            component=frame.by if frame.by in node.implements else next(iter(node.implements), None),
            message=TRANSFORM_MESSAGE,
            qos=_QOS_BY_TOPIC[topic],
            internal=True,
            at=frame.at,
        )


def derive_low_level(architecture: Architecture, memory: DerivedParts | None = None) -> Architecture:
    """Add a planned node for each component without any, and the endpoints, topics and channels of all nodes.

    What `memory` knows from another version of the project is taken over where it is the same.
    """
    memory = memory or DerivedParts()
    architecture = name_ports_by_parameters(mark_inner_memory(architecture))
    nodes = dict(architecture.nodes) | {node.id: node for node in _make_planned_nodes(architecture, memory)}
    nodes |= {node.id: node for node in _make_discovery_servers(architecture, nodes)}
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


def _make_discovery_servers(architecture: Architecture, nodes: Collection[str]) -> Iterator[Node]:
    """Yield the programs by which the nodes of all hosts find one another."""
    for number, host in enumerate(list_discovery_servers(architecture)):
        names = (f"{host.id}_discovery_server{'_' * length}" for length in range(len(nodes) + 1))
        yield Node(
            id=next(each for each in names if each not in nodes),
            title=f"Discovery server of {host.title}",
            kinds=("program",),
            command=("fastdds", "discovery", "-i", str(number), "-p", str(host.discovery_server)),
            host=host.id,
            start=StartUp(phase="network", ready=ReadyConditions(log="Server is running"), respawn=True),
            written=False,
        )


def _needs_ros(component: Component) -> bool:
    """Whether a node of ROS is planned for a component: none of its ports says that it is anything else, or one is ROS."""
    is_other = any(nature_of(port) == "other" for port in component.ports)
    return not is_other or any(map(uses_ros, component.ports))
