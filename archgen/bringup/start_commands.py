"""The commands that start nodes and containers, as lists of words. They are shown, and never run."""

from __future__ import annotations

from archgen.bringup.parameter_words import (
    list_loading_options,
    list_ros_1_options,
    list_ros_1_preparations,
    list_ros_2_options,
)
from archgen.bringup.plan_shapes import RosLaunch
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import Node
from archgen.model.ros_distro import is_ros_1
from archgen.model.start_up import NO_START

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
    words = (*launch.arguments, *_name_in_ros_1(launch), *_list_remaps(launch), *list_ros_1_options(launch))
    if "nodelet" in node.kinds and launch.plugin:
        verb = ("load", launch.plugin, launch.container) if launch.container else ("standalone", launch.plugin)
        return ("rosrun", "nodelet", "nodelet", *verb, *words)
    return ("rosrun", launch.package, launch.executable, *words) if launch.package and launch.executable else ()


def _name_in_ros_1(launch: RosLaunch) -> tuple[str, ...]:
    return (f"__name:={launch.name}", *((f"__ns:={launch.namespace}",) if launch.namespace != "/" else ()))


def build_container_command(architecture: Architecture, container: Container, launch: RosLaunch) -> tuple[str, ...]:
    """Return the words that start a container: its own program, else ROS's."""
    if not is_ros_1(architecture.distro):
        return _run_in_ros_2(launch)
    manager = () if container.package else ("manager",)
    program = (launch.package or "", launch.executable or "")
    return ("rosrun", *program, *manager, *_name_in_ros_1(launch), *list_ros_1_options(launch))


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
