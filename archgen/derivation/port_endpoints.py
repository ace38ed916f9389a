"""Endpoints that write (publish, serve): the outputs of a node's components, under their written or default names.

Endpoints that read (subscribe, call): the inputs of a node's components, under the names of their sources.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.derivation import ros_names
from archgen.derivation.wire.wire_names import NodeNames, WireName
from archgen.frozen import dataclass, field, replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.message_types import flow_of
from archgen.model.node import Endpoint, FlowKind, Node, PortUse, Qos, UseKind
from archgen.model.port_media import uses_ros

UNWRITTEN_USE = PortUse("publishes", "", None)
"""The entry of a port that its node does not list. Compared by identity: a written entry may look the same."""
DEFAULT_QOS = Qos()


@dataclass(frozen=True, slots=True)
class NodePart:
    """A node as an implementation of one component: its entries for the component's ports.

    `is_only_node`: no other node implements the component, so that the node carries all of its ports.
    """

    node: Node
    component: Component
    uses_by_port: Mapping[str, tuple[PortUse, ...]]
    """The entries by the port's complete id. Those of the node's other components are among them."""
    is_only_node: bool
    names: NodeNames
    given_ports: Mapping[str, str] = field(default_factory=dict)
    """Of a node that is all of a composed component: its outputs by the leaves' outputs that they pass on."""


def find_node_parts(architecture: Architecture) -> dict[str, tuple[NodePart, ...]]:
    """Return one `NodePart` for each component that a node implements, by node id, in the order of `implements`."""
    node_counts: dict[str, int] = {}
    for node in architecture.nodes.values():
        for component in node.implements:
            node_counts[component] = node_counts.get(component, 0) + 1
    node_parts: dict[str, tuple[NodePart, ...]] = {}
    for node in architecture.nodes.values():
        uses = group_pairs((use.port, use) for use in node.uses if use.port and not use.internal)
        by_port = {port: tuple(port_uses) for port, port_uses in uses.items()}
        names = NodeNames(node, architecture.distro)
        node_parts[node.id] = tuple(
            NodePart(
                node,
                architecture.components[component_id],
                by_port,
                node_counts[component_id] == 1,
                names,
                _find_given_ports(architecture, node) if node.wholes else {},
            )
            for component_id in node.implements
        )
    return node_parts


def _find_given_ports(architecture: Architecture, node: Node) -> dict[str, str]:
    return {
        leaf: output.id
        for whole in node.wholes
        for output in architecture.shells[whole].outputs.values()
        for leaf in architecture.leaf_ports_of("output", output.id)
    }


def derive_writing_endpoints(architecture: Architecture, node_part: NodePart) -> Iterator[Endpoint]:
    """Yield what a node writes for a component: one endpoint for each output and each of its names."""
    for output in node_part.component.outputs.values():
        uses = filter_uses(node_part.uses_by_port.get(output.id, ()), {"publishes", "serves"})
        if not uses_ros(output) or not (uses or node_part.is_only_node):
            continue
        for use in uses or (UNWRITTEN_USE,):
            if not use.is_open:
                continue
            yield from _endpoints_of_output(architecture, node_part, output, use)


def filter_uses(uses: Iterable[PortUse], use_kinds: Collection[UseKind]) -> tuple[PortUse, ...]:
    """Return the entries of some sections: an input and an output may have the same name, and so the same id."""
    return tuple(use for use in uses if use.use in use_kinds)


def invents_names(node: Node) -> bool:
    """Whether archgen may say what a port is called: of a program that exists, nobody but itself knows."""
    return node.status != "existing"


def flow_of_use(message: str | None, use: PortUse) -> FlowKind:
    """Return the kind of flow by the message; if unknown, by the section that the entry is written in."""
    if message is None and use.use in {"serves", "calls"}:
        return "service"
    return flow_of(message)


def _endpoints_of_output(
    architecture: Architecture, node_part: NodePart, output: Output, use: PortUse
) -> Iterator[Endpoint]:
    """Yield the endpoints of one output for one entry."""
    message = use.message or architecture.message_of(output)
    flow_kind = flow_of_use(message, use)
    default_name = ros_names.default_port_name(node_part.given_ports.get(output.id, output.id))
    for wire in node_part.names.name_use(use, flow_kind, default_name if invents_names(node_part.node) else None):
        yield Endpoint(
            node=node_part.node.id,
            use="publishes" if flow_kind == "topic" else "serves",
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow=flow_kind,
            port=output.id,
            component=node_part.component.id,
            message=message,
            type=output.type,
            qos=use.qos or DEFAULT_QOS,
            own_name=use.own_name,
            written=use is not UNWRITTEN_USE,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )


