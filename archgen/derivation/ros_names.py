"""Names of topics that follow from the model alone: of ports without a topic, and of topics that all nodes share."""

from __future__ import annotations

SHARED_TOPICS = frozenset({"/tf", "/tf_static", "/clock", "/diagnostics", "/rosout", "/parameter_events"})
"""Topics that every node may use."""


def default_port_name(port_id: str) -> str:
    """Return the name of a port for which no topic is written: `/group/component/port`."""
    return "/" + port_id.replace(".", "/")


def shared_topic_names(project_topics: tuple[str, ...]) -> frozenset[str]:
    """Return the topics that all nodes share: ROS's own, and those of `ros.shared_topics`."""
    return SHARED_TOPICS | {"/" + name.lstrip("/") for name in project_topics}
