"""Do publishers offer the quality of service that subscribers ask for?"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.distro import is_ros_1
from archgen.source import NOWHERE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, Qos, Topic
    from archgen.model.quantity import Quantity
    from archgen.source import Span


class Clash(NamedTuple):
    """A QoS policy whose offered value does not satisfy the requested one; all parts are phrases for a message."""

    policy: str
    requested: str
    offered: str
    cure: str


def clashes(offered: Qos, requested: Qos) -> Iterator[Clash]:
    """Yield the conflicts between offered and requested reliability, durability, deadline, liveliness, lease duration.

    History, depth and lifespan never conflict. A duration of zero means "not given", as in ROS. The rules are those of
    https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html#qos-compatibilities.
    """
    if (offered.reliability, requested.reliability) == ("best_effort", "reliable"):
        yield Clash(
            "reliability",
            "reliable delivery",
            "best effort only",
            "`reliability: reliable` or `best_effort` on both sides",
        )
    if (offered.durability, requested.durability) == ("volatile", "transient_local"):
        yield Clash(
            "durability",
            "what was sent before it started (transient_local)",
            "no message kept for late comers (volatile)",
            "`durability: transient_local` at the publisher",
        )
    if _later(offered.deadline, requested.deadline):
        yield Clash(
            "deadline",
            f"a message every {requested.deadline}",
            f"one every {offered.deadline}" if _given(offered.deadline) else "no deadline",
            f"a `deadline` of {requested.deadline} or less at the publisher",
        )
    if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
        yield Clash(
            "liveliness",
            "a publisher that asserts by itself that it is alive (manual_by_topic)",
            "automatic signs of life",
            "`liveliness: manual_by_topic` at the publisher",
        )
    if _later(offered.lease_duration, requested.lease_duration):
        yield Clash(
            "lease duration",
            f"a sign of life every {requested.lease_duration}",
            f"one every {offered.lease_duration}" if _given(offered.lease_duration) else "none in any set time",
            f"a `lease_duration` of {requested.lease_duration} or less at the publisher",
        )


def incompatible_qos(architecture: Architecture) -> Iterator[Diagnostic]:
    """A subscriber asks for a quality of service that a publisher on its topic does not offer.

    Why: The two are not connected at all: the subscriber receives no message from this publisher, and both go on running as
    if nothing were wrong. It is an error where both sides wrote their settings, and a warning where one side left them out
    (ROS's default counts for it then) or to the middleware (`system_default`).

    Bad:
        groups:
          sensing:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              mapper: {inputs: {scan: scanner.scan}}
        nodes:
          scan_driver: {implements: scanner, publishes: {scan: {qos: sensor_data}}}
          mapper: {implements: mapper, subscribes: {scan: {qos: {reliability: reliable}}}}

    Good:
        groups:
          sensing:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              mapper: {inputs: {scan: scanner.scan}}
        nodes:
          scan_driver: {implements: scanner, publishes: {scan: {qos: sensor_data}}}
          mapper: {implements: mapper, subscribes: {scan: {qos: sensor_data}}}
    """
    if is_ros_1(architecture.distro):
        return  # has no quality of service to agree on
    for topic in architecture.topics.values():
        if topic.flow != "topic":
            continue
        for writer in topic.writers:
            for reader in topic.readers:
                # Planned nodes that archgen adds have no decided QoS that could conflict.
                if architecture.nodes[writer.node].written and architecture.nodes[reader.node].written:
                    yield from _judge(architecture, topic, writer, reader)


def _judge(architecture: Architecture, topic: Topic, writer: Endpoint, reader: Endpoint) -> Iterator[Diagnostic]:
    """Report all conflicts between a publisher and a subscriber in one diagnostic."""
    found = tuple(clashes(writer.qos, reader.qos))
    if not found:
        return
    wants = " and ".join(clash.requested for clash in found)
    gets = " and ".join(clash.offered for clash in found)
    assumed = next(filter(None, map(_assumption, (writer, reader))), "")
    yield Diagnostic(
        "incompatible-qos",
        f"`{reader.node}` receives nothing from `{writer.node}` on `{topic.name}`: it asks for {wants}, and is offered {gets}{assumed}",
        _place(architecture, reader),
        severity=Severity.WARNING if assumed else None,
        labels=(Label(_place(architecture, writer), "offered here"),),
        help=f"needed: {'; '.join(clash.cure for clash in found)}",
        element=reader.node,
    )


def _assumption(endpoint: Endpoint) -> str:
    """Describe what is assumed about one side's settings; empty if all of it is written."""
    if not endpoint.qos.written:
        return f" (`{endpoint.node}` leaves `qos` out, so the profile `default` counts)"
    if endpoint.qos.profile == "system_default":
        return f" (`{endpoint.node}` leaves it to the middleware, whose usual values count)"
    return ""


def _place(architecture: Architecture, endpoint: Endpoint) -> Span:
    """Return the span of an endpoint's QoS settings, else of its entry, else of its node."""
    written = (endpoint.qos.at, endpoint.at)
    return next((at for at in written if at != NOWHERE), architecture.nodes[endpoint.node].at)


def _given(duration: Quantity | None) -> bool:
    return duration is not None and duration.value > 0


def _later(offered: Quantity | None, requested: Quantity | None) -> bool:
    """Whether an offered duration is longer than the requested one; a duration that is not given is infinite."""
    if requested is None or not _given(requested):
        return False
    value: Fraction | None = offered.value if offered and _given(offered) else None
    return value is None or value > requested.value


RULES = ((incompatible_qos, Severity.ERROR),)
