"""The calls by which programs speak to ROS, in rclpy, rclcpp, rospy and roscpp: what each makes, and where its name and type stand."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from archgen.plugins.ros.sources.walk_values import ExternalName, settle


class EndpointCall(NamedTuple):
    """What a call makes. Positions count its arguments from 0; `type_at` None: the type stands in `<...>`, or is the callback's."""

    use: str
    flow: str
    name_at: int
    type_at: int | None = None
    qos_at: int | None = None
    node_at: int | None = None
    callback_at: int | None = None


_PUBLISH, _SUBSCRIBE, _SERVE, _CALL = "publishes", "subscribes", "serves", "calls"

RCLPY_METHODS = MappingProxyType(
    {
        "create_publisher": EndpointCall(_PUBLISH, "topic", 1, 0, 2),
        "create_lifecycle_publisher": EndpointCall(_PUBLISH, "topic", 1, 0, 2),
        "create_subscription": EndpointCall(_SUBSCRIBE, "topic", 1, 0, 3),
        "create_service": EndpointCall(_SERVE, "service", 1, 0),
        "create_client": EndpointCall(_CALL, "service", 1, 0),
    }
)
RCLCPP_METHODS = MappingProxyType(
    {
        "create_publisher": EndpointCall(_PUBLISH, "topic", 0, None, 1),
        "create_subscription": EndpointCall(_SUBSCRIBE, "topic", 0, None, 1, None, 2),
        "create_service": EndpointCall(_SERVE, "service", 0),
        "create_client": EndpointCall(_CALL, "service", 0),
        "create_generic_publisher": EndpointCall(_PUBLISH, "topic", 0, 1, 2),
        "create_generic_subscription": EndpointCall(_SUBSCRIBE, "topic", 0, 1, 2),
    }
)
ROSCPP_METHODS = MappingProxyType(
    {
        "advertise": EndpointCall(_PUBLISH, "topic", 0, None, 1),
        "subscribe": EndpointCall(_SUBSCRIBE, "topic", 0, None, 1, None, 2),
        "advertiseService": EndpointCall(_SERVE, "service", 0, None, None, None, 1),
        "serviceClient": EndpointCall(_CALL, "service", 0),
    }
)
_ACTION_SERVER, _ACTION_CLIENT = (
    EndpointCall(_SERVE, "action", 2, 1, None, 0),
    EndpointCall(_CALL, "action", 2, 1, None, 0),
)
FUNCTIONS = MappingProxyType(
    {
        "rclpy.action.ActionServer": _ACTION_SERVER,
        "rclpy.action.server.ActionServer": _ACTION_SERVER,
        "rclpy.action.ActionClient": _ACTION_CLIENT,
        "rclpy.action.client.ActionClient": _ACTION_CLIENT,
        "message_filters.Subscriber": EndpointCall(_SUBSCRIBE, "topic", 2, 1, None, 0),
        "rospy.Publisher": EndpointCall(_PUBLISH, "topic", 0, 1),
        "rospy.Subscriber": EndpointCall(_SUBSCRIBE, "topic", 0, 1),
        "rospy.wait_for_message": EndpointCall(_SUBSCRIBE, "topic", 0, 1),
        "rospy.Service": EndpointCall(_SERVE, "service", 0, 1),
        "rospy.ServiceProxy": EndpointCall(_CALL, "service", 0, 1),
        "actionlib.SimpleActionServer": EndpointCall(_SERVE, "action", 0, 1),
        "actionlib.ActionServer": EndpointCall(_SERVE, "action", 0, 1),
        "actionlib.SimpleActionClient": EndpointCall(_CALL, "action", 0, 1),
        "actionlib.ActionClient": EndpointCall(_CALL, "action", 0, 1),
        "rclcpp_action.create_server": EndpointCall(_SERVE, "action", 1, None, None, 0),
        "rclcpp_action.create_client": EndpointCall(_CALL, "action", 1, None, None, 0),
        "rclcpp.create_publisher": EndpointCall(_PUBLISH, "topic", 1, None, 2, 0),
        "rclcpp.create_subscription": EndpointCall(_SUBSCRIBE, "topic", 1, None, 2, 0),
        "rclcpp.create_service": EndpointCall(_SERVE, "service", 1, None, None, 0),
        "rclcpp.create_client": EndpointCall(_CALL, "service", 1, None, None, 0),
        "nav2_util.SimpleActionServer": EndpointCall(_SERVE, "action", 1, None, None, 0),
        "nav2_util.ServiceClient": EndpointCall(_CALL, "service", 0, None, None, 1),
        "realtime_tools.RealtimePublisher": EndpointCall(_PUBLISH, "topic", 1, None, None, 0),
    }
)
IMAGE_TYPES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo")
IMAGE_CALLS: Mapping[str, tuple[str, bool]] = MappingProxyType(
    {
        "advertise": (_PUBLISH, False),
        "subscribe": (_SUBSCRIBE, False),
        "advertiseCamera": (_PUBLISH, True),
        "subscribeCamera": (_SUBSCRIBE, True),
        "create_publisher": (_PUBLISH, False),
        "create_subscription": (_SUBSCRIBE, False),
        "create_camera_publisher": (_PUBLISH, True),
        "create_camera_subscription": (_SUBSCRIBE, True),
    }
)
"""Calls of image_transport, and whether each has the calibration of its camera beside the images."""
_TF, _DIAGNOSTICS = "tf2_msgs/msg/TFMessage", "diagnostic_msgs/msg/DiagnosticArray"
FIXED_ENDPOINTS: Mapping[str, tuple[tuple[str, str, str], ...]] = MappingProxyType(
    {
        "TransformBroadcaster": ((_PUBLISH, "/tf", _TF),),
        "StaticTransformBroadcaster": ((_PUBLISH, "/tf_static", _TF),),
        "TransformListener": ((_SUBSCRIBE, "/tf", _TF), (_SUBSCRIBE, "/tf_static", _TF)),
        "Updater": ((_PUBLISH, "/diagnostics", _DIAGNOSTICS),),
    }
)
"""What classes of tf2_ros, tf and diagnostic_updater make, whose names nobody gives."""
FIXED_PACKAGES = frozenset({"tf2_ros", "tf", "diagnostic_updater"})

