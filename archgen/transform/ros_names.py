"""Absolute names of topics, services and actions, from what is written at a node.

The rules are those of https://design.ros2.org/articles/topic_and_service_names.html.
"""

from __future__ import annotations

from archgen.model.node import Node

SHARED_TOPICS = frozenset({"/tf", "/tf_static", "/clock", "/diagnostics", "/rosout", "/parameter_events"})
"""What any node may use, whoever it belongs to."""


def absolute(written: str, node: Node) -> str:
    """Resolve a name: relative to the node's namespace, `~` to the node itself; an absolute one stays."""
    namespace = "/" + node.namespace.strip("/")
    name = written.replace("{node}", node.name)
    for word in ("{ns}", "{namespace}"):
        name = name.replace(word, namespace.strip("/") or "/")
    if name.startswith("/"):
        return "/" + name.lstrip("/")
    if name.startswith("~"):
        name = f"{node.name}/{name[1:].lstrip('/')}".rstrip("/")
    return f"{namespace.rstrip('/')}/{name}"


def of_port(port: str) -> str:
    """Give the name of a port for which nobody wrote one: `/group/component/port`."""
    return "/" + port.replace(".", "/")


def shared_names(extra: tuple[str, ...]) -> frozenset[str]:
    """Give the topics that all nodes share: ROS's own, and the project's."""
    return SHARED_TOPICS | {"/" + name.lstrip("/") for name in extra}
