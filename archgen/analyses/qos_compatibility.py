"""Do publishers offer the quality of service that subscribers ask for?"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.ros_distro import is_ros_1

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, Qos, Topic
    from archgen.model.quantity import Quantity


class QosConflict(NamedTuple):
    """A QoS policy whose offered value does not satisfy the requested one; all parts are phrases for a message."""

    policy: str
    requested: str
    offered: str
    remedy: str


def find_qos_conflicts(offered: Qos, requested: Qos) -> Iterator[QosConflict]:
    """Yield the conflicts between offered and requested reliability, durability, deadline, liveliness, lease duration.

    History, depth and lifespan never conflict. A duration of zero means "not given", as in ROS. The rules are those of
    https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html#qos-compatibilities.
    """
    if (offered.reliability, requested.reliability) == ("best_effort", "reliable"):
        yield QosConflict(
            "reliability",
            "reliable delivery",
            "best effort only",
            "`reliability: reliable` or `best_effort` on both sides",
        )
    if (offered.durability, requested.durability) == ("volatile", "transient_local"):
        yield QosConflict(
            "durability",
            "what was sent before it started (transient_local)",
            "no message kept for late comers (volatile)",
            "`durability: transient_local` at the publisher",
        )
    if _is_longer(offered.deadline, requested.deadline):
        yield QosConflict(
            "deadline",
            f"a message every {requested.deadline}",
            f"one every {offered.deadline}" if _is_given(offered.deadline) else "no deadline",
            f"a `deadline` of {requested.deadline} or less at the publisher",
        )
    if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
        yield QosConflict(
            "liveliness",
            "a publisher that asserts by itself that it is alive (manual_by_topic)",
            "automatic signs of life",
            "`liveliness: manual_by_topic` at the publisher",
        )
    if _is_longer(offered.lease_duration, requested.lease_duration):
        yield QosConflict(
            "lease duration",
            f"a sign of life every {requested.lease_duration}",
            f"one every {offered.lease_duration}" if _is_given(offered.lease_duration) else "none in any set time",
            f"a `lease_duration` of {requested.lease_duration} or less at the publisher",
        )


def incompatible_qos(architecture: Architecture) -> Iterator[Diagnostic]:
    """A subscriber asks for a quality of service that a publisher on its topic does not offer."""
    if is_ros_1(architecture.distro):
        return  # has no quality of service to agree on
    for topic in architecture.topics.values():
        if topic.flow != "topic":
            continue
        for writer in topic.writers:
            for reader in topic.readers:
                # Planned nodes that archgen adds have no decided QoS that could conflict.
                if architecture.nodes[writer.node].written and architecture.nodes[reader.node].written:
                    yield from _report_qos_conflicts(architecture, topic, writer, reader)


def _report_qos_conflicts(
    architecture: Architecture, topic: Topic, writer: Endpoint, reader: Endpoint
) -> Iterator[Diagnostic]:
    """Report all conflicts between a publisher and a subscriber in one diagnostic."""
    verdicts = [
        tuple(find_qos_conflicts(offered, requested))
        for offered in _list_qos(writer)
        for requested in _list_qos(reader)
    ]
    conflicts = next(filter(None, verdicts), ())
    if not conflicts:
        return
    requests = " and ".join(conflict.requested for conflict in conflicts)
    offers = " and ".join(conflict.offered for conflict in conflicts)
    assumption = next(filter(None, map(_describe_assumption, (writer, reader))), "")
    if not all(verdicts):
        unsure = writer if writer.qos_if_ignored else reader
        assumption = f" (where `{unsure.node}` {'obeys' if verdicts[0] else 'ignores'} the overrides that it is given)"
    yield Diagnostic(
        "incompatible-qos",
        f"`{reader.node}` receives nothing from `{writer.node}` on `{topic.name}`: it asks for {requests}, and is offered {offers}{assumption}",
        _qos_span(architecture, reader),
        severity=Severity.WARNING if assumption else None,
        labels=(Label(_qos_span(architecture, writer), "offered here"),),
        help=f"needed: {'; '.join(conflict.remedy for conflict in conflicts)}",
        element=reader.node,
    )


def _list_qos(endpoint: Endpoint) -> tuple[Qos, ...]:
    """Return what one side may have: both where it is unknown whether its program takes overrides."""
    return (endpoint.qos, endpoint.qos_if_ignored) if endpoint.qos_if_ignored else (endpoint.qos,)


def _describe_assumption(endpoint: Endpoint) -> str:
    """Describe what is assumed about one side's settings; empty if all of it is written."""
    if not endpoint.qos.written:
        return f" (`{endpoint.node}` leaves `qos` out, so the profile `default` counts)"
    if endpoint.qos.profile == "system_default":
        return f" (`{endpoint.node}` leaves it to the middleware, whose usual values count)"
    return ""


def _qos_span(architecture: Architecture, endpoint: Endpoint) -> Span:
    """Return the span of an endpoint's QoS settings, else of its entry, else of its node."""
    written_spans = (endpoint.qos.at, endpoint.at)
    return next((span for span in written_spans if span != NO_SPAN), architecture.nodes[endpoint.node].at)


def _is_given(duration: Quantity | None) -> bool:
    return duration is not None and duration.value > 0


def _is_longer(offered: Quantity | None, requested: Quantity | None) -> bool:
    """Whether an offered duration is longer than the requested one; a duration that is not given is infinite."""
    if requested is None or not _is_given(requested):
        return False
    offered_value: Fraction | None = offered.value if offered and _is_given(offered) else None
    return offered_value is None or offered_value > requested.value


RULES = ((incompatible_qos, Severity.ERROR),)
