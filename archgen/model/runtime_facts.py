"""What runs when a design is started, as ROS's client libraries have it: what is started is what is judged.

Launch files, generated code, timing, simulation and texts ask here, and nowhere else. What was only read in sources of rclcpp,
and not seen running, is marked so in docs/timing.md.
"""

from __future__ import annotations

from collections.abc import Sequence

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import InputTiming, SchedulingOrder
from archgen.model.deployment import Container
from archgen.model.node import Endpoint, Node
from archgen.model.port_media import ROS
from archgen.model.ros_distro import is_ros_1

MANY_THREADED = "component_container_mt"
"""The program of ROS 2 that takes as many threads as it is told, or else as there are cores."""
_ISOLATED = "component_container_isolated"
"""The program of ROS 2 that has a thread for each of its nodes."""
TRANSFORM_MESSAGE = "tf2_msgs/msg/TFMessage"


@dataclass(frozen=True, slots=True)
class ClientLibrary:
    """How a client library works off what is ready."""

    computes_at_once: bool
    """Whether all threads of a process compute at the same time; of CPython one does, while the others may wait."""
    serves_by_kind: bool
    """Whether an executor of one thread serves all timers of a round before its subscriptions, these before its services."""


RCLCPP = ClientLibrary(computes_at_once=True, serves_by_kind=True)
RCLPY = ClientLibrary(computes_at_once=False, serves_by_kind=False)
"""It serves node by node, in no fixed order of nodes."""


def find_library(nodes: Sequence[Node]) -> ClientLibrary:
    """Return how a process of some nodes works: as Python does, where all of them are written in it."""
    return RCLPY if nodes and all(node.language == "python" for node in nodes) else RCLCPP


def find_usual_order(architecture: Architecture) -> SchedulingOrder | None:
    """Return the order in which a process takes callbacks where none is written; None where the middleware tells none.

    ROS 2 works through wait sets, in C++ and in Python; ROS 1 has a queue.
    """
    if architecture.project.middleware != ROS:
        return None
    return "fifo" if is_ros_1(architecture.distro) else "ros2_executor"


def find_container_threads(architecture: Architecture, container: Container) -> int | None:
    """Return the threads of a container, None where there are as many as are asked for.

    Where nothing is written, ROS 2 starts `component_container`, which has one; a nodelet manager of ROS 1 has one for
    each core, and other middlewares have one for each component.
    """
    if container.threads is not None and container.executable != _ISOLATED:
        return container.threads
    has_many = container.executable in {MANY_THREADED, _ISOLATED} or is_ros_1(architecture.distro)
    return None if has_many or architecture.project.middleware != ROS else 1


def is_isolated(architecture: Architecture, node: Node) -> bool:
    """Whether one thread works for all of a node, whatever is written of its callbacks: its container has one for each."""
    container = architecture.containers.get(node.container or "")
    return container is not None and container.executable == _ISOLATED


def count_node_threads(node: Node) -> int:
    """Return the threads of a node outside of a container: one where nothing is written, as `spin(node)` has it."""
    return node.threads or 1


def keeps_each_source(reader: Endpoint, written: InputTiming) -> bool:
    """Whether an input keeps the newest message of each source, and not only the last one of each of its topics.

    A topic of ROS is one subscription, whoever publishes there. The buffer of tf2 keeps each frame, and what is no ROS
    has a connection for each source.
    """
    return written.memory is not None or reader.medium != ROS or reader.message == TRANSFORM_MESSAGE
