"""The commands that start nodes and containers, as lists of words. They are shown, and never run.

What ROS is told where nodes and containers start: package and program, names, and the values of parameters.

The words of commands that give parameters to nodes, each as ROS 2 and ROS 1 read it.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.bringup.plan_shapes import RosLaunch
from archgen.bringup.program_names import ProgramNames
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import NO_START, Node
from archgen.model.parameter_values import canonical_name, find_declarations
from archgen.model.ros_distro import is_ros_1
from archgen.model.runtime_facts import MANY_THREADED, find_container_threads

MAX_GUARDED_PORT = 1023
"""Up to this one, ports belong to the administrator."""
_SYSTEM_PROGRAMS = frozenset(
    [
        "ip",
        "ifconfig",
        "tc",
        "iptables",
        "nft",
        "modprobe",
        "insmod",
        "rmmod",
        "mount",
        "umount",
        "sysctl",
        "systemctl",
        "service",
        "chrt",
        "chown",
    ]
)
"""Programs that change the system, for which one needs rights as a rule."""


def build_command(architecture: Architecture, node: Node, launch: RosLaunch | None) -> tuple[str, ...]:
    """Return the words that start a node, or that load it into its container; none where that is not known."""
    if launch is None:
        return node.command or _run_program(node)
    if is_ros_1(architecture.distro):
        return _build_ros_1_command(node, launch)
    if launch.plugin and launch.package and not launch.executable:
        verb = ("load", launch.container) if launch.container else ("standalone",)
        namespace = ("--node-namespace", launch.namespace) if launch.namespace != "/" else ()
        names = ("--node-name", launch.name, *namespace)
        remaps = tuple(word for pair in _list_remaps(launch) for word in ("-r", pair))
        return (
            "ros2",
            "component",
            *verb,
            launch.package,
            launch.plugin,
            *names,
            *remaps,
            *list_loading_options(launch),
            *(("-e", "use_intra_process_comms:=true") if launch.shares_memory else ()),
        )
    return _run_in_ros_2(launch)


def _run_program(node: Node) -> tuple[str, ...]:
    return ("ros2", "run", node.package, node.executable) if node.package and node.executable else ()


def _run_in_ros_2(launch: RosLaunch) -> tuple[str, ...]:
    if not launch.package or not launch.executable:
        return ()
    namespace = ("-r", f"__ns:={launch.namespace}") if launch.namespace != "/" else ()
    remaps = tuple(word for pair in _list_remaps(launch) for word in ("-r", pair))
    names = ("-r", f"__node:={launch.name}", *namespace, *remaps)
    program = (launch.package, launch.executable, *launch.arguments)
    return ("ros2", "run", *program, "--ros-args", *names, *list_ros_2_options(launch))


def _list_remaps(launch: RosLaunch) -> tuple[str, ...]:
    return tuple(f"{own_name}:={name}" for own_name, name in launch.remaps.items())


def _build_ros_1_command(node: Node, launch: RosLaunch) -> tuple[str, ...]:
    words = (*launch.arguments, *_rename_in_ros_1(launch), *_list_remaps(launch), *list_ros_1_options(launch))
    if "nodelet" in node.kinds and launch.plugin:
        verb = ("load", launch.plugin, launch.container) if launch.container else ("standalone", launch.plugin)
        return ("rosrun", "nodelet", "nodelet", *verb, *words)
    return ("rosrun", launch.package, launch.executable, *words) if launch.package and launch.executable else ()


def _rename_in_ros_1(launch: RosLaunch) -> tuple[str, ...]:
    return (f"__name:={launch.name}", *((f"__ns:={launch.namespace}",) if launch.namespace != "/" else ()))


def build_container_command(architecture: Architecture, container: Container, launch: RosLaunch) -> tuple[str, ...]:
    """Return the words that start a container: its own program, else ROS's."""
    if not is_ros_1(architecture.distro):
        return _run_in_ros_2(launch)
    manager = () if container.package else ("manager",)
    program = (launch.package or "", launch.executable or "")
    return ("rosrun", *program, *manager, *_rename_in_ros_1(launch), *list_ros_1_options(launch))


def list_preparations(architecture: Architecture, launch: RosLaunch | None) -> tuple[tuple[str, ...], ...]:
    """Return the commands that run to their ends before a node starts: ROS 1 has parameters on a server."""
    return tuple(list_ros_1_preparations(launch)) if launch and is_ros_1(architecture.distro) else ()


def list_transitions(node: Node) -> tuple[tuple[str, ...], ...]:
    """Return the commands that bring a lifecycle node into its state; none where a manager does that."""
    start = node.start or NO_START
    if "lifecycle" not in node.kinds or start.by_written or start.state not in {"inactive", "active"}:
        return ()
    words = ("configure",) if start.state == "inactive" else ("configure", "activate")
    return tuple(("ros2", "lifecycle", "set", node.full_name, word) for word in words)


def list_needed_rights(node: Node) -> tuple[str, ...]:
    """Return what of a node's start only an administrator may do, as ends of "needs rights ..."."""
    start = node.start or NO_START
    rights = [f"to run as the user {start.user}"] if start.user else []
    if start.ready.port is not None and start.ready.port <= MAX_GUARDED_PORT:
        rights.append(f"to open the port {start.ready.port}")
    program = node.command[0].rpartition("/")[2] if node.command else ""
    if program in _SYSTEM_PROGRAMS:
        rights.append(f"to change the system with {program}")
    return tuple(rights)


SUBSTITUTION = re.compile(
    r"\$\((?:(?:find|find-pkg-share) (?P<package>[A-Za-z0-9_]+)|env (?P<variable>[A-Za-z_][A-Za-z0-9_]*))\)"
)
"""What is filled in where a node is started. Others would run something, or need what nothing here declares: they stay text."""


