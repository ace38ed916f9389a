"""The view `aadl`: the architecture as packages of AADL, each classifier with its sections as lines that only want layout."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext
from archgen.plugin.model import Architecture, Output, flow_of_port
from archgen.plugins.aadl.views.aadl_devices import NodeDevice
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_programs import ProgramBook
from archgen.plugins.aadl.views.aadl_system import LAUNCH, SystemWriter
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import NameSpace, make_aadl_name

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
