"""The calls by which programs speak to ROS, in rclpy, rclcpp, rospy and roscpp: what each makes, and where its name and type stand."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from archgen.plugins.ros.sources.walk_values import ExternalName, Value, settle


class EndpointCall(NamedTuple):
    """What a call makes. Positions count its arguments behind the node, from 0; without `type_at` the type stands in `<...>`, or is the callback's."""

    use: str
    flow: str
    name_at: int
    type_at: int | None = None
    qos_at: int | None = None
    callback_at: int | None = None
    has_node: bool = False
    """Whether its first argument is a node."""


def _make_endpoint_calls(*, name: int, kind: int | None, has_node: bool = False) -> dict[str, EndpointCall]:
    """Return the four calls of a library that are alike, with the places of name and type."""
    qos = name + (2 if kind is not None else 1)
    return {
        "create_publisher": EndpointCall("publishes", "topic", name, kind, name + 1, None, has_node),
        "create_subscription": EndpointCall("subscribes", "topic", name, kind, qos, name + 2, has_node),
        "create_service": EndpointCall("serves", "service", name, kind, has_node=has_node),
        "create_client": EndpointCall("calls", "service", name, kind, has_node=has_node),
    }


RCLPY_METHODS = _make_endpoint_calls(name=1, kind=0)
RCLPY_METHODS["create_lifecycle_publisher"] = RCLPY_METHODS["create_publisher"]
RCLCPP_METHODS = {
    **_make_endpoint_calls(name=0, kind=None),
    "create_generic_publisher": EndpointCall("publishes", "topic", 0, 1, 2),
    "create_generic_subscription": EndpointCall("subscribes", "topic", 0, 1, 2),
}
ROSCPP_METHODS = {
    "advertise": EndpointCall("publishes", "topic", 0),
    "subscribe": EndpointCall("subscribes", "topic", 0, callback_at=2),
    "advertiseService": EndpointCall("serves", "service", 0, callback_at=1),
    "serviceClient": EndpointCall("calls", "service", 0),
}
_SERVER, _CLIENT = (EndpointCall(use, "action", 1, 0, has_node=True) for use in ("serves", "calls"))
FUNCTIONS = {
    **{f"rclcpp.{name}": call for name, call in _make_endpoint_calls(name=0, kind=None, has_node=True).items()},
    **{f"rclpy.action.{inner}ActionServer": _SERVER for inner in ("", "server.")},
    **{f"rclpy.action.{inner}ActionClient": _CLIENT for inner in ("", "client.")},
    **{f"actionlib.{inner}ActionServer": EndpointCall("serves", "action", 0, 1) for inner in ("", "Simple")},
    **{f"actionlib.{inner}ActionClient": EndpointCall("calls", "action", 0, 1) for inner in ("", "Simple")},
    "message_filters.Subscriber": EndpointCall("subscribes", "topic", 1, 0, has_node=True),
    "rospy.Publisher": EndpointCall("publishes", "topic", 0, 1),
    "rospy.Subscriber": EndpointCall("subscribes", "topic", 0, 1),
    "rospy.wait_for_message": EndpointCall("subscribes", "topic", 0, 1),
    "rospy.Service": EndpointCall("serves", "service", 0, 1),
    "rospy.ServiceProxy": EndpointCall("calls", "service", 0, 1),
    "rclcpp_action.create_server": EndpointCall("serves", "action", 0, has_node=True),
    "rclcpp_action.create_client": EndpointCall("calls", "action", 0, has_node=True),
    "nav2_util.SimpleActionServer": EndpointCall("serves", "action", 0, has_node=True),
    "nav2_util.ServiceClient": EndpointCall("calls", "service", 0),
    "realtime_tools.RealtimePublisher": EndpointCall("publishes", "topic", 0, has_node=True),
}
IMAGE_TYPES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo")
PACKED_IMAGES = {
    "compressed": "sensor_msgs/msg/CompressedImage",
    "compressedDepth": "sensor_msgs/msg/CompressedImage",
    "theora": "theora_image_transport/msg/Packet",
}
"""The messages of transports of images, by the words that stand for them."""
_IMAGE_USES = {
    "advertise": "publishes",
    "publisher": "publishes",
    "subscribe": "subscribes",
    "subscription": "subscribes",
}