NODE_CLASSES = frozenset(
    {
        "rclpy.node.Node",
        "rclpy.create_node",
        "rclpy.lifecycle.Node",
        "rclpy.lifecycle.LifecycleNode",
        "rclpy.lifecycle.node.Node",
        "rclcpp.Node",
        "rclcpp.Node.make_shared",
        "rclcpp_lifecycle.LifecycleNode",
        "rclcpp_lifecycle.LifecycleNode.make_shared",
        "nav2_util.LifecycleNode",
        "nav2.LifecycleNode",
        "nodelet.Nodelet",
        "nodelet_topic_tools.NodeletLazy",
    }
)
HOOKS = frozenset(
    {
        "on_configure",
        "on_activate",
        "on_deactivate",
        "on_cleanup",
        "on_shutdown",
        "onInit",
        "run",
    }
)
"""Methods that ROS, or a thread, calls."""
TIMERS = frozenset({"create_timer", "create_wall_timer", "createTimer", "createWallTimer", "createSteadyTimer"})

_POINTER = re.compile(r"(?:::)?(?:Const)?(?:Shared|Unique|Weak)?Ptr$")
_HELD = re.compile(r"(?:std|boost|rclcpp)::(?:shared_ptr|unique_ptr|MessageEvent)<(.*)>$")


def read_message_name(text: str, flow: str) -> str:
    """Return the name of a message, service or action, from the name of its class in either language; empty for what is none."""
    held = _HELD.match(text)
    plain = _POINTER.sub("", held[1] if held else text).replace("::", ".").strip(".")
    plain = re.sub(r"<.*>", "", plain.replace("<std.allocator<void>>", "")).removesuffix("_")
    parts = plain.split(".")
    kind = {"topic": "msg", "service": "srv", "action": "action"}[flow]
    if len(parts) >= 4 and parts[-3] in {"msg", "srv", "action"}:  # noqa: PLR2004 - module of one message, `std_msgs.msg._string.String`
        parts = [*parts[:-2], parts[-1]]
    if len(parts) == 3 and parts[1] in {"msg", "srv", "action"}:  # noqa: PLR2004 - package, kind, name
        package, written, name = parts
        if flow == "action" and written == "msg" and name.endswith("Action"):
            return f"{package}/action/{name.removesuffix('Action')}"
        return f"{package}/{written}/{name}"
    if len(parts) == 2 and parts[0][:1].islower() and parts[1][:1].isupper():  # noqa: PLR2004 - roscpp's `std_msgs::String`
        name = parts[1].removesuffix("Action") if flow == "action" else parts[1]
        return f"{parts[0]}/{kind}/{name}"
    return ""


