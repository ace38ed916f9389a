"""Read what `ros2 node`, `ros2 topic`, `ros2 service`, `ros2 param` and `ros2 component` print."""

from __future__ import annotations

import re
from collections.abc import Iterable

from archgen.importers.running_graph.dump_lines import FULL_NAME, DumpLine
from archgen.importers.running_graph.endpoint_blocks import EndpointReader
from archgen.importers.running_graph.graph_model import RunningGraph, RunningNode
from archgen.importers.running_graph.parameter_blocks import take_node_parameters

_SECTIONS = {
    "Subscribers:": "subscribes",
    "Publishers:": "publishes",
    "Service Servers:": "serves",
    "Services:": "serves",
    "Service Clients:": "calls",
    "Action Servers:": "serves",
    "Action Clients:": "calls",
}
_USE = re.compile(r"\s+(/\S+): +(\S+(?:, *\S+)*)")
_LISTED = re.compile(r"(/\S+) \[([^\]]+)\]")
_COMPONENT = re.compile(r"\s+\d+\s+(/\S+)")
_PARAMETER_HEAD = re.compile(r"(/\S+):")
_BAG_TOPIC = re.compile(r"(?:Topic information:)?\s*Topic: (/\S+) \| Type: (\S+) \|.*")
_MESSAGE = re.compile(r"[A-Za-z]\w*/(?:msg|srv|action)/[A-Za-z]\w*\Z", re.ASCII)
_QUIET = re.compile(r"(?:Type|Publisher count|Subscription count|Node name|There are \d+|WARNING|\[(?:WARN|INFO)\]).*")


def read_ros_2_dump(lines: Iterable[DumpLine], graph: RunningGraph) -> None:
    """Take everything that the lines say."""
    reader = _DumpReader(graph)
    for line in lines:
        reader.read_line(line)
    reader.end_block()
    reader.endpoints.settle(graph)


class _DumpReader:
    """What the lines before say about the next one."""

    def __init__(self, graph: RunningGraph) -> None:
        self._graph = graph
        self.endpoints = EndpointReader()
        self._node: RunningNode | None = None
        self._use = ""
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
            self._use = _SECTIONS[text.strip()]
        elif FULL_NAME.match(text):
            self._node, self._use = self._graph.get_node(text, line.span), ""
        elif _PARAMETER_HEAD.fullmatch(text):
            self._parameter_lines = [line]
        else:
            self._read_detail(line)

    def _read_detail(self, line: DumpLine) -> None:
        use, listed = _USE.fullmatch(line.text), _LISTED.fullmatch(line.text)
        component, recorded = _COMPONENT.fullmatch(line.text), _BAG_TOPIC.fullmatch(line.text)
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
