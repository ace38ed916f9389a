"""Read what `ros2 node`, `ros2 topic`, `ros2 service`, `ros2 param` and `ros2 component` print.

Read the endpoints that `ros2 topic info -v` prints, with their quality of service.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugin.ros import full_message_name
from archgen.plugins.ros.running_graph.dump_lines import (
    FULL_NAME,
    DumpLine,
    RunningGraph,
    RunningNode,
    take_node_parameters,
)

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
_STATE = re.compile(r"(?:(/\S+): )?(\w+) \[\d+\]")
_HOST = re.compile(r"archgen host (\S+)")
_OTHER_LISTS = re.compile(r"ros2 (?:topic|service|action|param) list\b.*")
_ACTION_ENDS = {"Action clients": "calls", "Action servers": "serves"}
_ACTION_END = re.compile(r" +(/\S+)(?: \[([^\]]+)\])?")
_COMPONENT = re.compile(r"\s+\d+\s+(/\S+)")
_PARAMETER_HEAD = re.compile(r"(/\S+):")
_BAG_TOPIC = re.compile(r"(?:Topic information:)?\s*Topic: (/\S+) \| Type: (\S+) \|.*")
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
        self._listed: Counter[tuple[str, int, str]] = Counter()
        """How often each node stands in one list of nodes: by the file and line of the command."""

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
        if self.endpoints.read_line(line) or self._read_place(line):
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

    def _read_place(self, line: DumpLine) -> bool:
        """Take the state of a lifecycle node, or the computer of a node; return whether the line says one of them."""
        state = _STATE.fullmatch(line.text) if line.command.startswith("ros2 lifecycle get") else None
        host = _HOST.fullmatch(line.command)
        if state is not None:
            node = self._graph.nodes.get(state[1] or line.command.split()[-1])
            if node is not None:
                node.state = state[2]
        elif host is not None:
            node = self._graph.nodes.get(line.text)
            if node is not None:
                node.host = host[1]
        return state is not None or host is not None

    def _take_name(self, line: DumpLine) -> None:
        self._node, self._use, self._name = None, "", None
        if not _OTHER_LISTS.fullmatch(line.command):
            self._name = line
            self._lone_names.append(line)
        if _NODE_LISTS.fullmatch(line.command):
            self._open_node()
            if line.command.startswith("ros2 node list") and self._node is not None:
                key = (line.span.file, line.command_line, line.text)
                self._listed[key] += 1
                self._node.count = max(self._node.count, self._listed[key])

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
            self._graph.add_use(node, self._use, asked[2], message, line.span)
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
        self._graph.add_use(node, self._use, name, message, line.span)

    def _choose_message(self, name: str, messages: str, line: DumpLine) -> str:
        found = [message.strip() for message in messages.split(",")]
        if len(found) > 1:
            words = f"`{name}` has several types: {messages}; the first one is taken"
            self._graph.add_note("type", words, line.span, fate="noted")
        if full_message_name(found[0]) != found[0]:
            self._graph.add_note("type", f"`{found[0]}` of `{name}` is no message of ROS 2", line.span)
            return ""
        return found[0]

    def end_block(self) -> None:
        """Take parameters that end here."""
        lines, self._parameter_lines = self._parameter_lines, []
        if lines:
            take_node_parameters(self._graph, lines)


_INFO = re.compile(r"ros2 topic info\b(?:.*\s)?(/\S+)(?:\s.*)?")
_NODE_NAME = re.compile(r"Node name: (\S+)")
_PAIR = re.compile(r"\s*([A-Z][A-Za-z ]*?)(?: \((?:Depth|KEEP_LAST|KEEP_ALL)\))?: (.+)")
_DEPTH = re.compile(r"(KEEP_LAST|KEEP_ALL) \((\d+)\)")
_SECONDS = re.compile(r"([0-9.]+) (s|seconds|nanoseconds|ns)")
_HISTORY_WORD = re.compile(r"History \((KEEP_LAST|KEEP_ALL)\): (\d+)")
_USES = {"PUBLISHER": "publishes", "SUBSCRIPTION": "subscribes"}
_WORDS = {
    "Reliability": ("reliability", {"RELIABLE", "BEST_EFFORT"}),
    "Durability": ("durability", {"VOLATILE", "TRANSIENT_LOCAL"}),
    "Liveliness": ("liveliness", {"AUTOMATIC", "MANUAL_BY_TOPIC"}),
}
_DURATIONS = {"Lifespan": "lifespan", "Deadline": "deadline", "Liveliness lease duration": "lease_duration"}
_ENDLESS = 9e9
"""Seconds: what is written for `never` is nearly 2^63 nanoseconds."""
_KEYS = frozenset({"Node namespace", "Topic type", "Topic type hash", "Endpoint type", "GID", "QoS profile", "History"})


@dataclass(slots=True, eq=False)
class _Endpoint:
    topic: str
    name: str
    span: Span
    namespace: str = "/"
    message: str = ""
    use: str = ""
    qos: dict[str, Any] = field(default_factory=dict)


class EndpointReader:
    """Collects endpoints. The topic stands in the command in front, else it is found by node and type."""

    def __init__(self) -> None:
        self._endpoints: list[_Endpoint] = []
        self._is_open = False

    def read_line(self, line: DumpLine) -> bool:
        """Take a line, if it belongs to an endpoint."""
        name = _NODE_NAME.fullmatch(line.text.strip())
        if name:
            info = _INFO.fullmatch(line.command)
            self._endpoints.append(_Endpoint(info[1] if info else "", name[1], line.span))
            self._is_open = True
            return True
        if line.text.strip() == "QoS profile:":
            return self._is_open
        pair = _PAIR.fullmatch(line.text)
        known = pair is not None and (pair[1] in _KEYS or pair[1] in _WORDS or pair[1] in _DURATIONS)
        if pair is None or not known or not self._is_open:
            # A blank line or another heading ends the endpoint; what does not look like a pair is not ours.
            self._is_open = self._is_open and pair is not None and known
            return False
        self._read_pair(self._endpoints[-1], pair[1], pair[2].strip(), line.text.strip())
        return True

    def _read_pair(self, endpoint: _Endpoint, key: str, value: str, text: str) -> None:
        if key == "Node namespace":
            endpoint.namespace = value
        elif key == "Topic type":
            endpoint.message = full_message_name(value) or ""
        elif key == "Endpoint type":
            endpoint.use = _USES.get(value, "")
        elif key == "History":
            depth, word = _DEPTH.fullmatch(value), _HISTORY_WORD.fullmatch(text)
            kind, count = (depth[1], depth[2]) if depth else (word[1], word[2]) if word else ("", "")
            if kind:
                endpoint.qos["history"] = kind.lower()
            if kind == "KEEP_LAST" and 0 < int(count) < 1_000_000:  # noqa: PLR2004 - no queue is longer
                endpoint.qos["depth"] = int(count)
        elif key in _WORDS:
            name, known = _WORDS[key]
            if value in known:
                endpoint.qos[name] = value.lower()
        elif key in _DURATIONS:
            self._read_duration(endpoint, _DURATIONS[key], value)

    def _read_duration(self, endpoint: _Endpoint, name: str, value: str) -> None:
        match = _SECONDS.fullmatch(value)
        try:
            seconds = float(match[1]) / (1 if match[2].startswith("s") else 1e9) if match else 0.0
        except ValueError:
            return
        if value == "Infinite" or (match and not 0 < seconds < _ENDLESS):
            endpoint.qos[name] = None  # without an end, or not given
        elif match:
            nanoseconds = round(seconds * 1e9)
            milliseconds = nanoseconds // 1_000_000
            endpoint.qos[name] = f"{nanoseconds} ns" if nanoseconds % 1_000_000 else f"{milliseconds} ms"

    def settle(self, graph: RunningGraph) -> None:
        """Give the endpoints to their nodes, once all nodes are known."""
        for endpoint in self._endpoints:
            full_name = f"{endpoint.namespace.rstrip('/')}/{endpoint.name}"
            if not endpoint.use or endpoint.name.startswith("_NODE_"):
                continue
            known = graph.nodes.get(full_name)
            topic = endpoint.topic
            if not topic and known is not None:
                fitting = [name for name, message in known.uses[endpoint.use].items() if message == endpoint.message]
                topic = fitting[0] if len(fitting) == 1 else ""
            if not topic:
                words = f"which topic of `{full_name}` it is cannot be told"
                help_line = "put a line `$ ros2 topic info -v TOPIC` in front of what the command prints"
                graph.add_note("topic info", words, endpoint.span, help_line)
                continue
            node = graph.get_node(full_name, endpoint.span)
            graph.add_use(node, endpoint.use, topic, endpoint.message, endpoint.span)
            if endpoint.qos:
                node.qos[endpoint.use, topic] = endpoint.qos
                graph.taken["QoS profile"] += 1
