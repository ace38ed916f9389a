"""A trace of ros2_tracing as what was observed of a robot: its nodes, what they use, the depths of their queues, their computers.

Only a trace that began before the nodes did tells of them. It says no types.
"""

from __future__ import annotations

from itertools import islice
from pathlib import Path

from archgen.plugin.importing import (
    ForeignFileError,
    ObservationOptions,
    ObservedEndpoint,
    ObservedNode,
    ObservedRobot,
    Span,
    open_named_file,
)
from archgen.plugin.model import FlowKind, UseKind
from archgen.plugins.recordings.recording_lines import Oddities, RecordingError, RecordingSource
from archgen.plugins.recordings.trace_events import (
    MAX_ADDRESSES,
    Address,
    TraceEvent,
    is_trace_line,
    read_trace_events,
)

_HEAD_LINES = 200
_ENDS: dict[str, tuple[UseKind, str]] = {
    "rcl_publisher_init": ("publishes", "topic_name"),
    "rcl_subscription_init": ("subscribes", "topic_name"),
    "rcl_service_init": ("serves", "service_name"),
    "rcl_client_init": ("calls", "service_name"),
}
_ACTION_SERVICE = "/_action/send_goal"


def observe_trace(path: Path, _options: ObservationOptions) -> ObservedRobot | None:
    """Read a trace as text; None for what is none. Raise ForeignFileError for one that does not say which nodes there are."""
    if not path.is_file():
        return None
    with open_named_file(path) as stream:
        source = RecordingSource(path.name, stream)
        try:
            if not any(is_trace_line(line) for _, line in islice(source.read_lines(), _HEAD_LINES)):
                return None
            reader = _TraceObserver(path.name)
            for event in read_trace_events(source, Oddities(source)):
                if isinstance(event, TraceEvent):
                    reader.read_event(event)
        except RecordingError as error:
            found = error.diagnostic
            raise ForeignFileError(found.message, found.span, found.help or "") from None
    if not reader.nodes:
        words = "it does not say which nodes there are: it has no `ros2:rcl_node_init`"
        raise ForeignFileError(words, Span.of_file(path.name), "start tracing before the nodes start")
    return reader.make_robot(str(path))


class _TraceObserver:
    """The nodes and ends that events of initialisation tell of."""

    def __init__(self, file: str) -> None:
        self._file = file
        self.nodes: dict[Address, tuple[str, Span]] = {}
        self._ends: dict[tuple[str, UseKind, FlowKind, str], ObservedEndpoint] = {}
        self._uses: set[UseKind] = set()

    def read_event(self, event: TraceEvent) -> None:
        """Take what begins to be there."""
        span = Span(self._file, event.line, 1, event.line, 2)
        handle = (event.process, event.fields.get("node_handle", ""))
        if event.name == "rcl_node_init" and len(self.nodes) < MAX_ADDRESSES:
            full_name = f"{event.fields.get('namespace', '').rstrip('/')}/{event.fields.get('node_name', '')}"
            self.nodes[handle] = (full_name, span)
        if event.name not in _ENDS:
            return
        use, name_field = _ENDS[event.name]
        self._uses.add(use)
        name = event.fields.get(name_field, "")
        flow: FlowKind = "topic" if name_field == "topic_name" else "service"
        if flow == "service" and name.endswith(_ACTION_SERVICE):
            name, flow = name.removesuffix(_ACTION_SERVICE), "action"
        if handle in self.nodes and len(self._ends) < MAX_ADDRESSES:
            node = self.nodes[handle][0]
            depth = event.fields.get("queue_depth", "")
            qos = {"depth": int(depth[:9])} if flow == "topic" and depth.isdecimal() and depth != "0" else {}
            key: tuple[str, UseKind, FlowKind, str] = (node, use, flow, name)
            self._ends.setdefault(key, ObservedEndpoint(node, use, flow, name, qos=qos, at=span))

    def make_robot(self, origin: str) -> ObservedRobot:
        """Return all of it. A use of which nothing was traced at all was not recorded."""
        by_name: dict[str, list[tuple[Address, Span]]] = {}
        for address, (full_name, span) in self.nodes.items():
            by_name.setdefault(full_name, []).append((address, span))
        # Two processes with a node of one name may be one that was started again.
        nodes = tuple(
            ObservedNode(full_name, host=_name_host(found), at=found[0][1]) for full_name, found in by_name.items()
        )
        unseen = frozenset(use for use, _ in _ENDS.values() if use not in self._uses)
        return ObservedRobot(origin, "trace", nodes, tuple(self._ends.values()), unseen_uses=unseen)


def _name_host(found: list[tuple[Address, Span]]) -> str | None:
    first, *others = dict.fromkeys(address[0][0] for address, _ in found)
    return None if others else first or None
