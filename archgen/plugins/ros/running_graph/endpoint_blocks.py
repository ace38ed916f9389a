"""Read the endpoints that `ros2 topic info -v` prints, with their quality of service."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugins.ros.running_graph.dump_lines import DumpLine
from archgen.plugins.ros.running_graph.graph_model import RunningGraph

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
    "Liveliness": ("liveliness", {"MANUAL_BY_TOPIC"}),
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
            endpoint.message = value
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
        if 0 < seconds < _ENDLESS:
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
            graph.add_use(node, endpoint.use, topic, endpoint.message)
            graph.messages.setdefault(topic, endpoint.message)
            if endpoint.qos:
                node.qos[endpoint.use, topic] = endpoint.qos
                graph.taken["QoS profile"] += 1
