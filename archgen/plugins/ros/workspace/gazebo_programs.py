"""What programs of Gazebo say to ROS: their arguments and files name the topics, as sources do of others."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from archgen.plugin.importing import (
    ForeignFileError,
    MappingNode,
    ScalarNode,
    SequenceNode,
    Span,
    parse_yaml,
    read_bounded,
)
from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.sources.ros_calls import read_message_name
from archgen.plugins.ros.sources.walk_values import FoundEndpoint, FoundNode
from archgen.plugins.ros.workspace.program_reading import ReadProgram

_MAX_BYTES = 1_000_000
_TOPIC = re.compile(r"([^@\s]++)@([\w/]++)([@\[\]])[\w.]++\Z")
_SERVICE = re.compile(r"([^@\s]++)@(\w++/srv/\w++)(?:@|\Z)")
_DIRECTIONS = {"[": "GZ_TO_ROS", "]": "ROS_TO_GZ", "@": "BIDIRECTIONAL"}
_USES = {"GZ_TO_ROS": ("publishes",), "ROS_TO_GZ": ("subscribes",), "BIDIRECTIONAL": ("publishes", "subscribes")}
_IMAGE = "sensor_msgs/msg/Image"
_TEXT = "std_msgs/msg/String"
_LATCHED = {"depth": 1, "durability": "transient_local"}


def read_gazebo_program(node: LaunchedNode, library_type: str, run: LaunchRun) -> ReadProgram | None:
    """Return what a bridge or the spawner of Gazebo says to ROS; None for other programs, or where nothing names a topic."""
    found: list[FoundEndpoint] = []
    # ROS takes out what is meant for itself.
    arguments = (
        node.arguments[: node.arguments.index("--ros-args")] if "--ros-args" in node.arguments else node.arguments
    )
    if library_type == "gz_bridge":
        found = [each for word in arguments for each in _read_bridge(word, node.span)]
        file = node.parameters.get("config_file")
        path = run.files.find_file(file) if isinstance(file, str) else None
        found += [] if path is None else _read_bridge_file(path, run.files.show_path(path))
    elif library_type == "gz_image_bridge":
        found = [FoundEndpoint("publishes", "topic", word, _IMAGE, node.span) for word in arguments]
    elif library_type == "gz_spawner":
        given = node.parameters.get("topic")
        flags = [text for flag, text in pairwise(arguments) if flag in {"-topic", "--topic"}]
        names = [given] if isinstance(given, str) and given else flags[:1]
        found = [FoundEndpoint("subscribes", "topic", name, _TEXT, node.span, dict(_LATCHED)) for name in names]
    if not found:
        return None
    return ReadProgram((FoundNode(node.span, node.program_name or None, None, found),), is_ros_1=False)


def _read_bridge(word: str, span: Span) -> Iterator[FoundEndpoint]:
    """Yield what one argument of the bridge stands for: `/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan`."""
    if service := _SERVICE.match(word):
        yield FoundEndpoint("serves", "service", service[1], service[2], span)
    elif topic := _TOPIC.match(word):
        message = read_message_name(topic[2].replace("/", "."), "topic")
        for use in _USES[_DIRECTIONS[topic[3]]]:
            yield FoundEndpoint(use, "topic", topic[1], message, span)


def _read_bridge_file(path: Path, shown: str) -> Iterator[FoundEndpoint]:
    """Yield what a file of the bridge lists; a file that cannot be read lists nothing."""
    try:
        text = read_bounded(path, _MAX_BYTES).decode("utf-8", "replace").removeprefix("\ufeff")
    except ForeignFileError:
        return
    # The file is a list; what archgen parses has keys.
    document, _ = parse_yaml(shown, "list:\n" + re.sub(r"^---[ \t]*+$", "", text, count=1, flags=re.MULTILINE))
    listed = document.root.entries.get("list") if document is not None else None
    for item in listed.value.items if listed is not None and isinstance(listed.value, SequenceNode) else ():
        if isinstance(item, MappingNode):
            said = {entry.key: entry.value.text for entry in item if isinstance(entry.value, ScalarNode)}
            span = Span(shown, item.span.line - 1, item.span.column, item.span.end_line - 1, item.span.end_column)
            yield from _read_entry(said, span)


def _read_entry(said: dict[str, str], span: Span) -> Iterator[FoundEndpoint]:
    message = said.get("ros_type_name", "")
    if said.get("service_name"):
        yield FoundEndpoint("serves", "service", said["service_name"], message, span)
        return
    name = said.get("ros_topic_name") or said.get("topic_name") or said.get("gz_topic_name")
    for use in _USES.get(said.get("direction", "BIDIRECTIONAL"), ()) if name else ():
        yield FoundEndpoint(use, "topic", name, message, span)
