"""The commands that start nodes and containers, as lists of words. They are shown, and never run."""

from __future__ import annotations

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


def build_command(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """Return the words that start a node, or that load it into its container; none where that is not known."""
    if node.command:
        return node.command
    if is_ros_1(architecture.distro):
        return _build_ros_1_command(architecture, node)
    if node.plugin and node.package and not node.executable:
        container = architecture.containers.get(node.container or "")
        verb = ("load", container.full_name) if container else ("standalone",)
        names = ("--node-name", node.name, *(("--node-namespace", node.namespace) if node.namespace != "/" else ()))
        return ("ros2", "component", *verb, node.package, node.plugin, *names)
    if not node.package or not node.executable:
        return ()
    if "program" in node.kinds:
        return ("ros2", "run", node.package, node.executable)
    files = tuple(word for path in node.parameter_files for word in ("--params-file", path))
    return ("ros2", "run", node.package, node.executable, *_name_in_ros(node.name, node.namespace), *files)


def _build_ros_1_command(architecture: Architecture, node: Node) -> tuple[str, ...]:
    names = (f"__name:={node.name}", *((f"__ns:={node.namespace}",) if node.namespace != "/" else ()))
    if "nodelet" in node.kinds and node.plugin:
        if node.container is None:
            return ("rosrun", "nodelet", "nodelet", "standalone", node.plugin, *names)
        manager = architecture.containers[node.container]
        return ("rosrun", "nodelet", "nodelet", "load", node.plugin, manager.full_name, *names)
    return ("rosrun", node.package, node.executable, *names) if node.package and node.executable else ()


def _name_in_ros(name: str, namespace: str) -> tuple[str, ...]:
    return ("--ros-args", "-r", f"__node:={name}", *(("-r", f"__ns:={namespace}") if namespace != "/" else ()))


def build_container_command(architecture: Architecture, container: Container) -> tuple[str, ...]:
    """Return the words that start a container: its own program, else ROS's."""
    name = container.name or container.id
    if is_ros_1(architecture.distro):
        program = (container.package or "nodelet", container.executable or "nodelet")
        manager = () if container.package else ("manager",)
        namespace = (f"__ns:={container.namespace}",) if container.namespace != "/" else ()
        return ("rosrun", *program, *manager, f"__name:={name}", *namespace)
    default = "component_container" if container.threads in {None, 1} else "component_container_mt"
    program = (container.package or "rclcpp_components", container.executable or default)
    return ("ros2", "run", *program, *_name_in_ros(name, container.namespace))


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