def read_image_call(method: str) -> tuple[str, bool] | None:
    """Return the use that a call of image_transport makes, and whether a camera's calibration comes beside the images."""
    use = _IMAGE_USES.get(method.removeprefix("create_").removeprefix("camera_").removesuffix("Camera"))
    return (use, "amera" in method) if use else None


_TF, _DIAGNOSTICS = "tf2_msgs/msg/TFMessage", "diagnostic_msgs/msg/DiagnosticArray"
FIXED_ENDPOINTS: Mapping[str, tuple[tuple[str, str, str], ...]] = MappingProxyType(
    {
        "TransformBroadcaster": (("publishes", "/tf", _TF),),
        "StaticTransformBroadcaster": (("publishes", "/tf_static", _TF),),
        "TransformListener": (("subscribes", "/tf", _TF), ("subscribes", "/tf_static", _TF)),
        "Updater": (("publishes", "/diagnostics", _DIAGNOSTICS),),
    }
)
"""What classes of tf2_ros, tf and diagnostic_updater make, whose names nobody gives."""
FIXED_PACKAGES = frozenset({"tf2_ros", "tf", "diagnostic_updater"})
NODE_CLASSES = frozenset(
    {"rclpy.node.Node", "rclpy.create_node", "rclcpp.Node", "rclcpp.Node.make_shared", "nodelet.Nodelet"}
    | {f"{package}.LifecycleNode" for package in ("rclpy.lifecycle", "rclcpp_lifecycle", "nav2_util", "nav2")}
    | {"rclpy.lifecycle.Node", "rclpy.lifecycle.node.Node", "rclcpp_lifecycle.LifecycleNode.make_shared"}
)
HOOKS = frozenset({"on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "onInit", "run"})
"""Methods that ROS, or a thread, calls."""
TIMERS = frozenset(
    {"create_timer", "create_wall_timer", "createTimer", "createWallTimer", "createSteadyTimer", "Timer"}
)

_POINTER = re.compile(r"(?:::)?(?:Const)?(?:Shared|Unique|Weak)?Ptr$|::Request$|<.*>|_$")
_HELD = re.compile(r"(?:std|boost)::(?:shared_ptr|unique_ptr)<(.*)>$|ros::MessageEvent<(.*)>$")


def read_message_name(text: str, flow: str) -> str:
    """Return the name of a message, service or action, from the name of its class in either language; empty for what is none."""
    held = _HELD.match(text)
    parts = (
        _POINTER.sub("", next(filter(None, held.groups()), "") if held else text)
        .replace("::", ".")
        .strip(".")
        .split(".")
    )
    if flow == "service" and parts[-1] == "Request":  # a callback's own: `std_srvs::Trigger::Request`
        parts.pop()
    if len(parts) >= 4 and parts[-3] in {"msg", "srv", "action"}:  # noqa: PLR2004 - the module of one: `std_msgs.msg._string.String`
        parts = [*parts[:-2], parts[-1]]
    if len(parts) == 2 and parts[0][:1].islower() and parts[1][:1].isupper():  # noqa: PLR2004 - roscpp's `std_msgs::String`
        parts = [parts[0], {"topic": "msg", "service": "srv", "action": "action"}[flow], parts[1]]
        parts[2] = parts[2].removesuffix("Request") if flow == "service" else parts[2]
    kinds = {"msg", "srv", "action"}
    if len(parts) != 3 or parts[1] not in kinds or parts[0] in kinds:  # noqa: PLR2004 - package, kind, name
        return ""
    package, kind, name = parts
    if flow == "action" and name.endswith("Action"):
        return f"{package}/action/{name.removesuffix('Action')}"
    return f"{package}/{kind}/{name}"


_PROFILES = {
    "SensorData": "sensor_data",
    "SystemDefaults": "system_default",
    "Services": "services",
    "Parameters": "parameters",
}
_PROFILE_NAMES = {
    **{f"{name}QoS": profile for name, profile in _PROFILES.items()},
    **{
        f"{start}qos_profile_{each}": each
        for start in ("", "rmw_")
        for each in ("sensor_data", "parameters", "system_default")
    },
    "qos_profile_services_default": "services",
}
_POLICIES = {
    "reliability": ("best_effort", "reliable"),
    "durability": ("transient_local", "volatile"),
    "history": ("keep_last", "keep_all"),
}
_POLICY_OF = {value: policy for policy, values in _POLICIES.items() for value in values}


def read_qos_name(name: str) -> dict[str, Any] | None:
    """Return the QoS that a name stands for: a profile, or one policy; None for another name."""
    last = name.rpartition(".")[2]
    if last in _PROFILE_NAMES:
        return {"profile": _PROFILE_NAMES[last]}
    word = next((value for value in _POLICY_OF if last.endswith(value.upper())), None)
    return {_POLICY_OF[word]: word} if word and ("POLICY" in last or "olicy" in name or last == word.upper()) else None


def make_qos(name: str, arguments: Sequence[Value], keywords: Mapping[str, Value]) -> dict[str, Any] | None:
    """Return the QoS that a constructor of a profile makes; None for another call."""
    last = name.rpartition(".")[2]
    if last not in {"QoSProfile", "QoS", "KeepLast", "KeepAll"}:
        return read_qos_name(name) if last in _PROFILE_NAMES else None
    qos: dict[str, Any] = {"history": "keep_all"} if last == "KeepAll" else {}
    for value in arguments:
        qos |= read_qos(value)
    for key, value in keywords.items():
        qos |= read_qos(value) or ({key: None} if key in {*_POLICIES, "depth"} else {})
    return qos


def read_qos(value: Value) -> dict[str, Any]:
    """Return what is known of a QoS that is handed over: a depth, a profile, policies; None for one that is set to what is not known."""
    settled = settle(value)
    if isinstance(settled, int) and not isinstance(settled, bool) and settled > 0:
        return {"depth": settled}
    if not isinstance(settled, dict) or not all(isinstance(key, str) for key in settled):
        return {}
    # A policy that was assigned (`qos.reliability = ReliabilityPolicy.BEST_EFFORT`) is a mapping of itself.
    given = {key: settle(each.get(key) if isinstance(each, dict) else each) for key, each in settled.items()}
    return {key: each if isinstance(each, str | int) else None for key, each in given.items()}


def change_qos(qos: Mapping[str, Any], method: str, arguments: Sequence[Value]) -> dict[str, Any] | None:
    """Return a QoS after a call of one of its setters; None where the method is none."""
    word = method.removeprefix("durability_")
    if word in _POLICY_OF and word != "keep_last":
        return {**qos, _POLICY_OF[word]: word}
    is_setter = method in _POLICIES or method == "keep_last"
    if not is_setter or not arguments:
        return None
    return {**qos, **(read_qos(arguments[0]) or {"depth" if method == "keep_last" else method: None})}


_FACTORS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0}
_UNITS = {
    "nanoseconds": 1e-9,
    "microseconds": 1e-6,
    "milliseconds": 1e-3,
    "seconds": 1.0,
    "duration": 1.0,
    "Duration": 1.0,
}
_LITERAL = re.compile(r"([\d.]+)(ns|us|ms|s|min)\Z")


def read_seconds(value: Value) -> float | None:
    """Return a time that is handed over as seconds, or as `500ms`."""
    settled = settle(value)
    if isinstance(settled, str) and (match := _LITERAL.match(settled)):
        return float(match[1]) * _FACTORS[match[2]] or None
    return (
        float(settled) if isinstance(settled, int | float) and not isinstance(settled, bool) and settled > 0 else None
    )


def make_seconds(name: str, arguments: Sequence[Value], keywords: Mapping[str, Value]) -> float | None:
    """Return the seconds that a constructor of a duration, or of a rate, makes; None for another call."""
    last = name.rpartition(".")[2]
    seconds = read_seconds(arguments[0] if arguments else keywords.get("seconds"))
    if seconds is None or last not in {"Rate", "WallRate", *_UNITS}:
        return None
    return seconds * _UNITS[last] if last in _UNITS else 1 / seconds


def spell_external(value: Value) -> str:
    """Return the dotted name of something of another package; empty for anything else."""
    return value.name if isinstance(value, ExternalName) else ""
