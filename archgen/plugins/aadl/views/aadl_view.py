"""The view `aadl`: the architecture as packages of AADL, each classifier with its sections as lines that only want layout."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext
from archgen.plugin.model import Architecture, Endpoint, Output, flow_of_port
from archgen.plugins.aadl.views.aadl_component_types import (
    NodeDevice,
    TypeWriter,
    find_type_of_node,
    is_device,
    list_shared_types,
)
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_system import LAUNCH, SystemWriter
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import FlowBook, NameSpace, make_aadl_name

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
                types.name_type(declared.name, _find_flow(architecture, declared.name))
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


def _find_flow(architecture: Architecture, type_name: str) -> str:
    """Return whether a type is data, or is called for: as a port with it is."""
    return flow_of_port(Output("", "", "", type_name), architecture.types[type_name])


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