NameAndFlow = tuple[str, FlowKind]


@dataclass(frozen=True, slots=True)
class WriterIndex:
    """Writing endpoints by output and by name, and the outputs that feed each input."""

    architecture: Architecture
    shared_topics: frozenset[str]
    by_output: Mapping[str, Sequence[Endpoint]]
    by_name: Mapping[NameAndFlow, Sequence[Endpoint]]
    existing_components: frozenset[str]
    """Components whose programs all exist: what they call their outputs is not archgen's to say."""
    outputs_by_input: Mapping[str, Sequence[str]]
    """The ids of the outputs that feed an input, without those that are no ROS, by input id."""


def index_writers(
    architecture: Architecture, shared_topics: frozenset[str], writers: Iterable[Endpoint]
) -> WriterIndex:
    """Index all writing endpoints, before the reading ones are derived from them."""
    by_output: dict[str, list[Endpoint]] = defaultdict(list)
    by_name: dict[NameAndFlow, list[Endpoint]] = defaultdict(list)
    for writer in writers:
        if writer.name is not None:
            by_name[writer.name, writer.flow].append(writer)
        if writer.port:
            by_output[writer.port].append(writer)
    outputs_by_input: dict[str, list[str]] = defaultdict(list)
    for edge in architecture.edges:
        if uses_ros(architecture.outputs[edge.output]):
            outputs_by_input[edge.input].append(edge.output)
    nodes = architecture.nodes.values()
    made = {component for node in nodes if invents_names(node) for component in node.implements}
    existing = frozenset(component for node in nodes for component in node.implements) - made
    return WriterIndex(architecture, shared_topics, dict(by_output), dict(by_name), existing, dict(outputs_by_input))


def derive_reading_endpoints(writer_index: WriterIndex, node_part: NodePart) -> Iterator[Endpoint]:
    """Yield what a node reads for a component: one endpoint for each input and each topic, service or action."""
    for port in node_part.component.inputs.values():
        uses = filter_uses(node_part.uses_by_port.get(port.id, ()), {"subscribes", "calls"})
        is_open = all(use.is_open for use in uses)
        # A component's only node reads all of its inputs; several nodes read only what they list.
        if uses_ros(port) and is_open and (uses or node_part.is_only_node):
            yield from _InputReader(writer_index, node_part, port).derive_endpoints(uses)


