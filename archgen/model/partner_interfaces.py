"""Find the interfaces between two partners: each output of one that the other reads, with all its readers.

An end belongs to the owners of its component, and to those of the nodes that carry the port if they differ. If both ends of
a flow belong to both partners, it is theirs together and not between them. Topics that join nodes of both without a
connection (/tf, for instance) are interfaces too.

Who answers for the ends of an interface: the owners of a component, and of the nodes that carry its ports. Settings pass
between two, too: frames, parameters and operations of one that the other one uses.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Literal

from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.component import Component, Input, Output
from archgen.model.coordinate_frames import Frame, index_child_frames
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.parameter import Operation, Parameter
from archgen.model.parameter_values import canonical_name
from archgen.model.port_media import is_physical, label_of_medium, nature_of
from archgen.model.ros_distro import is_ros_1

InterfaceFlow = Literal["topic", "service", "action", "physical"]
PartnerPair = tuple[str, str]
"""Ids of two partners; for an interface: the giver, then the taker."""


@dataclass(frozen=True, slots=True)
class PartnerInterface:
    """What one partner gives another: an output, or (`output` is None) a topic that only their nodes share.

    `key` is the output's complete id, or the topic's name. `giver_endpoints` and `taker_endpoints` are endpoints of
    nodes, the latter only of this partner; `inputs` are the taker's ports; `other_inputs` those of everybody else.
    """

    key: str
    pair: PartnerPair
    flow: InterfaceFlow
    output: Output | None = None
    inputs: tuple[Input, ...] = ()
    other_inputs: tuple[Input, ...] = ()
    giver_endpoints: tuple[Endpoint, ...] = ()
    taker_endpoints: tuple[Endpoint, ...] = ()
    type: str | None = None
    message: str | None = None

    @property
    def medium(self) -> str:
        """Return how what it travels over is called, if that is data but no ROS; else nothing."""
        ports = (*((self.output,) if self.output else ()), *self.inputs)
        return next((label_of_medium(port) for port in ports if nature_of(port) == "other"), "")

    @property
    def anchor(self) -> str:
        """Return the anchor of its section; it includes the giver, since a topic may flow both ways."""
        return f"interface:{self.key}:{self.pair[0]}"

    @property
    def topic_names(self) -> tuple[str, ...]:
        """Return the topics (services, actions) that carry it."""
        return tuple(dict.fromkeys(endpoint.name for endpoint in self.giver_endpoints if endpoint.name))


def find_interfaces_between(
    architecture: Architecture, first_partner: str, second_partner: str
) -> tuple[PartnerInterface, ...]:
    """Return the interfaces between two partners, those the first one gives before those of the second."""
    pair, ends = (first_partner, second_partner), list_interface_ends(architecture)
    return _find_of_pair(_InterfaceFinder(architecture, pair, ends, architecture.edges, architecture.topics.values()))


def find_all_interfaces(architecture: Architecture) -> tuple[PartnerInterface, ...]:
    """Return the interfaces between all partners, pair by pair in the order of their ids."""
    # Each pair looks only at what may be between the two: with a dozen partners nearly nothing is.
    ends = list_interface_ends(architecture)
    edges, topics = _group_edges(ends), _group_topics(ends)
    return tuple(
        interface
        for pair in sorted({*edges, *topics})
        for interface in _find_of_pair(
            _InterfaceFinder(architecture, pair, ends, edges.get(pair, ()), topics.get(pair, ()))
        )
    )


def _find_of_pair(finder: _InterfaceFinder) -> tuple[PartnerInterface, ...]:
    interfaces = [*finder.find_output_interfaces(), *finder.find_topic_interfaces()]
    return tuple(interface for giver in finder.pair for interface in interfaces if interface.pair[0] == giver)


def _group_edges(ends: InterfaceEnds) -> Mapping[PartnerPair, list[PortEdge]]:
    """Return for each pair of partners all edges of the outputs that may be between them."""
    edges_by_output = group_pairs((edge.output, edge) for edge in ends.architecture.edges)
    edges_by_pair: dict[PartnerPair, list[PortEdge]] = {}
    for output, edges in edges_by_output.items():
        givers = ends.list_port_owners(ends.architecture.outputs[output])
        takers = {owner for edge in edges for owner in ends.list_port_owners(ends.architecture.inputs[edge.input])}
        for pair in _pair_partners(givers, takers):
            edges_by_pair.setdefault(pair, []).extend(edges)
    return edges_by_pair


def _group_topics(ends: InterfaceEnds) -> Mapping[PartnerPair, list[Topic]]:
    topics_by_pair: dict[PartnerPair, list[Topic]] = {}
    for topic in ends.architecture.topics.values():
        givers, takers = (
            {owner for endpoint in endpoints for owner in ends.list_endpoint_owners(endpoint)}
            for endpoints in (topic.writers, topic.readers)
        )
        for pair in _pair_partners(givers, takers):
            topics_by_pair.setdefault(pair, []).append(topic)
    return topics_by_pair


def _pair_partners(givers: Collection[str], takers: Collection[str]) -> list[PartnerPair]:
    """Return the pairs of a giver and a taker, sorted as the ids of each are."""
    return sorted({(min(giver, taker), max(giver, taker)) for giver in givers for taker in takers if giver != taker})


@dataclass(frozen=True, slots=True)
class _InterfaceFinder:
    architecture: Architecture
    pair: PartnerPair
    ends: InterfaceEnds
    edges: Iterable[PortEdge]
    topics: Iterable[Topic]

    def find_output_interfaces(self) -> Iterator[PartnerInterface]:
        """Yield an interface for each output and direction: the connections between components."""
        architecture = self.architecture
        readers: dict[tuple[str, PartnerPair], dict[str, None]] = {}
        other_readers: dict[str, dict[str, None]] = {}
        for edge in self.edges:
            direction = self._find_direction(architecture.outputs[edge.output], architecture.inputs[edge.input])
            if direction:
                readers.setdefault((edge.output, direction), {})[edge.input] = None
            else:
                other_readers.setdefault(edge.output, {})[edge.input] = None
        for (output, direction), inputs in sorted(readers.items(), key=lambda entry: self.ends.positions[entry[0][0]]):
            yield self._make_output_interface(
                architecture.outputs[output], direction, list(inputs), list(other_readers.get(output, ()))
            )

    def _make_output_interface(
        self, output: Output, direction: PartnerPair, input_ids: Iterable[str], other_ids: Iterable[str]
    ) -> PartnerInterface:
        architecture = self.architecture
        partner_inputs = [architecture.inputs[input_id] for input_id in input_ids]
        message = architecture.message_of(output)
        return PartnerInterface(
            output.id,
            direction,
            "physical" if is_physical(output) else architecture.flow_of(output),
            output,
            tuple(partner_inputs),
            tuple(architecture.inputs[input_id] for input_id in other_ids),
            self._writing_endpoints(output),
            tuple(endpoint for port in partner_inputs for endpoint in self._reading_endpoints(port, output)),
            output.type,
            message,
        )

    def _writing_endpoints(self, output: Output) -> tuple[Endpoint, ...]:
        return tuple(self.ends.endpoints_by_port.get((True, output.id), ()))

    def _reading_endpoints(self, port: Input, output: Output) -> tuple[Endpoint, ...]:
        return tuple(
            endpoint
            for endpoint in self.ends.endpoints_by_port.get((False, port.id), ())
            if output.id in endpoint.sources
        )

    def _find_direction(self, output: Output, port: Input) -> PartnerPair | None:
        """Return who gives whom: by the components' owners, else by those of their nodes as well."""
        architecture = self.architecture
        giver, taker = architecture.components[output.component], architecture.components[port.component]
        if set(self.pair) <= set(giver.owners) and set(self.pair) <= set(taker.owners):
            return None
        return self._direction_between(giver.owners, taker.owners) or self._direction_between(
            (*giver.owners, *self._foreign_node_owners(self._writing_endpoints(output))),
            (*taker.owners, *self._foreign_node_owners(self._reading_endpoints(port, output))),
        )

    def _foreign_node_owners(self, endpoints: Iterable[Endpoint]) -> Iterator[str]:
        return (owner for endpoint in endpoints for owner in self.ends.foreign_owners[endpoint.node])

    def _direction_between(self, givers: Collection[str], takers: Collection[str]) -> PartnerPair | None:
        first, second = self.pair
        # Owned together at both ends: nothing flows between them.
        if {first, second} <= set(givers) and {first, second} <= set(takers):
            return None
        if first in givers and second in takers:
            return first, second
        return (second, first) if second in givers and first in takers else None

    def find_topic_interfaces(self) -> Iterator[PartnerInterface]:
        """Yield an interface for each topic that joins nodes of both partners without a connection."""
        for topic in self.topics:
            endpoints_by_direction: dict[PartnerPair, tuple[dict[int, Endpoint], dict[int, Endpoint]]] = {}
            for writer in filter(self._is_of_pair, topic.writers):
                for reader in filter(self._is_of_pair, topic.readers):
                    direction = self._direction_of_pair(writer, reader)
                    if direction:
                        givers, takers = endpoints_by_direction.setdefault(direction, ({}, {}))
                        # By object identity: endpoints are not hashable by value, and each must be listed once.
                        givers[id(writer)], takers[id(reader)] = writer, reader
            for direction, (givers, takers) in endpoints_by_direction.items():
                yield self._make_topic_interface(topic, direction, tuple(givers.values()), tuple(takers.values()))

    def _direction_of_pair(self, writer: Endpoint, reader: Endpoint) -> PartnerPair | None:
        # What is connected as ports is an interface of the output already.
        if writer.node == reader.node or (writer.port is not None and writer.port in reader.sources):
            return None
        return self._direction_between(self.ends.list_endpoint_owners(writer), self.ends.list_endpoint_owners(reader))

    def _is_of_pair(self, endpoint: Endpoint) -> bool:
        return not set(self.pair).isdisjoint(self.ends.list_endpoint_owners(endpoint))

    def _make_topic_interface(
        self, topic: Topic, direction: PartnerPair, givers: tuple[Endpoint, ...], takers: tuple[Endpoint, ...]
    ) -> PartnerInterface:
        message = topic.messages[0] if len(topic.messages) == 1 else None
        type_ = topic.types[0] if len(topic.types) == 1 else None
        return PartnerInterface(
            topic.name,
            direction,
            topic.flow,
            giver_endpoints=givers,
            taker_endpoints=takers,
            type=type_,
            message=message,
        )


