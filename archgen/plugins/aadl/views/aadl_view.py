"""The view `aadl`: the architecture as packages of AADL, each classifier with its sections as lines that only want layout.

The system that AADL tools instantiate: all processes and computers, what joins and binds them, and the chains as flows.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext, title_from_id
from archgen.plugin.model import Architecture, Chain, Endpoint, Output, flow_of_port
from archgen.plugin.timing import Analysis
from archgen.plugins.aadl.views.aadl_component_types import (
    NodeDevice,
    TypeWriter,
    find_type_of_node,
    is_device,
    list_shared_types,
)
from archgen.plugins.aadl.views.aadl_flows import FlowWriter, RouteEnds, RouteFinder
from archgen.plugins.aadl.views.aadl_platform import Platform
from archgen.plugins.aadl.views.aadl_ports import PortPart
from archgen.plugins.aadl.views.aadl_processes import NodeProcess, SystemPart, list_system_properties
from archgen.plugins.aadl.views.aadl_system_tree import Route, SystemTree
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    FlowBook,
    NameSpace,
    can_be_written,
    list_own_sources,
    make_aadl_name,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    read_aadl_hints,
    write_aadl_string,
    write_range,
    write_texts,
)

LAUNCH = "robot.launch"
"""The system implementation that holds everything."""


class SystemWriter:
    """The launch of everything: processes, computers, links, what flows between them, and where it runs."""

    def __init__(
        self, context: GenerationContext, processes: dict[str, NodeProcess], types: TypeBook, names: dict[str, str]
    ) -> None:
        """Begin with the processes; `names` are those of the packages."""
        self._architecture = context.architecture
        self._types = types
        self._processes = processes
        self._root = SystemPart("", LAUNCH.partition(".")[0], None, None)
        self._tree = SystemTree(self._architecture, names["system"], self._root)
        self._bound: dict[str, dict[str, None]] = {}
        self._routes: dict[RouteEnds, Route] = {}
        self.classifiers: list[dict[str, Any]] = []
        self.comments: list[str] = []
        self._processes_of: dict[str, list[NodeProcess]] = {}
        """By the complete ids of the components that they implement."""
        for process in processes.values():
            self._place_process(process, names["devices" if process.category == "device" else "nodes"])
            for component_id in process.behaviours:
                self._processes_of.setdefault(component_id, []).append(process)
        hosts = {
            host.id
            for host in self._architecture.hosts.values()
            if context.is_whole or host.id in {process.node.host for process in processes.values()}
        }
        devices = {each.component.id: each for each in processes.values() if isinstance(each, NodeDevice)}
        self.platform = Platform(self._architecture, hosts, self._root.names, names["hosts"], frozenset(devices))
        for device_id, links in self.platform.links_by_device.items():
            for link_id in links if device_id in devices else ():
                self._join_device(devices[device_id], link_id)
        self._analysis = _analyse_timing(self._architecture)
        self._latencies = _find_link_latencies(self._analysis)

    def _place_process(self, process: NodeProcess, package: str) -> None:
        """Put a process into the system of its component, by the name of that."""
        process.home, component_id = self._tree.find_home(process)
        own_id = component_id.rpartition(".")[2] or process.node.id
        process.name_in_system = process.home.names.take_name(own_id)
        properties = make_named_properties(process.name_in_system, own_id)
        if own_id != process.node.id and process.category == "process":
            properties += make_text_properties(node=process.node.id)
        properties += list_own_sources(read_aadl_hints(process.node))
        text = f"{process.category} {package}::{process.classifier}"
        process.item = make_item(process.name_in_system, text, properties)
        process.home.subcomponents.append(process.item)

    def _join_device(self, device: NodeDevice, link_id: str) -> None:
        """Lead the access to a bus from the outermost system to a device."""
        bus = self.platform.name_bus(link_id)
        feature = device.add_bus_access(link_id, bus)
        self._tree.lead_access(device, feature, bus, self.platform.names["link", link_id])

    def write(self) -> None:
        """Write the package of the systems."""
        root = self._root
        self._join_processes()
        self._join_tf()
        self._write_flows()
        self._bind_processes()
        root.subcomponents += self.platform.subcomponents
        root.connections += self.platform.connections
        root.properties += self.platform.properties
        root.properties += [
            make_property("Actual_Connection_Binding", f"(reference ({bus}))", ", ".join(connections))
            for bus, connections in self._bound.items()
        ]
        project = self._architecture.project
        own_words = make_text_properties(
            id=project.id,
            title=project.title,
            description=project.description,
            version=project.version,
            distro=self._architecture.distro,
        )
        for part in self._tree.parts.values():
            if part.element is not None:
                self.classifiers += part.make_classifiers(list_system_properties(part.element))
        own_type, implementation = root.make_classifiers(own_words)
        self.classifiers += [own_type, {**implementation, "name": LAUNCH}]

    def _join_processes(self) -> None:
        """Write a connection for each pair of processes that implement the two ends of one."""
        for edge in self._architecture.edges:
            for source, output in self._find_parts(edge.output, is_output=True):
                for reader, part in self._find_parts(edge.input, is_output=False, source_id=edge.output):
                    endpoint = next(iter(reader.find_endpoints(part, edge.output)), None)
                    endpoint = endpoint or next(iter(source.find_endpoints(output)), None)
                    properties = _list_topic_properties(endpoint)
                    if reader is source:
                        source.join_inside(output, part, properties)
                        continue
                    ends = (source.node.id, edge.output, reader.node.id, edge.input)
                    latency = self._latencies.get(ends)
                    # A call takes its link there and back: the ports for its request and its answer say each.
                    if latency and output.flow == "topic":
                        properties.append(make_property("Latency", write_range(*latency)))
                    route = self._routes[ends] = self._tree.join((source, output), (reader, part), properties)
                    self._bind_connection(route, source, reader, is_call=output.flow != "topic")

    def _find_parts(
        self, port_id: str, *, is_output: bool, source_id: str = ""
    ) -> Iterable[tuple[NodeProcess, PortPart]]:
        for process in self._processes_of.get(port_id.rpartition(".")[0], ()):
            part = process.find_part(port_id, is_output=is_output, source_id=source_id)
            if part is not None:
                yield process, part

    def _bind_connection(self, route: Route, source: NodeProcess, reader: NodeProcess, *, is_call: bool) -> None:
        """Bind a connection to the link between two computers where there is exactly one, else to ROS's own."""
        ends = {self._find_place(source), self._find_place(reader)}
        links = [
            link.id
            for link in self._architecture.links.values()
            if len(ends) > 1 and ends <= {*link.connects, *link.devices} and ("link", link.id) in self.platform.names
        ]
        if len(links) == 1:
            bus = self.platform.names["link", links[0]]
        elif "device" in {source.category, reader.category}:
            return
        else:
            bus = self._find_virtual_bus("services" if is_call else "topics")
        name = route.scope.name_inside(self._root, route.joint)
        if not any(name in names for names in self._bound.values()):
            self._bound.setdefault(bus, {})[name] = None

    @staticmethod
    def _find_place(process: NodeProcess) -> str | None:
        """Return what of a link's ends a process is on: its host, or for a device itself."""
        return process.component.id if isinstance(process, NodeDevice) else process.node.host

    def _find_virtual_bus(self, kind: str) -> str:
        if ("bus", kind) not in self.platform.names:
            bus = self.platform.names["bus", kind] = self._root.names.take_name(kind)
            self._root.subcomponents.append(make_item(bus, f"virtual bus ros::{kind}"))
        return self.platform.names["bus", kind]

    def _join_tf(self) -> None:
        users = [process for process in self._processes.values() if process.uses_tf]
        if users:
            name = self._root.names.take_name("tf")
            self._root.subcomponents.append(make_item(name, "data ros::tf"))
            for process in users:
                self._tree.lead_access(process, "tf", "data access ros::tf", name)

    def _bind_processes(self) -> None:
        """Bind processes to the containers that load them, else to their hosts."""
        bound: dict[str, list[str]] = {}
        for process in self._processes.values():
            node = process.node
            place = self.platform.names.get(("container", node.container or "")) or self.platform.names.get(
                ("host", node.host or "")
            )
            if place:
                bound.setdefault(place, []).append(process.home.name_inside(self._root, process.name_in_system))
        self._root.properties += [
            make_property("Actual_Processor_Binding", f"(reference ({place}))", ", ".join(names))
            for place, names in bound.items()
        ]

    def _write_flows(self) -> None:
        if self._analysis is None or not self._architecture.chains:
            return
        from archgen.plugin.timing import bound_all_chains

        results = bound_all_chains(self._analysis, self._architecture)
        routes = RouteFinder(self._types, self._tree, self._routes, self._latencies)
        writer = FlowWriter(self._architecture, self._analysis, self._processes, routes)
        written: dict[SystemPart, dict[str, Chain]] = {}
        for chain in self._architecture.chains.values():
            place = writer.write_chain(chain, results[chain.id])
            if isinstance(place, str):
                self.comments.append(f"The chain {chain.id} is no end to end flow here: {place}")
            else:
                written.setdefault(place[0], {})[place[1]] = chain
        for system, chains in written.items():
            system.properties += _list_flow_words(chains, self._list_joined_components())

    def _list_joined_components(self) -> frozenset[str]:
        """Return the components that share a process: whoever reads it takes the process for a component around them."""
        shared = (process.behaviours for process in self._processes.values() if len(process.behaviours) > 1)
        return frozenset(component for behaviours in shared for component in behaviours)