@dataclass(frozen=True, slots=True)
class _InputReader:
    """Derives the endpoints of one node for one input."""

    writer_index: WriterIndex
    node_part: NodePart
    port: Input

    def derive_endpoints(self, uses: Sequence[PortUse]) -> Iterator[Endpoint]:
        """Yield the endpoints of the entries that the node lists for the input, and of what it need not list."""
        arriving_writers = [
            writer
            for output in self.writer_index.outputs_by_input.get(self.port.id, ())
            for writer in self._writers_of_output(output)
        ]
        writers_by_section: dict[UseKind, list[Endpoint]] = {
            "subscribes": [writer for writer in arriving_writers if writer.flow == "topic"],
            "calls": [writer for writer in arriving_writers if writer.flow != "topic"],
        }
        unnamed_sections = dict(writers_by_section) if self.node_part.is_only_node else {}
        for use in uses:
            # An entry in the wrong section is reported by `wrong-section`, and read as if it were in the right one.
            section = use.use if writers_by_section[use.use] or not arriving_writers else _opposite_section(use.use)
            unnamed_sections.pop(section, None)
            yield from (
                self._written_endpoints(use, writers_by_section[section])
                if use.topics
                else self._derived_endpoints(use, writers_by_section[section])
            )
        # An input may have both topics and services as sources: the only node also reads those it has no entry for.
        for writers in unnamed_sections.values():
            yield from self._derived_endpoints(UNWRITTEN_USE, writers) if writers else ()
        if not uses and not arriving_writers:
            yield from self._derived_endpoints(UNWRITTEN_USE, ())

    def _writers_of_output(self, output_id: str) -> Sequence[Endpoint]:
        """Return an output's writing endpoints; if no node writes it, the one that its only node would have."""
        known_writers = self.writer_index.by_output.get(output_id)
        if known_writers:
            return known_writers
        source_output = self.writer_index.architecture.outputs[output_id]
        message = self.writer_index.architecture.message_of(source_output)
        flow_kind = flow_of(message)
        use: UseKind = "publishes" if flow_kind == "topic" else "serves"
        is_known = source_output.component not in self.writer_index.existing_components
        return (
            Endpoint(
                "",
                use,
                ros_names.default_port_name(output_id) if is_known else None,
                flow_kind,
                output_id,
                source_output.component,
                message,
                source_output.type,
            ),
        )

    def _derived_endpoints(self, use: PortUse, writers: Sequence[Endpoint]) -> Iterator[Endpoint]:
        """Yield one endpoint for each topic that the sources are written on, or for the input's own default topic.

        A source without any known output has no topic that could be named: nothing is read from it.
        """
        is_generated = invents_names(self.node_part.node)
        names = self.node_part.names
        if writers:
            writers_by_topic: dict[tuple[str | None, str, FlowKind], list[Endpoint]] = {}
            for writer in writers:
                # Generated code follows its writer. A program that exists reads what it reads: the model's name, at best.
                name = writer.name if is_generated or use.own_name or not writer.is_moved else None
                key = (name, (name is None and writer.port) or "", writer.flow)
                writers_by_topic.setdefault(key, []).append(writer)
            for (name, _, flow_kind), topic_writers in writers_by_topic.items():
                wire = names.name_end(name, use.own_name, flow_kind, use.at)
                yield self._make_endpoint(use, wire, flow_kind, topic_writers)
        elif not self.port.from_written:
            flow_kind = flow_of_use(use.message or self._expected_message(), use)
            # What a program calls its port is its name where nothing feeds it.
            is_invented = is_generated and not use.own_name
            default_name = ros_names.default_port_name(self.port.id) if is_invented else None
            wire = names.name_end(default_name, use.own_name, flow_kind, use.at)
            yield self._make_endpoint(use, wire, flow_kind, ())

    def _written_endpoints(self, use: PortUse, writers: Sequence[Endpoint]) -> Iterator[Endpoint]:
        """Yield one endpoint for each topic that the node names for the input."""
        flow_kind = writers[0].flow if writers else flow_of_use(use.message or self._expected_message(), use)
        for wire in self.node_part.names.name_use(use, flow_kind, None):
            # If no source is on this topic (`unaccounted-topic` reports it), message and type still come from them.
            endpoint = self._make_endpoint(use, wire, flow_kind, [w for w in writers if w.name == wire.name] or writers)
            yield replace(endpoint, name_written=True)

    def _make_endpoint(
        self, use: PortUse, wire: WireName, flow_kind: FlowKind, writers: Sequence[Endpoint]
    ) -> Endpoint:
        return Endpoint(
            node=self.node_part.node.id,
            use="subscribes" if flow_kind == "topic" else "calls",
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow=flow_kind,
            port=self.port.id,
            component=self.node_part.component.id,
            # What the node writes outranks what the sources send, and that what the input expects.
            message=use.message or next((w.message for w in writers if w.message), None) or self._expected_message(),
            type=self.port.type or next((w.type for w in writers if w.type), None),
            qos=use.qos or DEFAULT_QOS,
            own_name=use.own_name,
            written=use is not UNWRITTEN_USE,
            sources=self._arriving_outputs(wire.name, flow_kind, writers),
            at=use.at,
            message_at=use.message_at,
        )

    def _arriving_outputs(self, name: str | None, flow_kind: FlowKind, writers: Sequence[Endpoint]) -> tuple[str, ...]:
        """Return the ids of the outputs that arrive: all that are written on the topic, unless all nodes share it."""
        # On a shared topic such as /tf every node writes: there only the input's own sources count.
        # Where a name is not known, the model's connection is all that tells.
        direct_outputs = [w.port for w in writers if w.name in {name, None} or name is None]
        topic_outputs = (
            []
            if name is None or name in self.writer_index.shared_topics
            else [w.port for w in self.writer_index.by_name.get((name, flow_kind), ())]
        )
        return tuple(dict.fromkeys(port for port in (*direct_outputs, *topic_outputs) if port))

    def _expected_message(self) -> str | None:
        """Return the message of the type that the input expects, None if unknown."""
        mapped = self.writer_index.architecture.types.get(self.port.type or "")
        return mapped.message if mapped else None


def _opposite_section(section: UseKind) -> UseKind:
    return "calls" if section == "subscribes" else "subscribes"
