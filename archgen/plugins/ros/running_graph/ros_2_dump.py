"""Read what `ros2 node`, `ros2 topic`, `ros2 service`, `ros2 param` and `ros2 component` print."""

from __future__ import annotations

import re
from collections.abc import Iterable

from archgen.plugins.ros.running_graph.dump_lines import FULL_NAME, DumpLine
from archgen.plugins.ros.running_graph.dumped_parameters import take_node_parameters
from archgen.plugins.ros.running_graph.endpoint_blocks import EndpointReader
from archgen.plugins.ros.running_graph.graph_model import RunningGraph, RunningNode

_SECTIONS = {
    "Subscribers:": "subscribes",
    "Publishers:": "publishes",
    "Service Servers:": "serves",
    "Services:": "serves",
    "Service Clients:": "calls",
    "Action Servers:": "serves",
    "Action Clients:": "calls",
}
_USE = re.compile(r"\s+(/\S+): +([^\s,]++(?:, *[^\s,]++)*+)")
_LISTED = re.compile(r"(?: \* )?(/\S+) \[([^\]]+)\](?: \d+ (?:publishers?|subscribers?))?")
_ASKED = re.compile(r"ros2 (topic|service|action) (?:info|type)\b(?:.*\s)?(/\S+)(?:\s.*)?")
_ANSWER = re.compile(r"(?:Type: )?(\w+/(?:msg|srv|action)/\w+)")
_NODE_LISTS = re.compile(r"ros2 (?:node list|lifecycle nodes|component list)\b.*")
_OTHER_LISTS = re.compile(r"ros2 (?:topic|service|action|param) list\b.*")
_ACTION_ENDS = {"Action clients": "calls", "Action servers": "serves"}
_ACTION_END = re.compile(r" +(/\S+)(?: \[([^\]]+)\])?")
_COMPONENT = re.compile(r"\s+\d+\s+(/\S+)")
_PARAMETER_HEAD = re.compile(r"(/\S+):")
_BAG_TOPIC = re.compile(r"(?:Topic information:)?\s*Topic: (/\S+) \| Type: (\S+) \|.*")
_MESSAGE = re.compile(r"[A-Za-z]\w*/(?:msg|srv|action)/[A-Za-z]\w*\Z", re.ASCII)
_QUIET = re.compile(
    r"(?:Type|Publisher count|Subscription count|Clients count|Services count|Node name|There are \d++|WARNING"
    r"|(?:Published|Subscribed) topics:|Action: /|/\S+: \w+ \[\d+\]|\w+ \[\d+\]|\[(?:WARN|INFO)\]).*"
)


def read_ros_2_dump(lines: Iterable[DumpLine], graph: RunningGraph) -> None:
    """Take everything that the lines say."""
    reader = _Ros2DumpReader(graph)
    for line in lines:
        reader.read_line(line)
    reader.end_block()
    reader.tell_names()
    reader.endpoints.settle(graph)


