"""What ROS is told where nodes and containers start: package and program, names, and the values of parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.bringup.plan_shapes import RosLaunch
from archgen.bringup.program_names import ProgramNames
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import Node
from archgen.model.parameter_values import canonical_name, find_declarations
from archgen.model.ros_distro import is_ros_1
from archgen.model.runtime_facts import MANY_THREADED, find_container_threads

_FLOAT_TYPES = frozenset({"float", "float[]"})


def describe_node_launch(architecture: Architecture, node: Node, program_names: ProgramNames) -> RosLaunch | None:
    """Return what ROS is told about a node; None for a program that is none, and for a node with a command of its own."""
    if node.command or node.is_program:
        return None
    container = architecture.containers.get(node.container or "")
    ros_1 = is_ros_1(architecture.distro)
    declarations = find_declarations(architecture, node)
    float_names = {name for name, each in declarations.items() if each.type in _FLOAT_TYPES}

    def give(values: Iterator[tuple[str, object]]) -> dict[str, object]:
        named = ((canonical_name(name, ros_1=ros_1), value) for name, value in values if value is not None)
        return {name: _write_as_float(value) if name in float_names else value for name, value in named}

    own_values = give((each.name, each.value) for each in node.own_values)
    commands = {canonical_name(name, ros_1=ros_1): words for name, words in node.parameter_commands.items()}
    program = program_names.find_program(node)
    is_loaded = container is not None and not ros_1
    return RosLaunch(
        name=node.name,
        namespace=node.namespace,
        package=program.package,
        # A container loads the class; a program beside it is no node of the architecture.
        executable=node.executable if is_loaded else program.executable,
        plugin=program.plugin,
        container=container.full_name if container else None,
        earlier_values=give((each.name, each.value) for each in architecture.ros_parameters)
        | give((name, each.value) for name, each in declarations.items()),
        parameter_files=node.parameter_files,
        file_values=give((each.name, each.value) for each in node.file_values),
        own_values=own_values,
        value_commands={name: words for name, words in commands.items() if name not in own_values},
        arguments=node.arguments,
        remaps=program_names.find_remaps(node),
    )


def describe_container_launch(architecture: Architecture, container: Container) -> RosLaunch:
    """Return what ROS is told about a container: its own program, else ROS's."""
    own_values = dict(_flatten_values("", container.parameters))
    if is_ros_1(architecture.distro):
        package, executable = container.package or "nodelet", container.executable or "nodelet"
    else:
        threads = find_container_threads(architecture, container)
        default = "component_container" if threads == 1 else MANY_THREADED
        package, executable = container.package or "rclcpp_components", container.executable or default
        if executable == MANY_THREADED and threads is not None:
            own_values = {"thread_num": threads, **own_values}
    return RosLaunch(
        name=container.name or container.id,
        namespace=container.namespace,
        package=package,
        executable=executable,
        own_values=own_values,
    )


def _flatten_values(prefix: str, values: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten_values(f"{prefix}{key}.", value)
        elif value is not None:
            yield f"{prefix}{key}", value


def _write_as_float(value: object) -> object:
    """Return the whole numbers of a value as floats: ROS does not take `1` for a parameter that is a float."""
    if isinstance(value, (list, tuple)):
        return [_write_as_float(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value
