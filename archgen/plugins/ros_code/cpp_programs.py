"""What a program in C++ has besides: its namespace and class, headers of messages, and what its parameters are."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import PORT_SECTIONS, make_identifier_in, name_plugin, tell_left_out
from archgen.plugin.model import Architecture, Node
from archgen.plugins.ros_code.cpp_parameters import choose_library_parameters

_CLASS_NAME = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)(?:::([A-Za-z_][A-Za-z0-9_]*))+\Z", re.ASCII)


def find_bad_classes(
    package_name: str, program_name: str, nodes: Sequence[Node], place: Span
) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the class of a program: with it nothing can be built."""
    plugins = sorted({name_plugin(each, package_name, program_name) for each in nodes})
    if len(plugins) > 1:
        message = f"its nodes have different classes, {' and '.join(f'`{each}`' for each in plugins)}"
        help_line = "give the nodes of one class an `executable` of their own"
    elif not _CLASS_NAME.match(plugins[0]) or any(
        make_identifier_in("cpp", part) != part for part in plugins[0].split("::")
    ):
        message = f"no class of C++ can be called `{plugins[0]}`"
        help_line = "a `plugin` is a namespace and a class: `robot_safety::ObstacleStop`"
    else:
        return ()
    shown = f"the program of `{nodes[0].id}` is left out: {message}"
    return (tell_left_out(shown, place, element=nodes[0].id, help_line=help_line),)


def complete_cpp_program(architecture: Architecture, record: dict[str, Any], nodes: Sequence[Node]) -> None:
    """Write into the record of a program what only C++ asks for."""
    node = nodes[0]
    namespace, _, class_name = name_plugin(node, record["package"], record["executable"]).rpartition("::")
    headers = set[str]()
    for section in PORT_SECTIONS.values():
        for port in record[section]:
            port |= {
                # Two underscores in a row are the compiler's own.
                "key": port["key"].rstrip("_"),
                "cpp_class": port["message"].replace("/", "::"),
                "cpp_header": name_message_header(port["message"]),
            }
            headers.add(port["cpp_header"])
    record |= {
        "cpp_namespace": namespace,
        "cpp_class": class_name,
        "cpp_guard": _name_guard(record["package"], record["module"]),
        "cpp_headers": sorted(headers),
        "distro": architecture.distro or "",
        **choose_library_parameters(record["parameters"]),
    }


def list_cpp_libraries(programs: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the packages of ROS that the programs of a package need, beside those of their messages."""
    found = {"rclcpp"}
    for program in programs:
        found |= {
            name
            for name, is_needed in (
                ("generate_parameter_library", program["library_rows"]),
                ("rclcpp_action", program["action_servers"] or program["action_clients"]),
                ("rclcpp_components", program["is_composable"]),
                ("rclcpp_lifecycle", program["is_lifecycle"]),
            )
            if is_needed
        }
    return sorted(found)


def name_message_header(message: str) -> str:
    """Return the header of a message, service or action, as rosidl names it: `sensor_msgs/msg/point_cloud2.hpp`."""
    package, kind, name = message.split("/")
    words = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name))
    return f"{package}/{kind}/{words.lower()}.hpp"


def _name_guard(package: str, module: str) -> str:
    return f"{make_identifier_in('cpp', package)}__{module}".upper()
