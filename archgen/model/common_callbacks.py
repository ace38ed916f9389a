"""The topics and services that ROS gives each node, so that nobody writes them."""

from __future__ import annotations

_COMMON_TOPICS = frozenset({"/parameter_events", "/rosout", "/clock"})
_COMMON_SERVICES = frozenset(
    {
        *("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters", "set_parameters"),
        *("set_parameters_atomically", "get_type_description", "get_logger_levels", "set_logger_levels"),
        *("change_state", "get_state", "get_available_states", "get_available_transitions", "get_transition_graph"),
    }
)
"""What rclcpp gives each node, or each lifecycle node, without anybody writing it."""


def is_common_callback(kind: str, name: str) -> bool:
    """Whether a callback is one that ROS gives each node."""
    if kind == "subscription":
        return name in _COMMON_TOPICS
    return kind == "service" and (name.rpartition("/")[2] in _COMMON_SERVICES or "/_action/" in name)
