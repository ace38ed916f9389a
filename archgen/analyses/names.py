"""Does ROS accept the names of nodes, namespaces, topics and services, and is every node's name unique?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.distro import is_ros_1
from archgen.source import NOWHERE, Span

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Node

_OTHER = re.compile(r"[^A-Za-z0-9_]")
_SUBSTITUTION = re.compile(r"\{(?:node|ns|namespace)\}")


def name_fault(text: str, *, ros_1: bool = False) -> str | None:
    """Return what is wrong with the name of a topic, service or namespace, or None.

    The rules are those of https://design.ros2.org/articles/topic_and_service_names.html as far as ROS 2 enforces them, and
    of http://wiki.ros.org/Names for ROS 1, where only the first letter of the whole name must not be a digit.
    """
    if not text:
        return "it is empty"
    rest = text
    if text.startswith("~"):
        rest = text[1:]
        if rest and not rest.startswith("/"):
            return "`~` is followed by `/`"
    if rest == "/" or not rest:
        return None
    if rest.endswith("/"):
        return "it ends with `/`"
    # Substitutions such as `{node}` are replaced by a valid name; other braces remain and are reported.
    tokens = _SUBSTITUTION.sub("x", rest.removeprefix("/")).split("/")
    for position, token in enumerate(tokens):
        fault = _token_fault(token, digit_first=ros_1 and (position > 0 or rest.startswith("/")))
        if fault:
            return fault
    return None


def node_name_fault(name: str) -> str | None:
    """Return what is wrong with a node's name, or None."""
    if "/" in name:
        return "it holds `/`: what stands before the name belongs into `namespace`"
    return _token_fault(name, digit_first=False) if name else "it is empty"


def _token_fault(token: str, *, digit_first: bool) -> str | None:
    if not token:
        return "two `/` follow one another"
    other = _OTHER.search(token)
    if other:
        what = "a blank" if other[0].isspace() else f"`{other[0]}`"
        return f"it holds {what}, and only letters (a to z), digits and `_` are allowed"
    if token[0].isdigit() and not digit_first:
        return f"`{token}` begins with a digit"
    return None


def invalid_ros_name(architecture: Architecture) -> Iterator[Diagnostic]:
    """ROS does not accept the name of a node, a namespace, a topic, a service or an action.

    Why: The node would stop at its start with an exception. Names consist of letters, digits and `_`, in parts divided by `/`,
    and (in ROS 2) no part begins with a digit.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera_driver: {implements: camera, publishes: {image: {topic: /front-camera/image}}}
          image_view: {implements: screen}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera_driver: {implements: camera, publishes: {image: {topic: /front_camera/image}}}
          image_view: {implements: screen}
    """
    ros_1 = is_ros_1(architecture.distro)
    for node in architecture.nodes.values():
        if not node.written:
            continue
        fault = node_name_fault(node.name)
        if fault:
            yield _invalid(node, "a node", node.name, node.name_at, fault)
        fault = name_fault(node.namespace, ros_1=ros_1)
        if fault and node.namespace:
            yield _invalid(node, "a namespace", node.namespace, node.at, fault)
        for use in node.uses:
            sort = "a topic" if use.use in {"publishes", "subscribes"} else "a service or action"
            # Only the linker fills in `topic_places`, one span for each topic.
            places = use.topic_places or (use.at,) * len(use.topics)
            for topic, place in zip(use.topics, places, strict=True):
                fault = "it is only a `/`" if topic == "/" else name_fault(topic, ros_1=ros_1)
                if fault:
                    yield _invalid(node, sort, topic, place, fault)


def _invalid(node: Node, sort: str, name: str, place: Span, fault: str) -> Diagnostic:
    message = f"`{name}` cannot be the name of {sort}: {fault}"
    return Diagnostic("invalid-ros-name", message, node.at if place == NOWHERE else place, element=node.id)


def _place(node: Node) -> Span:
    """Return the span of a node's `name`, else of the node."""
    return node.at if node.name_at == NOWHERE else node.name_at


def duplicate_node_name(architecture: Architecture) -> Iterator[Diagnostic]:
    """Two nodes have one name.

    Why: In ROS 1 the node that starts later shuts the earlier one down; in ROS 2 both run, and nobody can tell them apart
    (parameters, life cycle and remappings reach one of them by chance).

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera_driver: {implements: camera, name: usb_cam}
          image_view: {implements: screen, name: usb_cam}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera_driver: {implements: camera, name: usb_cam}
          image_view: {implements: screen, name: usb_cam, namespace: /operator}
    """
    first: dict[str, Node] = {}
    for node in architecture.nodes.values():
        if not node.written:
            continue
        earlier = first.setdefault(node.full_name, node)
        if earlier is not node:
            yield Diagnostic(
                "duplicate-node-name",
                f"`{node.id}` has the name `{node.full_name}`, which is the name of `{earlier.id}`",
                _place(node),
                labels=(Label(_place(earlier), "the first one"),),
                help="give one of them another `name` or `namespace`",
                element=node.id,
            )


RULES = (
    (invalid_ros_name, Severity.ERROR),
    (duplicate_node_name, Severity.WARNING),
)