class _Ros2DumpReader:
    """What the lines before say about the next one."""

    def __init__(self, graph: RunningGraph) -> None:
        self._graph = graph
        self.endpoints = EndpointReader()
        self._node: RunningNode | None = None
        self._use = ""
        self._name: DumpLine | None = None
        """A name that stands alone: of a node, if what a node has stands below it."""
        self._lone_names: list[DumpLine] = []
        self._parameter_lines: list[DumpLine] = []

    def read_line(self, line: DumpLine) -> None:
        """Take one line."""
        text = line.text
        if self._parameter_lines:
            if text.startswith(" ") or not text:
                self._parameter_lines.append(line)
                return
            self.end_block()
        if not text.strip():
            return
        if self.endpoints.read_line(line):
            return
        if text.strip() in _SECTIONS and text.startswith(" "):
            self._open_node()
            self._use = _SECTIONS[text.strip()]
        elif FULL_NAME.match(text):
            self._take_name(line)
        elif _OTHER_LISTS.fullmatch(line.command) and not _LISTED.fullmatch(text):
            # Names of topics, services or parameters alone say of whom they are nothing.
            return
        elif _PARAMETER_HEAD.fullmatch(text):
            self._parameter_lines = [line]
        else:
            self._read_detail(line)

    def _take_name(self, line: DumpLine) -> None:
        self._node, self._use, self._name = None, "", None
        if not _OTHER_LISTS.fullmatch(line.command):
            self._name = line
            self._lone_names.append(line)
        if _NODE_LISTS.fullmatch(line.command):
            self._open_node()

    def _open_node(self) -> None:
        if self._name is not None:
            self._node, self._name = self._graph.get_node(self._name.text, self._name.span), None

    def tell_names(self) -> None:
        """Note the names below which nothing stood, and that are of no node."""
        for line in self._lone_names:
            if line.text not in self._graph.nodes:
                words = f"what `{line.text}` is cannot be told: it stands alone"
                help_line = "put a line `$ ros2 node list` in front of what that prints"
                self._graph.add_note("name", words, line.span, help_line)

    def _read_answer(self, line: DumpLine) -> bool:
        """Take what `ros2 topic info`, `ros2 service type` and their like say of one name."""
        asked = _ASKED.fullmatch(line.command)
        heading = line.text.partition(":")[0]
        if asked is None:
            return False
        if asked[1] == "action" and heading in _ACTION_ENDS:
            self._use = _ACTION_ENDS[heading]
            return True
        end = _ACTION_END.fullmatch(line.text)
        if asked[1] == "action" and end and self._use:
            node = self._graph.get_node(end[1], line.span)
            # Without `-t` it says no type.
            message = self._choose_message(asked[2], end[2], line) if end[2] else ""
            self._graph.add_use(node, self._use, asked[2], message)
            return True
        answer = _ANSWER.fullmatch(line.text)
        if answer:
            self._graph.messages.setdefault(asked[2], self._choose_message(asked[2], answer[1], line))
            self._graph.taken["topic or service"] += 1
        return answer is not None

    def _read_detail(self, line: DumpLine) -> None:
        if self._read_answer(line):
            return
        use, listed = _USE.fullmatch(line.text), _LISTED.fullmatch(line.text)
        component, recorded = _COMPONENT.fullmatch(line.text), _BAG_TOPIC.fullmatch(line.text)
        if component:
            self._open_node()
        if use and self._node is not None and self._use:
            self._add_use(self._node, use[1], use[2], line)
        elif match := listed or recorded:
            self._graph.messages.setdefault(match[1], self._choose_message(match[1], match[2], line))
            self._graph.taken["topic or service" if listed else "recorded topic"] += 1
        elif component and self._node is not None and FULL_NAME.match(component[1]):
            self._graph.get_node(component[1], line.span).container = self._node.full_name
            self._node.is_container = True
        elif not _QUIET.fullmatch(line.text.strip()) and not line.text.startswith(" "):
            self._graph.add_note("line", f"it is not understood: `{line.text[:80]}`", line.span)

    def _add_use(self, node: RunningNode, name: str, messages: str, line: DumpLine) -> None:
        message = self._choose_message(name, messages, line)
        self._graph.add_use(node, self._use, name, message)
        if message:
            self._graph.messages.setdefault(name, message)

    def _choose_message(self, name: str, messages: str, line: DumpLine) -> str:
        found = [message.strip() for message in messages.split(",")]
        if len(found) > 1:
            words = f"`{name}` has several types: {messages}; the first one is taken"
            self._graph.add_note("type", words, line.span, fate="noted")
        if not _MESSAGE.match(found[0]):
            self._graph.add_note("type", f"`{found[0]}` of `{name}` is no message of ROS 2", line.span)
            return ""
        return found[0]

    def end_block(self) -> None:
        """Take parameters that end here."""
        lines, self._parameter_lines = self._parameter_lines, []
        if lines:
            take_node_parameters(self._graph, lines)
