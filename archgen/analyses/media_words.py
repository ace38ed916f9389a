"""Are the words for media known, and is nothing written for ROS where there is no ROS?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.port_media import MEDIUM_NAMES, is_physical, name_medium, uses_ros

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.node import Node


def unlisted_medium(architecture: Architecture) -> Iterator[Diagnostic]:
    """The word for a medium is none that archgen knows, and stands in one place of the project only."""
    places = _find_places(architecture)
    for word, spans in places.items():
        if word in MEDIUM_NAMES or word == architecture.project.middleware or len(spans) > 1:
            continue
        (span, element), *_ = spans.items()
        others = [other for other in (*MEDIUM_NAMES, *places) if other != word]
        yield Diagnostic(
            "unlisted-medium",
            f"`{word}` is no medium that archgen knows, and is written only here",
            span,
            help=did_you_mean(word, others)
            or "any word counts: written a second time, it is taken for one that is meant",
            element=element,
        )


def _find_places(architecture: Architecture) -> Mapping[str, Mapping[Span, str]]:
    """Return where each word is written, with the element there. What instances have from their type is one place."""
    places: dict[str, dict[Span, str]] = defaultdict(dict)
    for component in architecture.list_described_components():
        for port in component.ports:
            if port.medium_at != NO_SPAN and port.medium_written:
                places[port.medium].setdefault(port.medium_at, component.id)
    for link in architecture.links.values():
        if link.protocol:
            places[link.protocol].setdefault(link.protocol_at, link.id)
    return places


def unused_ros_setting(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something is written that only ROS has, at a port or a program that is no ROS."""
    for node in architecture.nodes.values():
        for key, place, reason in (*_list_port_settings(architecture, node), *_list_program_settings(node)):
            yield Diagnostic(
                "unused-ros-setting",
                f"`{key}` of `{node.id}` has no effect: {reason}",
                place if place != NO_SPAN else node.at,
                help="leave it out",
                element=node.id,
            )


def _list_port_settings(architecture: Architecture, node: Node) -> Iterator[tuple[str, Span, str]]:
    """Yield what is written for ROS at ports that travel over something else: key, place, and why it means nothing."""
    for use in node.uses:
        ports = architecture.outputs if use.use in {"publishes", "serves"} else architecture.inputs
        port = ports.get(use.port or "")
        # Of a physical port nothing at all is listed at a node: another rule says so.
        if port is None or uses_ros(port) or is_physical(port):
            continue
        reason = f"`{port.name}` is {name_medium(port.medium)} and no ROS"
        if use.qos is not None and use.qos.written:
            yield f"{use.use}.{use.key}.qos", use.qos.at, reason
        if use.message is not None:
            yield f"{use.use}.{use.key}.message", use.message_at, reason


def _list_program_settings(node: Node) -> Iterator[tuple[str, Span, str]]:
    """Yield what is written for ROS at a program."""
    if not node.is_program:
        return
    reason = "a program is no node of ROS"
    if node.name_at != NO_SPAN:
        yield "name", node.name_at, reason
    if node.namespace != "/":
        yield "namespace", node.at, reason
    if node.container is not None:
        yield "container", node.container_at, "a program is a process of its own"
    for kind in node.kinds:
        if kind != "program":
            yield f"kind: {kind}", node.kind_at, reason
    if node.parameters or node.parameter_commands:
        places = [value.at for value in node.own_values]
        yield "parameters", places[0] if places else node.at, reason
    if node.parameter_files:
        yield "parameter_files", node.at, reason


RULES = (
    (unlisted_medium, Severity.NOTE),
    (unused_ros_setting, Severity.WARNING),
)