_VARIABLE = re.compile(r"\$\(env [A-Za-z_][A-Za-z0-9_]*\)")


def has_substitution(value: object) -> bool:
    """Whether the value of a parameter is filled in where its node is started."""
    return isinstance(value, str) and SUBSTITUTION.search(value) is not None


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
    launch = RosLaunch(
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
        shares_memory=is_loaded and _may_share_memory(architecture, node),
    )
    text_types = {"string", None} if program_names.is_generated(node) else {"string"}
    types = {canonical_name(name, ros_1=ros_1): each.type for name, each in declarations.items()}
    untyped_names = (
        name
        for name, value in launch.all_values.items()
        if isinstance(value, str) and _VARIABLE.fullmatch(value) and types.get(name) not in text_types
    )
    return replace(launch, untyped_names=frozenset(untyped_names))


def _may_share_memory(architecture: Architecture, node: Node) -> bool:
    """Whether rclcpp may hand messages of a loaded node on without a copy.

    It refuses an end that keeps all or, before Jazzy, keeps messages for late readers; of a program that exists or was
    observed nobody knows all of its ends.
    """
    topics = [each for each in architecture.endpoints if each.node == node.id and each.flow == "topic"]
    return (
        node.status != "existing"
        and not node.observed
        and bool(topics)
        and all(each.qos.durability == "volatile" and each.qos.history == "keep_last" for each in topics)
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


_SIMPLE_WORD = re.compile(r"[A-Za-z_/][A-Za-z0-9_./-]*\Z")
_GLOBAL_IN_ROS_1 = "use_sim_time"
"""In ROS 1 it is one parameter of all nodes."""
_SPECIAL_WORDS = frozenset({"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf", "infinity"})
"""Texts that YAML or ROS takes for something else."""
_ESCAPES = {code: f"\\u{code:04x}" for code in (*range(0x7F, 0xA0), 0x2028, 0x2029, 0xFEFF, 0xFFFE, 0xFFFF)}
"""What YAML wants escaped in quotes, and JSON does not."""


def list_ros_2_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words behind `--ros-args` that give a node its parameters: those that count most stand last."""
    for name, value in launch.earlier_values.items():
        yield from ("-p", f"{name}:={_write_value(launch, name, value)}")
    for path in launch.parameter_files:
        yield from ("--params-file", path)
    filled = {name: value for name, value in launch.file_values.items() if has_substitution(value)}
    # No file is filled in.
    for name, value in {**filled, **launch.own_values}.items():
        # With the node's name it counts more than what a file says to this node, and to all nodes alike.
        place = f"{launch.name}:" if name in launch.file_values and launch.namespace == "/" else ""
        yield from ("-p", f"{place}{name}:={_write_value(launch, name, value)}")


def list_loading_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words that give a loaded node its parameters in ROS 2: who loads it reads no files."""
    for name, value in launch.all_values.items():
        yield from ("-p", f"{name}:={_write_value(launch, name, value)}")


def list_ros_1_preparations(launch: RosLaunch) -> Iterator[tuple[str, ...]]:
    """Yield the commands that give a node its parameters in ROS 1 before it starts, where its own words cannot."""
    for name, value in launch.earlier_values.items():
        if launch.parameter_files or not _is_word_in_ros_1(name, value):
            yield _set_in_ros_1(launch, name, value)
    for path in launch.parameter_files:
        yield ("rosparam", "load", path, launch.full_name)
    filled = {name: value for name, value in launch.file_values.items() if has_substitution(value)}
    for name, value in {**filled, **launch.own_values}.items():
        if not _is_word_in_ros_1(name, value):
            yield _set_in_ros_1(launch, name, value)


def list_ros_1_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words that give a node its parameters in ROS 1: plain ones, which each client library reads alike."""
    earlier_values = {} if launch.parameter_files else launch.earlier_values
    for name, value in {**earlier_values, **launch.own_values}.items():
        if _is_word_in_ros_1(name, value):
            yield f"_{_nest_in_ros_1(name)}:={_format_value(value)}"


def _set_in_ros_1(launch: RosLaunch, name: str, value: object) -> tuple[str, ...]:
    place = "" if name == _GLOBAL_IN_ROS_1 else launch.full_name
    return ("rosparam", "set", f"{place}/{_nest_in_ros_1(name)}", _write_value(launch, name, value))


def _nest_in_ros_1(name: str) -> str:
    return name.replace(".", "/")


def _is_word_in_ros_1(name: str, value: object) -> bool:
    """Whether a value is a number, a boolean, or a text that nothing takes for something else."""
    if isinstance(value, str):
        return _is_simple(value)
    return isinstance(value, (int, float)) and name != _GLOBAL_IN_ROS_1


def _is_simple(text: str) -> bool:
    return _SIMPLE_WORD.match(text) is not None and text.lower() not in _SPECIAL_WORDS


def _write_value(launch: RosLaunch, name: str, value: object) -> str:
    """Return the value of a parameter as YAML. What may be a number stands there without quotes: `$(env PORT)`."""
    return str(value) if name in launch.untyped_names else _format_value(value)


def _format_value(value: object) -> str:
    """Format a value on one line as YAML that ROS 1 and 2 read alike."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_format_value(key)}: {_format_value(item)}' for key, item in value.items())}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_format_value(item) for item in value)}]"
    if isinstance(value, float):
        return _format_float(value)
    if isinstance(value, str):
        return value if _is_simple(value) else json.dumps(value, ensure_ascii=False).translate(_ESCAPES)
    return json.dumps(value)


def _format_float(value: float) -> str:
    if not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    text = repr(value)
    # Without a point, YAML 1.1 reads a text.
    return text.replace("e", ".0e") if "e" in text and "." not in text else text
