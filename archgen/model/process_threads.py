"""How many threads take the callbacks of a process, and in which order: what is started is what is judged."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.declared_timing import SchedulingOrder
from archgen.model.deployment import Container
from archgen.model.port_media import ROS
from archgen.model.ros_distro import is_ros_1

MANY_THREADED = "component_container_mt"
"""The program of ROS 2 that takes as many threads as it is told, or else as there are cores."""
_MANY_THREADED_PROGRAMS = frozenset({MANY_THREADED, "component_container_isolated"})


def find_container_threads(architecture: Architecture, container: Container) -> int | None:
    """Return the threads of a container, None where there are as many as are asked for.

    Where nothing is written, ROS 2 starts `component_container`, which has one; a nodelet manager of ROS 1 has one for
    each core, and other middlewares have one for each component.
    """
    if container.threads is not None:
        return container.threads
    has_many = container.executable in _MANY_THREADED_PROGRAMS or is_ros_1(architecture.distro)
    return None if has_many or architecture.project.middleware != ROS else 1


def find_usual_order(architecture: Architecture) -> SchedulingOrder | None:
    """Return the order in which a process takes callbacks where none is written; None where the middleware tells none.

    ROS 2 works through wait sets, in C++ and in Python; ROS 1 has a queue.
    """
    if architecture.project.middleware != ROS:
        return None
    return "fifo" if is_ros_1(architecture.distro) else "ros2_executor"
