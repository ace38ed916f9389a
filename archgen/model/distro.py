"""Which ROS distributions are ROS 1: some rules differ between the two generations."""

from __future__ import annotations

ROS_1 = frozenset({"groovy", "hydro", "indigo", "jade", "kinetic", "lunar", "melodic", "noetic"})
"""Those that may still run somewhere. Any other name, or none, is taken for ROS 2."""


def is_ros_1(distro: str | None) -> bool:
    """Tell whether a distribution is one of ROS 1."""
    return distro in ROS_1
