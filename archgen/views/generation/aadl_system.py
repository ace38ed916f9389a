"""The system that AADL tools instantiate: all processes and computers, what joins and binds them, and the chains as flows."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from archgen.model.architecture import Architecture, Chain
from archgen.model.node import Endpoint
from archgen.model.path_resolver import title_from_id
from archgen.timing.analysis import Analysis
from archgen.views.generation.aadl_flows import FlowWriter
from archgen.views.generation.aadl_platform import Platform
from archgen.views.generation.aadl_ports import PortPart
from archgen.views.generation.aadl_processes import Process
from archgen.views.generation.aadl_words import (
    AadlProperty,
    NameSpace,
    can_be_written,
    make_classifier,
    make_item,
    make_property,
    make_text_properties,
    write_range,
    write_text,
    write_texts,
)
from archgen.views.generation.generation_context import GenerationContext

LAUNCH = "robot.launch"
"""The system implementation that holds everything."""


class SystemWriter:
    """The launch of everything: processes, computers, links, what flows between them, and where it runs."""

    def __init__(self, context: GenerationContext, processes: dict[str, Process], names: dict[str, str]) -> None:
        """Begin with the processes; `names` are those of the packages."""
        self._context = context
        self._architecture = context.architecture
        self._processes = processes
        self._packages = names
        self._names = NameSpace()
        self._subcomponents: list[dict[str, Any]] = []
        self._connections: list[dict[str, Any]] = []
        self._bound: dict[str, list[str]] = {}
        self._properties: list[AadlProperty] = []
        self._connection_names: dict[tuple[str, str, str, str], str] = {}
        self.classifiers: list[dict[str, Any]] = []
        self.comments: list[str] = []
        for process in processes.values():
            # A process has the same name as its classifier wherever that is free: flows name it so.
            process.name_in_system = self._names.take_name(process.name)
            self._subcomponents.append(
                make_item(process.name_in_system, f"process {names['nodes']}::{process.name}.impl")
            )
        hosts = {
            host.id
            for host in self._architecture.hosts.values()
            if context.is_whole or host.id in {process.node.host for process in processes.values()}
        }
        self.platform = Platform(self._architecture, hosts, self._names, names["hosts"])
        self._analysis = _analyse(self._architecture)

    def write(self) -> None:
        """Write the package of the system."""
        self._join_processes()
        self._join_tf()
        flows = self._write_flows()
        self._bind_processes()
        properties = [*self._properties, *self.platform.properties]
        for bus, connections in self._bound.items():
            properties.append(
                make_property("Actual_Connection_Binding", f"(reference ({bus}))", ", ".join(connections))
            )
        project = self._architecture.project
        self.classifiers = [
            make_classifier(
                "system",
                LAUNCH.partition(".")[0],
                properties=make_text_properties(
                    id=project.id, title=project.title, description=project.description, version=project.version
                ),
            ),
            make_classifier(
                "system",
                LAUNCH,
                subcomponents=[*self._subcomponents, *self.platform.subcomponents],
                connections=[*self._connections, *self.platform.connections],
                flows=flows,
                properties=properties,
            ),
        ]

    def _join_processes(self) -> None:
        """Write a connection for each pair of processes that implement the two ends of one."""
        latencies = _find_link_latencies(self._analysis)
        for edge in self._architecture.edges:
            for source, output in self._find_parts(edge.output, is_output=True):
                for reader, part in self._find_parts(edge.input, is_output=False, source_id=edge.output):
                    endpoint = next(iter(reader.find_endpoints(part, edge.output)), None)
                    endpoint = endpoint or next(iter(source.find_endpoints(output)), None)
                    properties = _list_topic_properties(endpoint)
                    if reader is source:
                        source.join_inside(output, part, properties)
                        continue
                    latency = latencies.get((edge.output, edge.input, source.node.id, reader.node.id))
                    if latency:
                        properties.append(make_property("Latency", write_range(*latency)))
                    self._join((source, output), (reader, part), properties)

    def _find_parts(self, port_id: str, *, is_output: bool, source_id: str = "") -> Iterable[tuple[Process, PortPart]]:
        for process in self._processes.values():
            part = process.find_part(port_id, is_output=is_output, source_id=source_id)
            if part is not None:
                yield process, part

    def _join(
        self, source: tuple[Process, PortPart], reader: tuple[Process, PortPart], properties: list[AadlProperty]
    ) -> None:
        (sender, output), (receiver, part) = source, reader
        ends = (
            f"{sender.name_in_system}.{sender.features[output.key]}",
            f"{receiver.name_in_system}.{receiver.features[part.key]}",
        )
        name = self._names.take_name(f"{sender.name}_{sender.features[output.key]}_to_{receiver.name}")
        self._connection_names[sender.node.id, output.port.id, receiver.node.id, part.port.id] = name
        self._connections.append(make_item(name, f"{output.connection_kind} {ends[0]} -> {ends[1]}", properties))
        self._bind_connection(name, sender, receiver, is_call=output.flow != "topic")

    def _bind_connection(self, name: str, source: Process, reader: Process, *, is_call: bool) -> None:
        """Bind a connection to the link between two computers where there is exactly one, else to ROS's own."""
        hosts = {source.node.host, reader.node.host}
        links = [
            link.id
            for link in self._architecture.links.values()
            if len(hosts) > 1 and hosts <= set(link.connects) and ("link", link.id) in self.platform.names
        ]
        if len(links) == 1:
            bus = self.platform.names["link", links[0]]
        else:
            kind = "services" if is_call else "topics"
            if ("bus", kind) not in self.platform.names:
                bus = self.platform.names["bus", kind] = self._names.take_name(kind)
                self._subcomponents.append(make_item(bus, f"virtual bus ros::{kind}"))
            bus = self.platform.names["bus", kind]
        self._bound.setdefault(bus, []).append(name)

    def _join_tf(self) -> None:
        users = [process for process in self._processes.values() if process.uses_tf]
        if users:
            name = self._names.take_name("tf")
            self._subcomponents.append(make_item(name, "data ros::tf"))
            for process in users:
                own_name = self._names.take_name(f"{process.name}_tf")
                self._connections.append(make_item(own_name, f"data access {name} -> {process.name_in_system}.tf"))

    def _bind_processes(self) -> None:
        """Bind processes to the containers that load them, else to their hosts."""
        bound: dict[str, list[str]] = {}
        for process in self._processes.values():
            node = process.node
            place = self.platform.names.get(("container", node.container or "")) or self.platform.names.get(
                ("host", node.host or "")
            )
            if place:
                bound.setdefault(place, []).append(process.name_in_system)
        for place, names in bound.items():
            self._properties.append(
                make_property("Actual_Processor_Binding", f"(reference ({place}))", ", ".join(names))
            )

    def _write_flows(self) -> list[dict[str, Any]]:
        if self._analysis is None or not self._architecture.chains:
            return []
        from archgen.timing.chains.chain_bounds import bound_all_chains

        results = bound_all_chains(self._analysis, self._architecture)
        writer = FlowWriter(self._architecture, self._analysis, self._processes)
        flows, written = [], dict[str, Chain]()
        for chain in self._architecture.chains.values():
            flow = writer.write_chain(chain, results[chain.id], self._connection_names, self._names)
            if isinstance(flow, str):
                self.comments.append(f"The chain {chain.id} is no end to end flow here: {flow}")
            else:
                flows.append(flow)
                written[flow["name"]] = chain
        for name, texts in (
            ("Titles", {key: chain.title for key, chain in written.items() if chain.title != title_from_id(key)}),
            ("Ways", {key: ", ".join(each.id for each in chain.through) for key, chain in written.items()}),
            ("Ids", {key: chain.id for key, chain in written.items() if chain.id != key}),
        ):
            if texts:
                value = write_texts(f"{key}: {text}" for key, text in texts.items())
                # Ocarina takes no property of another set at an end to end flow itself.
                self._properties.append(make_property(f"archgen::Flow_{name}", value))
        return flows


def _analyse(architecture: Architecture) -> Analysis | None:
    if not architecture.chains and not any(node.timing for node in architecture.nodes.values()):
        return None
    # Imported here: the engine takes time to load.
    from archgen.timing.run_analysis import analyse_architecture

    return analyse_architecture(architecture)


def _find_link_latencies(analysis: Analysis | None) -> dict[tuple[str, str, str, str], tuple[Fraction, Fraction]]:
    """Return how long data takes on links, by the two ends and their nodes."""
    if analysis is None:
        return {}
    found = {}
    for arc in analysis.system.arcs:
        if arc.role == "data" and arc.link is not None and arc.worst is not None:
            nodes = (analysis.system.activities[arc.source].node, analysis.system.activities[arc.target].node)
            best, worst = (arc.best or 0) * analysis.system.tick, arc.worst * analysis.system.tick
            if can_be_written(worst):
                found[arc.output, arc.input, *nodes] = (best, worst)
    return found


def _list_topic_properties(endpoint: Endpoint | None) -> list[AadlProperty]:
    return (
        []
        if endpoint is None or endpoint.medium != "ros"
        else [make_property("topic_properties::Name", write_text(endpoint.name))]
    )
