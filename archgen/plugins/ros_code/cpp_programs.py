"""What a program in C++ has besides: its namespace and class, headers of messages, and what its parameters are.

Which parameters of a program generate_parameter_library declares, and which its node declares itself.

The library turns names into members of structs, puts texts between quotes as they are, and wants a value for each at the start.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import CPP_KEYWORDS, PORT_SECTIONS, make_identifier_in, name_plugin, tell_left_out
from archgen.plugin.model import Architecture, Node

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
            port.update(_describe_own_message(port))
            headers |= {port["cpp_header"], port["own_header"]}
    record |= {
        "cpp_namespace": namespace,
        "cpp_class": class_name,
        "cpp_guard": _name_guard(record["package"], record["module"]),
        "cpp_headers": sorted(headers),
        "message_packages": sorted({each.partition("/")[0] for each in headers}),
        "distro": architecture.distro or "",
        **choose_library_parameters(record["parameters"]),
    }


def _describe_own_message(port: Mapping[str, Any]) -> dict[str, str]:
    """Return what own code gives and takes at a port: its message, or what is in its envelope."""
    payload = port["envelope"]["payload"] if port["envelope"] else port["message"]
    if "/" in payload:
        own_class, own_header = payload.replace("/", "::"), name_message_header(payload)
        shared_class, unique_class = f"{own_class}::ConstSharedPtr", f"{own_class}::UniquePtr"
    else:
        # A number, a text, or a list.
        own_class, own_header = f"{port['cpp_class']}::_payload_type", port["cpp_header"]
        shared_class, unique_class = f"std::shared_ptr<const {own_class}>", f"std::unique_ptr<{own_class}>"
    return {
        "own_class": own_class,
        "own_header": own_header,
        "shared_class": shared_class,
        "unique_class": unique_class,
    }


def list_cpp_libraries(programs: Iterable[Mapping[str, Any]], more: Iterable[str]) -> list[str]:
    """Return the packages of ROS that the programs of a package need, beside those of their messages."""
    found = {"rclcpp", *more}
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


_MEMBER_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII)
_TAKEN_NAMES = CPP_KEYWORDS | {
    # Macros of the C library, of compilers and of Qt.
    *("assert", "emit", "errno", "foreach", "i386", "linux", "major", "makedev", "minor", "signals", "slots"),
    *("stderr", "stdin", "stdout", "unix"),
    # Structs of the library's own.
    *("params", "stack_params"),
}
_PLAIN_TEXT = re.compile(r"(?!.*\?\?)[ !#-\[\]-~]*\Z", re.ASCII)


def choose_library_parameters(parameters: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Tell each parameter whether the library declares it (`is_in_library`), and return what the library gets.

    `library_rows` are its groups and parameters from top to bottom, each with its `depth`; a group has no `parameter`.
    """
    names = {str(each["name"]) for each in parameters}
    odd_structs = _find_odd_structs(names)
    tree: dict[str, Any] = {}
    for parameter in parameters:
        *groups, own_name = str(parameter["name"]).split(".")
        paths = {".".join(groups[: depth + 1]) for depth in range(len(groups))}
        parameter["is_in_library"] = (
            all(_MEMBER_NAME.match(each) and each not in _TAKEN_NAMES for each in (*groups, own_name))
            and not paths & (names | odd_structs)
            and _has_library_values(parameter)
        )
        if parameter["is_in_library"]:
            branch = tree
            for group in groups:
                branch = branch.setdefault(group, {})
            branch[own_name] = _Leaf(parameter)
    return {"library_rows": list(_list_rows(tree, 0))}


class _Leaf:
    def __init__(self, parameter: dict[str, Any]) -> None:
        self.parameter = parameter


def _list_rows(branch: Mapping[str, Any], depth: int) -> Iterator[dict[str, Any]]:
    for name, each in branch.items():
        if isinstance(each, _Leaf):
            yield {"depth": depth, "name": name, "parameter": each.parameter}
        else:
            yield {"depth": depth, "name": name, "parameter": None}
            yield from _list_rows(each, depth + 1)


def _find_odd_structs(names: set[str]) -> set[str]:
    """Return the groups whose struct another group beside them has: `a1_b` and `a1b` both give `A1B`."""
    groups = {name.rsplit(".", depth)[0] for name in names for depth in range(1, name.count(".") + 1)}
    structs = {
        group: (group.rpartition(".")[0], group.rpartition(".")[2].title().replace("_", "")) for group in sorted(groups)
    }
    counts = Counter(structs.values())
    return {group for group, struct in structs.items() if counts[struct] > 1}


def _has_library_values(parameter: Mapping[str, Any]) -> bool:
    """Whether the library can take a parameter's default, or demand a value, and check its choices."""
    if parameter["default"] is None and not parameter["is_given"]:
        return False
    if parameter["choices"] and parameter["type"].startswith("bool"):
        return False
    default = parameter["default"]
    values = [*(default if isinstance(default, list) else [default]), *parameter["choices"], parameter["lowest"]]
    # The least number has no literal in C++.
    return all(_PLAIN_TEXT.match(each) if isinstance(each, str) else each != -(2**63) for each in values)
