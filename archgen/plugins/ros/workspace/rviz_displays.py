"""What RViz shows: the displays and tools of the configuration that it is started with name its topics, as sources do of others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.sources.ros_calls import FIXED_ENDPOINTS, IMAGE_TYPES
from archgen.plugins.ros.sources.walk_values import FoundEndpoint, FoundNode
from archgen.plugins.ros.workspace.program_reading import ReadProgram

_PACKAGES = frozenset({"rviz", "rviz2"})
_FILE_OPTIONS = frozenset({"-d", "--display-config"})
_MAX_DEPTH = 20
_MESSAGES = {
    **{name: f"sensor_msgs/msg/{name}" for name in ("FluidPressure", "Illuminance", "Image", "Imu", "LaserScan")},
    **{name: f"sensor_msgs/msg/{name}" for name in ("PointCloud", "PointCloud2", "Range", "RelativeHumidity")},
    **{name: f"geometry_msgs/msg/{name}" for name in ("AccelStamped", "PointStamped", "PoseArray", "TwistStamped")},
    **{name: f"geometry_msgs/msg/{name}Stamped" for name in ("Polygon", "Pose", "PoseWithCovariance", "Wrench")},
    **{name: f"nav_msgs/msg/{name}" for name in ("GridCells", "Odometry", "Path")},
    **{name: f"visualization_msgs/msg/{name}" for name in ("Marker", "MarkerArray")},
    "Camera": IMAGE_TYPES[0],
    "Effort": "sensor_msgs/msg/JointState",
    "Map": "nav_msgs/msg/OccupancyGrid",
    "RobotModel": "std_msgs/msg/String",
    "Temperature": "sensor_msgs/msg/Temperature",
    "WrenchStamped": "geometry_msgs/msg/WrenchStamped",
}
_TOOLS = {
    "PublishPoint": "geometry_msgs/msg/PointStamped",
    "SetGoal": "geometry_msgs/msg/PoseStamped",
    "SetInitialPose": "geometry_msgs/msg/PoseWithCovarianceStamped",
}
_TOPIC_KEYS = ("Topic", "Image Topic", "Marker Topic", "Description Topic")


def read_rviz(node: LaunchedNode, run: LaunchRun) -> ReadProgram | None:
    """Return what RViz reads and sends by its configuration; None for other programs, or where that is not at hand."""
    files = [text for flag, text in pairwise(node.arguments) if flag in _FILE_OPTIONS]
    path = run.files.find_file(files[0]) if files and node.package in _PACKAGES else None
    said = None if path is None else run.parameter_reader.read_mapping(path)
    manager = said.get("Visualization Manager") if said is not None else None
    if not isinstance(manager, Mapping):
        return None
    found = [
        FoundEndpoint(use, "topic", name, message, node.span)
        for use, name, message in (*_read_displays(manager, 0), *_read_tools(manager))
    ]
    unique = {(each.use, each.name): each for each in found}
    known_node = FoundNode(node.span, node.program_name or None, None, [*unique.values()])
    return ReadProgram((known_node,), is_ros_1=node.package == "rviz")


def _list_members(holder: Mapping[str, Any], key: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield displays or tools, each with the last word of its class; what is switched off does nothing."""
    members = holder.get(key)
    for member in members if isinstance(members, list) else ():
        if isinstance(member, Mapping) and member.get("Enabled", True) is True:
            yield str(member.get("Class", "")).rpartition("/")[2], member


def _read_topic(member: Mapping[str, Any]) -> str:
    for key in _TOPIC_KEYS:
        given = member.get(key)
        name = given.get("Value") if isinstance(given, Mapping) else given
        if isinstance(name, str) and name:
            return name
    return ""


def _read_displays(holder: Mapping[str, Any], depth: int) -> Iterator[tuple[str, str, str]]:
    for kind, display in _list_members(holder, "Displays"):
        if kind == "Group" and depth < _MAX_DEPTH:
            yield from _read_displays(display, depth + 1)
        elif kind == "TF":
            yield from FIXED_ENDPOINTS["TransformListener"]
        elif (name := _read_topic(display)) and (kind != "RobotModel" or display.get("Description Source") == "Topic"):
            is_packed = name.endswith("/compressed")
            yield "subscribes", name, "sensor_msgs/msg/CompressedImage" if is_packed else _MESSAGES.get(kind, "")
            if kind == "Camera":
                folder, joint, _ = name.rpartition("/")
                yield "subscribes", f"{folder}{joint}camera_info", IMAGE_TYPES[1]
            elif kind == "Map":
                updates = _read_topic({"Topic": display.get("Update Topic")}) or f"{name}_updates"
                yield "subscribes", updates, "map_msgs/msg/OccupancyGridUpdate"


def _read_tools(manager: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    for kind, tool in _list_members(manager, "Tools"):
        if kind in _TOOLS and (name := _read_topic(tool)):
            yield "publishes", name, _TOOLS[kind]
