"""Read what `rosnode info`, `rostopic list -v`, `rosservice info`, `rosparam dump` and `rosbag info` print."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from archgen.plugin.ros import KNOWN_DISTROS, PAST_DISTROS, full_message_name
from archgen.plugins.ros.running_graph.dump_lines import DumpLine, RunningGraph, RunningNode, read_server_values

_NODE = re.compile(r"Node \[(/\S+)\]")
_SECTIONS = {"Publications:": "publishes", "Subscriptions:": "subscribes", "Services:": "serves"}
_USE = re.compile(r" *\* (/\S+)(?: \[([^\]]+)\])?(?: \d+ (?:publishers?|subscribers?))?")
_BAG_TOPIC = re.compile(r"(?:topics:)?\s+(/\S+)\s+\d+ msgs?\b.*: ([A-Za-z]\w*/[A-Za-z]\w*)(?:\s.*)?")
_SERVICE_INFO = re.compile(r"rosservice (?:info|type) (/\S+)")
_SERVICE_TYPE = re.compile(r"(?:Type: )?([A-Za-z]\w*)/([A-Za-z]\w*)")
_PARAMETER_COMMAND = re.compile(r"rosparam dump\b.*")


def read_ros_1_dump(lines: Iterable[DumpLine], graph: RunningGraph) -> None:
    """Take everything that the lines say."""
    reader = _Ros1DumpReader(graph)
    for line in lines:
        reader.read_line(line)
    reader.take_parameters()
    _fold_actions(graph)


class _Ros1DumpReader:
    """What the lines before say about the next one."""

    def __init__(self, graph: RunningGraph) -> None:
        self._graph = graph
        self._node: RunningNode | None = None
        self._use = ""
        self._parameter_lines: list[DumpLine] = []

    def read_line(self, line: DumpLine) -> None:
        """Take one line."""
        text = line.text
        if _PARAMETER_COMMAND.fullmatch(line.command):
            self._parameter_lines.append(line)
            return
        node = _NODE.fullmatch(text.strip())
        if node:
            self._node, self._use = self._graph.get_node(node[1], line.span), ""
            return
        heading = text.strip().partition(" ")[0]
        if heading in _SECTIONS and not text.startswith(" "):
            self._use = _SECTIONS[heading]
        elif text.startswith(("Published topics:", "Subscribed topics:", "contacting node", "Pid:", "Connections:")):
            self._node, self._use = (None, "") if "topics:" in text else (self._node, "")
        else:
            self._read_detail(line)

    def _read_detail(self, line: DumpLine) -> None:
        service = _SERVICE_INFO.fullmatch(line.command)
        found = _SERVICE_TYPE.fullmatch(line.text.strip())
        message = full_message_name(f"{found[1]}/srv/{found[2]}") if found else None
        if service and message:
            self._graph.messages[service[1]] = message
            self._graph.taken["service type"] += 1
            return
        recorded = _BAG_TOPIC.fullmatch(line.text)
        if recorded:
            self._graph.messages.setdefault(recorded[1], _write_message(recorded[2]))
            self._graph.taken["recorded topic"] += 1
            return
        use = _USE.fullmatch(line.text)
        if use is None:
            return
        message = _write_message(use[2] or "")
        if self._node is not None and self._use:
            self._graph.add_use(self._node, self._use, use[1], message if self._use != "serves" else "", line.span)
        if message:
            self._graph.messages.setdefault(use[1], message)

    def take_parameters(self) -> None:
        """Give nodes what the parameter server holds below their names."""
        lines = self._parameter_lines
        while lines and not lines[0].text.strip():
            lines = lines[1:]
        if not lines:
            return
        values = read_server_values(self._graph, lines)
        distro = str(values.pop("rosdistro", "")).strip()
        # Debian builds Noetic's packages itself, and calls them its own.
        distro = "noetic" if distro == "Debian" else distro
        self._graph.distro = distro if distro in {*KNOWN_DISTROS, *PAST_DISTROS} else ""
        for own in ("rosversion", "run_id", "roslaunch"):
            values.pop(own, None)
        for node in self._graph.nodes.values():
            self._take_node_values(node, values)
        rest = _list_leaves(values, "")
        if rest:
            shown = ", ".join(f"`{name}`" for name in rest[:5])
            words = f"{len(rest)} parameters stand below no node: {shown}{', ...' if len(rest) > 5 else ''}"  # noqa: PLR2004
            self._graph.add_note("parameters", words, lines[0].span, "give them to the nodes that read them")

    def _take_node_values(self, node: RunningNode, values: dict[str, Any]) -> None:
        place: Any = values
        *outer, last = node.full_name.strip("/").split("/")
        for part in outer:
            place = place.get(part) if isinstance(place, dict) else None
        found = place.pop(last, None) if isinstance(place, dict) and isinstance(place.get(last), dict) else None
        if isinstance(found, dict):
            node.parameters = found
            self._graph.taken["parameter"] += len(_list_leaves(found, ""))


def _write_message(short: str) -> str:
    return full_message_name(short.replace("/", "/msg/", 1)) or ""


def _list_leaves(values: dict[str, Any], outer: str) -> list[str]:
    leaves: list[str] = []
    for name, value in values.items():
        leaves += _list_leaves(value, f"{outer}/{name}") if isinstance(value, dict) else [f"{outer}/{name}"]
    return leaves


def _fold_actions(graph: RunningGraph) -> None:
    """Put the five topics of an action together: ROS 1 knows no actions."""
    for node in graph.nodes.values():
        for own, other, use in (("publishes", "subscribes", "serves"), ("subscribes", "publishes", "calls")):
            for name, message in list(node.uses[own].items()):
                base = name.removesuffix("/result")
                kind = message.removesuffix("ActionResult")
                if base == name or kind == message or f"{base}/goal" not in node.uses[other]:
                    continue
                for ending in ("result", "feedback", "status"):
                    node.uses[own].pop(f"{base}/{ending}", None)
                for ending in ("goal", "cancel"):
                    node.uses[other].pop(f"{base}/{ending}", None)
                node.uses[use][base] = kind.replace("/msg/", "/action/")
                graph.taken["action"] += 1
