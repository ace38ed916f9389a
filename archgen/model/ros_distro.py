"""Which ROS distributions are ROS 1: some rules differ between the two generations."""

from __future__ import annotations

ROS_1_DISTROS = frozenset({"groovy", "hydro", "indigo", "jade", "kinetic", "lunar", "melodic", "noetic"})
"""The ROS 1 distributions that may still be in use. Any other name, or none, counts as ROS 2."""
PAST_DISTROS = ROS_1_DISTROS | {"ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic", "iron"}
"""Distributions that are no longer maintained: right names, also where archgen holds no interfaces of them."""


def is_ros_1(distro: str | None) -> bool:
    """Whether a distribution is one of ROS 1; False for None."""
    return distro in ROS_1_DISTROS


def knows_super_clients(distro: str | None) -> bool:
    """Whether what looks at nodes sees those that a discovery server joins: Fast DDS 2.13 and later, in ROS 2 since Jazzy."""
    return distro not in PAST_DISTROS | {"humble"}


def can_name_peers(distro: str | None) -> bool:
    """Whether nodes of a distribution find those of other hosts by addresses in the environment: ROS 2 since Iron."""
    return distro not in (PAST_DISTROS - {"iron"}) | {"humble"}
