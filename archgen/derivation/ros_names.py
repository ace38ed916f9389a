"""Absolute names of topics, services and actions.

The rules are those of https://design.ros2.org/articles/topic_and_service_names.html.
"""

from __future__ import annotations

from archgen.model.node import Node

SHARED_TOPICS = frozenset({"/tf", "/tf_static", "/clock", "/diagnostics", "/rosout", "/parameter_events"})
"""Topics that every node may use."""


def resolve_ros_name(written_name: str, node: Node) -> str:
    """Resolve a name as a node writes it: relative to its namespace, or with `~` to the node itself."""
    namespace = "/" + node.namespace.strip("/")
    name = written_name.replace("{node}", node.name)
    for placeholder in ("{ns}", "{namespace}"):
        name = name.replace(placeholder, namespace.strip("/") or "/")
    if name.startswith("/"):
        return "/" + name.lstrip("/")
    if name.startswith("~"):
        name = f"{node.name}/{name[1:].lstrip('/')}".rstrip("/")
    return f"{namespace.rstrip('/')}/{name}"


def default_port_name(port_id: str) -> str:
    """Return the name of a port for which no topic is written: `/group/component/port`."""
    return "/" + port_id.replace(".", "/")


def shared_topic_names(project_topics: tuple[str, ...]) -> frozenset[str]:
    """Return the topics that all nodes share: ROS's own, and those of `ros.shared_topics`."""
    return SHARED_TOPICS | {"/" + name.lstrip("/") for name in project_topics}