def _list_flow_words(chains: dict[str, Chain], joined_components: frozenset[str]) -> list[AadlProperty]:
    """Return what else is known of end to end flows: Ocarina takes no property of another set at a flow itself."""
    ways = {
        key: [each.id for each in chain.through]
        for key, chain in chains.items()
        if not any(each.id in joined_components for each in chain.through)
    }
    return [
        make_property(f"archgen::Flow_{name}", write_texts(f"{key}: {text}" for key, text in texts.items()))
        for name, texts in (
            ("Titles", {key: chain.title for key, chain in chains.items() if chain.title != title_from_id(chain.id)}),
            ("Ways", {key: ", ".join(way) for key, way in ways.items()}),
            ("Ids", {key: chain.id for key, chain in chains.items() if chain.id != key}),
        )
        if texts
    ]


def _analyse_timing(architecture: Architecture) -> Analysis | None:
    if not architecture.chains and not any(node.timing for node in architecture.nodes.values()):
        return None
    # Imported here: the engine takes time to load.
    from archgen.plugin.timing import analyse_architecture

    return analyse_architecture(architecture)


def _find_link_latencies(analysis: Analysis | None) -> dict[RouteEnds, tuple[Fraction, Fraction]]:
    """Return how long data takes on links."""
    if analysis is None:
        return {}
    found = {}
    for arc in analysis.system.arcs:
        if arc.link is not None and arc.worst is not None:
            nodes = (analysis.system.activities[arc.source].node, analysis.system.activities[arc.target].node)
            best, worst = (arc.best or 0) * analysis.system.tick, arc.worst * analysis.system.tick
            if can_be_written(worst):
                found[nodes[0], arc.output, nodes[1], arc.input] = (best, worst)
    return found