def components_at_ends(
    architecture: Architecture, interface: PartnerInterface
) -> tuple[tuple[Component, ...], tuple[Component, ...]]:
    """Return the giving and the taking components, each once."""
    giving_ids = (
        [interface.output.component]
        if interface.output
        else [endpoint.component for endpoint in interface.giver_endpoints]
    )
    taking_ids = [endpoint.component for endpoint in (interface.inputs or interface.taker_endpoints)]
    components_by_id: Mapping[str, Component] = architecture.components
    return (
        tuple(components_by_id[name] for name in dict.fromkeys(giving_ids) if name),
        tuple(components_by_id[name] for name in dict.fromkeys(taking_ids) if name),
    )


def list_givers(architecture: Architecture, interface: PartnerInterface) -> tuple[Endpoint, ...]:
    """Return the giving endpoints of nodes that somebody wrote, else those of the planned ones."""
    written = tuple(endpoint for endpoint in interface.giver_endpoints if architecture.nodes[endpoint.node].written)
    return written or interface.giver_endpoints


def foreign_owners(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """Return a node's owners if somebody wrote others than those of its components."""
    component_owners = {owner for component in node.implements for owner in architecture.components[component].owners}
    return node.owners if set(node.owners) != component_owners else ()


@dataclass(frozen=True, slots=True)
class InterfaceEnds:
    """What all pairs of partners look up: the endpoints of each port by `(writes, port)`, and the owners of nodes that
    differ from those of their components. `positions` are those of the outputs in the architecture.
    """

    architecture: Architecture
    endpoints_by_port: Mapping[tuple[bool, str], list[Endpoint]]
    foreign_owners: Mapping[str, tuple[str, ...]]
    positions: Mapping[str, int]

    def list_port_owners(self, port: Input | Output) -> set[str]:
        """Return all who may answer for a port: the owners of its component, and of the nodes that carry it."""
        endpoints = self.endpoints_by_port.get((isinstance(port, Output), port.id), ())
        foreign = (owner for endpoint in endpoints for owner in self.foreign_owners[endpoint.node])
        return {*self.architecture.components[port.component].owners, *foreign}

    def list_endpoint_owners(self, endpoint: Endpoint) -> tuple[str, ...]:
        """Return who answers for an endpoint."""
        written_owners = (
            self.architecture.components[endpoint.component].owners
            if endpoint.component
            else self.architecture.nodes[endpoint.node].owners
        )
        return (*written_owners, *self.foreign_owners[endpoint.node])


def list_interface_ends(architecture: Architecture) -> InterfaceEnds:
    """Return who answers for what in an architecture."""
    endpoints_by_port: dict[tuple[bool, str], list[Endpoint]] = {}
    for endpoint in architecture.list_endpoints():
        if endpoint.port is not None:
            key = endpoint.use in {"publishes", "serves"}, endpoint.port
            endpoints_by_port.setdefault(key, []).append(endpoint)
    owners_by_node = {node.id: foreign_owners(architecture, node) for node in architecture.nodes.values()}
    positions = {output: position for position, output in enumerate(architecture.outputs)}
    return InterfaceEnds(architecture, endpoints_by_port, owners_by_node, positions)


@dataclass(frozen=True, slots=True)
class ParameterSetter:
    """What sets a parameter: a node, or (`is_node` False) the instance of a component type, with the value it gives."""

    id: str
    value: object
    is_node: bool


@dataclass(frozen=True, slots=True)
class SharedParameter:
    """A parameter that `giver` declares at a component, and that `taker` sets."""

    component: Component
    parameter: Parameter
    giver: str
    setters: tuple[ParameterSetter, ...]


@dataclass(frozen=True, slots=True)
class SharedOperation:
    """An operation of a component of `giver` that has an interface with the other partner."""

    component: Component
    operation: Operation
    giver: str


def _list_declaring_owners(architecture: Architecture, component: Component) -> tuple[str, ...]:
    """Return the partners who answer for what a component can be set to: its type's owner, else its own owners."""
    component_type = architecture.component_types.get(component.type_name)
    return (component_type.owner,) if component_type and component_type.owner else component.owners


def is_set_by_instance(architecture: Architecture, component: Component, name: str) -> bool:
    """Whether an instance gives a parameter of its type a value of its own."""
    component_type = architecture.component_types.get(component.type_name)
    declared = component_type.parameters.get(name) if component_type else None
    parameter = component.parameters.get(name)
    if declared is None or parameter is None or parameter.value is None or parameter.handed_from:
        return False
    # What it has from its type stands where the type writes it.
    return parameter.value_at != declared.value_at


def list_set_values(architecture: Architecture, node: Node, name: str) -> list[object]:
    """Return the values that a node gives to a parameter, by itself or in its files."""
    ros_1 = is_ros_1(architecture.distro)
    wanted_name = canonical_name(name, ros_1=ros_1)
    return [
        value.value
        for value in (*node.file_values, *node.own_values)
        if canonical_name(value.name, ros_1=ros_1) == wanted_name
    ]


def find_shared_parameters(architecture: Architecture, pair: tuple[str, str]) -> tuple[SharedParameter, ...]:
    """Return the parameters between two partners, in the order of components."""
    return tuple(
        SharedParameter(component, parameter, giver, setters)
        for component in architecture.list_described_components()
        if component.parameters
        for giver, taker in _list_directions(_list_declaring_owners(architecture, component), pair)
        for parameter in component.parameters.values()
        if (setters := tuple(_find_setters(architecture, component, parameter.name, taker)))
    )


def _list_directions(owners: Iterable[str], pair: tuple[str, str]) -> Iterator[tuple[str, str]]:
    """Yield who declares and who may set; what belongs to both is theirs together."""
    yield from ((giver, taker) for giver, taker in (pair, pair[::-1]) if giver in owners and taker not in owners)


def _find_setters(
    architecture: Architecture, component: Component, name: str, partner: str
) -> Iterator[ParameterSetter]:
    if partner in component.owners and is_set_by_instance(architecture, component, name):
        yield ParameterSetter(component.id, component.parameters[name].value, is_node=False)
    for node in architecture.nodes_implementing(component.id):
        if partner in node.owners:
            values = list_set_values(architecture, node, name)
            if values:
                yield ParameterSetter(node.id, values[-1], is_node=True)


def find_shared_operations(
    architecture: Architecture, component_ids: Iterable[str], pair: tuple[str, str]
) -> tuple[SharedOperation, ...]:
    """Return the operations of these components, and of those around them, that are no partner's private matter."""
    shown: dict[str, Component] = {}
    for component_id in component_ids:
        component = architecture.components[component_id]
        shown |= {each.id: each for each in (component, *architecture.list_around(component))}
    return tuple(
        SharedOperation(component, operation, giver)
        for component in shown.values()
        for giver, _ in _list_directions(_list_declaring_owners(architecture, component), pair)
        for operation in component.operations.values()
        if operation.visibility in {None, "public"}
    )


@dataclass(frozen=True, slots=True)
class SharedFrame:
    """A frame that `giver` writes, with the ids of what `taker` uses it for: ports, then frames placed in it."""

    frame: Frame
    giver: str
    taker: str
    ports: tuple[str, ...] = ()
    frames: tuple[str, ...] = ()


def find_shared_frames(architecture: Architecture, first_partner: str, second_partner: str) -> tuple[SharedFrame, ...]:
    """Return the frames between two partners, those that the first one writes before those of the second."""
    pairs = ((first_partner, second_partner), (second_partner, first_partner))
    return tuple(shared for giver, taker in pairs for shared in _find_given_frames(architecture, giver, taker))


def _list_frame_owners(architecture: Architecture, frame: Frame) -> tuple[str, ...]:
    """Return the partners who own what writes a frame."""
    writers = architecture.nodes if frame.by_kind == "node" else architecture.components
    writer = writers.get(frame.by or "")
    return writer.owners if writer else ()


def _find_given_frames(architecture: Architecture, giver: str, taker: str) -> Iterator[SharedFrame]:
    ports_by_frame: dict[str | None, dict[str, None]] = {}
    # Here and below: what belongs to both is theirs together.
    for port in architecture.list_ports():
        owners = architecture.components[port.component].owners
        if taker in owners and giver not in owners:
            ports_by_frame.setdefault(architecture.frame_of(port), {})[port.id] = None
    children = index_child_frames(architecture.frames)
    for frame in architecture.frames.values():
        writers = _list_frame_owners(architecture, frame)
        if giver not in writers or taker in writers or frame.parent is None:
            continue
        frames = tuple(
            child.id
            for child in children.get(frame.id, ())
            if taker in (owners := _list_frame_owners(architecture, child)) and giver not in owners
        )
        ports = tuple(ports_by_frame.get(frame.id, ()))
        if ports or frames:
            yield SharedFrame(frame, giver, taker, ports, frames)
