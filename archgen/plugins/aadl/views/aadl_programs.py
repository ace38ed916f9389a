"""All processes and devices of an export, and the classifiers of their packages: some have one of their own, some share one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.generating import GenerationContext
from archgen.plugin.model import Endpoint
from archgen.plugins.aadl.views.aadl_component_types import TypeWriter, find_type_of_node, list_shared_types
from archgen.plugins.aadl.views.aadl_devices import NodeDevice, is_device
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import FlowBook, NameSpace


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