_PROFILES = {
    "qos_profile_sensor_data": "sensor_data",
    "SensorDataQoS": "sensor_data",
    "rmw_qos_profile_sensor_data": "sensor_data",
    "SystemDefaultsQoS": "system_default",
    "qos_profile_system_default": "system_default",
    "ServicesQoS": "services",
    "qos_profile_services_default": "services",
    "ParametersQoS": "parameters",
    "qos_profile_parameters": "parameters",
}
_POLICIES = {
    "BEST_EFFORT": ("reliability", "best_effort"),
    "RELIABLE": ("reliability", "reliable"),
    "TRANSIENT_LOCAL": ("durability", "transient_local"),
    "VOLATILE": ("durability", "volatile"),
    "KEEP_LAST": ("history", "keep_last"),
    "KEEP_ALL": ("history", "keep_all"),
}
_SETTERS = frozenset({"best_effort", "reliable", "transient_local", "durability_volatile", "keep_all"})


def read_qos_name(name: str) -> dict[str, Any] | None:
    """Return the QoS that a name stands for: a profile, or one policy; None for another name."""
    last = name.rpartition(".")[2]
    if last in _PROFILES:
        return {"profile": _PROFILES[last]}
    for ending, (policy, value) in _POLICIES.items():
        if last == ending or last.endswith(f"_POLICY_{ending}_{ending}") or last.endswith(f"POLICY_{ending}"):
            return {policy: value}
    return None


def make_qos(name: str, arguments: list[Any], keywords: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return the QoS that a constructor of a profile makes; None for another call."""
    last = name.rpartition(".")[2]
    if last in _PROFILES:
        return {"profile": _PROFILES[last]}
    if last not in {"QoSProfile", "QoS", "KeepLast", "KeepAll"}:
        return None
    qos: dict[str, Any] = {"history": "keep_all"} if last == "KeepAll" else {}
    for value in (*arguments, *keywords.values()):
        qos |= read_qos(value)
    return qos


def read_qos(value: Any) -> dict[str, Any]:  # noqa: ANN401 - any value
    """Return what is known of a QoS that is handed over: a depth, a profile, policies."""
    settled = settle(value)
    if isinstance(settled, int) and not isinstance(settled, bool):
        return {"depth": settled} if settled > 0 else {}
    return dict(settled) if isinstance(settled, dict) and all(isinstance(key, str) for key in settled) else {}


def change_qos(qos: Mapping[str, Any], method: str, arguments: list[Any]) -> dict[str, Any] | None:
    """Return a QoS after a call of one of its setters; None where the method is none."""
    if method in _SETTERS:
        word = method.removeprefix("durability_").upper()
        return {**qos, **dict([_POLICIES[word]])}
    if method in {"reliability", "durability", "history", "keep_last"} and arguments:
        return {**qos, **read_qos(arguments[0])}
    return None


_FACTORS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0}
_UNITS = {
    "nanoseconds": 1e-9,
    "microseconds": 1e-6,
    "milliseconds": 1e-3,
    "seconds": 1.0,
    "duration": 1.0,
    "minutes": 60.0,
}
_LITERAL = re.compile(r"([\d.]+)(ns|us|ms|s|min)\Z")


def read_seconds(value: Any) -> float | None:  # noqa: ANN401 - any value
    """Return a time that is handed over as seconds, or as `500ms`."""
    settled = settle(value)
    if isinstance(settled, str) and (match := _LITERAL.match(settled)):
        return float(match[1]) * _FACTORS[match[2]]
    return (
        float(settled) if isinstance(settled, int | float) and not isinstance(settled, bool) and settled > 0 else None
    )


def make_seconds(name: str, arguments: list[Any], keywords: Mapping[str, Any]) -> float | None:
    """Return the seconds that a constructor of a duration makes; None for another call."""
    last = name.rpartition(".")[2]
    seconds = read_seconds(arguments[0]) if arguments else read_seconds(keywords.get("seconds"))
    if seconds is None:
        return None
    if last in {"Rate", "WallRate", "Hz"}:
        return 1 / seconds
    if last == "Duration" or last in _UNITS:
        return seconds * _UNITS.get(last, 1.0)
    return None


Arithmetic = Callable[[Any, Any], Any]
OPERATIONS: Mapping[str, Arithmetic] = MappingProxyType(
    {
        "/": lambda left, right: left / right,
        "*": lambda left, right: left * right,
        "-": lambda left, right: left - right,
        "==": lambda left, right: left == right,
        "!=": lambda left, right: left != right,
        "in": lambda left, right: left in right,
        "not in": lambda left, right: left not in right,
        ">": lambda left, right: left > right,
        "<": lambda left, right: left < right,
        ">=": lambda left, right: left >= right,
        "<=": lambda left, right: left <= right,
    }
)


def spell_external(value: Any) -> str:  # noqa: ANN401 - any value
    """Return the dotted name of something of another package; empty for anything else."""
    return value.name if isinstance(value, ExternalName) else ""
