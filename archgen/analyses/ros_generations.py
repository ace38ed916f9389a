"""Do nodes use only what the ROS generation of the project has?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.model.known_interfaces import KNOWN_DISTROS, guess_distro
from archgen.model.node import Qos
from archgen.model.ros_distro import PAST_DISTROS, is_ros_1

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Node

_KIND_REMEDIES = {
    "lifecycle": "leave it out: a node of ROS 1 has no managed states",
    "composable": "write `nodelet`, which is what ROS 1 loads into one process",
    "nodelet": "write `composable`, which is what ROS 2 loads into one process",
}
_ROS_1_KINDS = frozenset({"nodelet"})
_ROS_2_KINDS = frozenset({"lifecycle", "composable"})
_ROS_2_QOS_KEYS = ("reliability", "history", "deadline", "lifespan", "liveliness", "lease_duration")
"""`depth` is the queue size of ROS 1, and `durability: transient_local` its latched topic: both may stand there."""


def other_ros_generation(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node uses what only the other generation of ROS has."""
    distro = guess_distro(architecture.distro)
    if distro not in KNOWN_DISTROS and distro not in PAST_DISTROS:
        return
    foreign_kinds, generation = (_ROS_2_KINDS, "ROS 1") if is_ros_1(distro) else (_ROS_1_KINDS, "ROS 2")
    for node in architecture.nodes.values():
        for kind in node.kinds:
            if kind in foreign_kinds:
                yield Diagnostic(
                    "other-ros-generation",
                    f"the node `{node.id}` is of the kind `{kind}`, which {generation} ({distro}) does not have",
                    node.kind_at,
                    help=_KIND_REMEDIES[kind],
                    element=node.id,
                )
        if is_ros_1(distro):
            yield from _report_foreign_qos(node, distro)


def _report_foreign_qos(node: Node, distro: str | None) -> Iterator[Diagnostic]:
    """Report the quality of service of a node of ROS 1: all of its entries in one finding, at the first."""
    foreign_uses = [use for use in node.uses if use.qos is not None and _needs_ros_2(use.qos)]
    first_qos = foreign_uses[0].qos if foreign_uses else None
    if first_qos is not None:
        keys = join_words([f"`{use.key}`" for use in foreign_uses])
        yield Diagnostic(
            "other-ros-generation",
            f"the node `{node.id}` sets the quality of service of {keys}, which ROS 1 ({distro}) does not have",
            first_qos.at,
            help="leave it out; of `qos`, ROS 1 has `depth` (its queue size) and `durability: transient_local` (latched)",
            element=node.id,
        )


def _needs_ros_2(qos: Qos) -> bool:
    """Whether settings ask for more than what every topic of ROS 1 has."""
    return any(getattr(qos, key) != getattr(Qos(), key) for key in _ROS_2_QOS_KEYS)


RULES = ((other_ros_generation, Severity.WARNING),)