def _list_topic_properties(endpoint: Endpoint | None) -> list[AadlProperty]:
    return (
        []
        if endpoint is None or endpoint.name is None or endpoint.medium != "ros"
        else [make_property("topic_properties::Name", write_aadl_string(endpoint.name))]
    )


LIBRARY_UNITS = ("cnc", "ros", "topic_properties", "archgen")
"""The packages and property sets that are the same for each project."""
_STANDARD_UNITS = (
    *("Base_Types", "Data_Model", "AADL_Project", "Timing_Properties", "Thread_Properties", "Memory_Properties"),
    *("Communication_Properties", "Programming_Properties", "Deployment_Properties", "Modeling_Properties", "EMV2"),
)
_USED_UNIT = re.compile(r"\b([A-Za-z][A-Za-z0-9_]*)::")
_QUOTED = re.compile(r'"[^"]*"')


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the packages: messages, types, nodes, hosts, and the system that joins them."""
    architecture = context.architecture
    units = NameSpace((*LIBRARY_UNITS, *_STANDARD_UNITS))
    project = make_aadl_name(architecture.project.id)
    names = {
        key: units.take_name(f"{project}_{key}" if key != "system" else project)
        for key in ("types", "nodes", "devices", "hosts", "system")
    }
    types = TypeBook(architecture, names["types"], units)
    programs = ProgramBook(context, types)
    if context.is_whole:
        for declared in architecture.types.values():
            if declared.origin == "project" and not declared.generic:
                types.name_type(declared.name, flow_of_port(Output("", "", "", declared.name), declared))
    system = SystemWriter(context, programs.processes, types, names)
    system.write()
    program_packages = {NodeProcess.category: names["nodes"], NodeDevice.category: names["devices"]}
    programs.write_types(program_packages)
    packages = [
        *(_make_package(name, classifiers) for name, classifiers in types.list_packages()),
        *(_make_package(name, programs.list_classifiers(category)) for category, name in program_packages.items()),
        _make_package(names["hosts"], system.platform.classifiers),
        _make_package(names["system"], system.classifiers, system.comments),
    ]
    return GeneratedView(
        {
            "project": {
                "id": architecture.project.id,
                "title": architecture.project.title,
                "system": f"{names['system']}::{LAUNCH}",
            },
            "packages": [each for each in packages if each["classifiers"]],
        }
    )


def _make_package(name: str, classifiers: list[dict[str, Any]], comments: Iterable[str] = ()) -> dict[str, Any]:
    return {
        "name": name,
        "path": f"aadl/{name}.aadl",
        "uses": _find_used_units(name, classifiers),
        "comments": list(comments),
        "classifiers": classifiers,
    }


def _find_used_units(name: str, classifiers: Iterable[dict[str, Any]]) -> list[str]:
    """Return the packages and property sets that a package names, but for itself."""
    found: dict[str, None] = {}
    for classifier in classifiers:
        texts = [classifier["extends"]]
        for section in ("features", "subcomponents", "connections", "flows"):
            for item in classifier[section]:
                texts += [item["text"], *(f"{each['name']} {each['value']}" for each in item["properties"])]
        texts += [f"{each['name']} {each['value']}" for each in classifier["properties"]]
        for text in texts:
            found.update(dict.fromkeys(_USED_UNIT.findall(_QUOTED.sub("", text))))
    return sorted(unit for unit in found if unit != name)


class ProgramBook:
    """The processes and devices by node. Their classifiers are made when all that joins them is written."""

    def __init__(self, context: GenerationContext, types: TypeBook) -> None:
        """Make a process or a device of each wanted node."""
        self.processes: dict[str, NodeProcess] = {}
        self._architecture = architecture = context.architecture
        self._package_names = {NodeProcess.category: NameSpace(), NodeDevice.category: NameSpace()}
        self._type_names: dict[tuple[str, str], str] = {}
        self._type_classifiers: dict[str, list[dict[str, Any]]] = {category: [] for category in self._package_names}
        self._typed_nodes: set[str] = set()
        linked_devices = {device for link in architecture.links.values() for device in link.devices}
        kinds: dict[str, type[NodeProcess]] = {}
        # Component types have their names before the nodes, which may be called like them.
        for node in context.wanted_nodes.values():
            kind = kinds[node.id] = NodeDevice if is_device(architecture, node, linked_devices) else NodeProcess
            declared = find_type_of_node(architecture, node)
            if declared and (kind.category, declared.id) not in self._type_names:
                name = self._package_names[kind.category].take_name(declared.id)
                self._type_names[kind.category, declared.id] = name
        endpoints: dict[str, list[Endpoint]] = {}
        for endpoint in architecture.list_endpoints():
            endpoints.setdefault(endpoint.node, []).append(endpoint)
        flow_books: dict[tuple[str, str], FlowBook] = {}
        for node in context.wanted_nodes.values():
            kind, own_endpoints = kinds[node.id], endpoints.get(node.id, ())
            names = self._package_names[kind.category]
            process = self.processes[node.id] = kind(architecture, types, node, own_endpoints, names)
            if declared := find_type_of_node(architecture, node):
                process.flow_book = flow_books.setdefault((kind.category, declared.id), process.flow_book)

    def write_types(self, packages: Mapping[str, str]) -> None:
        """Write component types into the packages, which are given by category, and make their instances of them."""
        for shared in list_shared_types(self._architecture, self.processes.values(), self._type_names):
            category = shared.instances[0].category
            writer = TypeWriter(shared, packages[category], self._package_names[category])
            self._type_classifiers[category] += writer.make_classifiers()
            writer.place_instances()
            self._typed_nodes |= {process.node.id for process in shared.instances}

    def list_classifiers(self, category: str) -> list[dict[str, Any]]:
        """Return the classifiers of all processes or of all devices."""
        found = list(self._type_classifiers[category])
        for node_id, process in self.processes.items():
            if process.category == category and node_id not in self._typed_nodes:
                found += process.make_classifiers()
        return found
