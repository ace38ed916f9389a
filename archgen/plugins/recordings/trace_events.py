"""Parse the lines that `babeltrace2` prints of a trace: time, process, thread, event, fields.

    [18:04:10.875980976] (+0.000000866) robot ros2:callback_start: { cpu_id = 3 }, { vpid = 12, vtid = 12 }, { callback = 0x5 }

The time is that of the day, or with `--clock-date` has the date before it, or with `--clock-seconds` is in seconds.

What a trace says about who is who: nodes, publishers, and what runs each callback.

Things are known by their addresses, which mean something inside one process only and may be used again after their thing is
gone: a later event overrides an earlier one.

A trace as what was observed of a robot: only one that began before the nodes did tells of them. It says no types.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import date
from itertools import islice
from pathlib import Path
from typing import Literal, NamedTuple

from archgen.plugin import dataclass
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
from archgen.plugins.recordings.recorded_figures import Oddities, RecordingError, RecordingSource

_DAY = 86_400 * 10**9
_EVENT_PATTERN = re.compile(
    r"\[(?P<time>[-0-9:. ]+)\] (?:\(\+[0-9?.]+\) )?(?:(?P<host>[^ {}]+) )?(?P<provider>[\w-]+):(?P<event>\w+): (?P<fields>\{.*\})$"
)
_ANY_EVENT = re.compile(r"\[[-0-9:. ]+\] (?:\(\+[0-9?.]+\) )?(?:[^ {}]+ )?[\w:-]+: \{")
_ROS_EVENT = re.compile(r"(?:^| )ros2:\w+: \{")
_FIELD_PATTERN = re.compile(r'(?<!\w)(\w++) = (?:"((?:[^"\\]|\\.)*+)"|(-?\w++))')
_TIME_PATTERN = re.compile(
    r"(?:(?P<date>\d{4}-\d\d-\d\d) )?(?P<hour>\d\d):(?P<minute>[0-5]\d):(?P<second>[0-5]\d)\.(?P<fraction>\d{1,9})\Z",
    re.ASCII,
)
_SECONDS_PATTERN = re.compile(r"(?P<seconds>\d{1,12})\.(?P<fraction>\d{1,9})\Z", re.ASCII)
_LOSS_PATTERN = re.compile(
    r"Tracer (?:may have )?discarded (\d+) (?:events|packets)(?: between \[([^\]]+)\] and \[([^\]]+)\])?"
)
ClockFormat = Literal["time of day", "date and time", "seconds"]


@dataclass(frozen=True, slots=True)
class TraceEvent:
    """One event of the provider `ros2`. `time` is in ns, and never less than that of the event before unless a clock was set.

    `process` is the host and the process, `thread` its thread; both are empty where the trace has no such context.
    """

    line: int
    time: int
    name: str
    process: tuple[str, str]
    thread: str
    fields: dict[str, str]


@dataclass(frozen=True, slots=True)
class TraceLoss:
    """The tracer had to discard events between two times (ns); None where the line does not say when."""

    line: int
    count: int
    start: int | None
    end: int | None


def is_trace_line(line: str) -> bool:
    """Whether a line is an event as babeltrace prints it."""
    return _ANY_EVENT.match(line) is not None or _ROS_EVENT.search(line) is not None


def read_trace_events(source: RecordingSource, oddities: Oddities) -> Iterator[TraceEvent | TraceLoss]:
    """Yield the events of ros2_tracing in a trace, and what the tracer lost. Raise RecordingError.

    What is no event is noted: a line that is cut off, times in two formats.
    """
    clock = _TraceClock(source)
    has_events = False
    for line_number, line in source.read_lines():
        if "ros2:" not in line:
            if "discarded" in line and (loss := _LOSS_PATTERN.search(line)):
                start, end = (clock.find_time(line_number, text) if text else None for text in loss.group(2, 3))
                yield TraceLoss(line_number, int(loss[1][:18]), start, end)
            continue
        match = _EVENT_PATTERN.match(line)
        if match is None:
            # A kernel event or a log line may have the word in a text.
            if _ROS_EVENT.search(line):
                oddities.note("unreadable", line_number)
            continue
        time_text, host, provider, name, field_text = match.groups()
        if provider != "ros2":
            continue
        fields = {key: quoted or plain for key, quoted, plain in _FIELD_PATTERN.findall(field_text)}
        time = clock.advance(line_number, time_text)
        has_events = True
        yield TraceEvent(line_number, time, name, (host or "", fields.get("vpid", "")), fields.get("vtid", ""), fields)
    if not has_events:
        message = "the trace has no event of ros2_tracing with a time that can be read"
        help_line = "record with `ros2 trace`, and print what it recorded with `babeltrace2 FOLDER`"
        raise source.refuse(1, message, help_line, "missing-key")


class _TraceClock:
    """Turns the times of a trace into ns. All of them have one format; midnight begins the next day."""

    def __init__(self, source: RecordingSource) -> None:
        self._source = source
        self._format: ClockFormat | None = None
        self._days = 0
        self._latest = 0

    def advance(self, line: int, text: str) -> int:
        """Return the time of the next event."""
        time = self.find_time(line, text)
        # Without a date the clock begins again each day. Nothing else sets it back by more than half a day.
        if self._format == "time of day" and self._latest - time > _DAY // 2:
            self._days += 1
            time += _DAY
        self._latest = time
        return time

    def find_time(self, line: int, text: str) -> int:
        """Return a time in ns. Raise RecordingError where it has another format than those before."""
        clock_format, time = _parse_time(text.strip())
        if clock_format is None:
            message = "this time is neither a time of day nor in seconds"
            raise self._source.refuse(
                line, message, "print the trace with `babeltrace2 FOLDER`, without --clock-cycles"
            )
        if self._format not in {None, clock_format}:
            message = f"the times of this trace were given as {self._format}, and from here on as {clock_format}"
            raise self._source.refuse(line, message, "give recordings of two clocks as two files")
        self._format = clock_format
        return time + self._days * _DAY


def _parse_time(text: str) -> tuple[ClockFormat | None, int]:
    if match := _TIME_PATTERN.match(text):
        seconds = 3600 * int(match["hour"]) + 60 * int(match["minute"]) + int(match["second"])
        time = seconds * 10**9 + int(match["fraction"].ljust(9, "0"))
        if not match["date"]:
            return "time of day", time
        try:
            return "date and time", time + date.fromisoformat(match["date"]).toordinal() * _DAY
        except ValueError:
            return None, 0
    if match := _SECONDS_PATTERN.match(text):
        return "seconds", int(match["seconds"]) * 10**9 + int(match["fraction"].ljust(9, "0"))
    return None, 0


Process = tuple[str, str]
"""A host and a process."""
Address = tuple[Process, str]
CallbackKind = Literal["subscription", "service", "timer"]
MAX_ADDRESSES = 500_000
"""A trace of more things than this is not that of a robot; it bounds memory."""
_INITIALISATIONS = {
    "rcl_node_init": ("node", "node_handle", ("namespace", "node_name")),
    "rcl_publisher_init": ("publisher", "publisher_handle", ("node_handle", "topic_name")),
    "rcl_subscription_init": ("subscription", "subscription_handle", ("node_handle", "topic_name")),
    "rclcpp_subscription_init": ("subscription object", "subscription", ("subscription_handle",)),
    "rclcpp_subscription_callback_added": ("subscription callback", "callback", ("subscription",)),
    "rcl_service_init": ("service", "service_handle", ("node_handle", "service_name")),
    "rclcpp_service_callback_added": ("service callback", "callback", ("service_handle",)),
    "rcl_timer_init": ("timer", "timer_handle", ("period",)),
    "rclcpp_timer_link_node": ("timer node", "timer_handle", ("node_handle",)),
    "rclcpp_timer_callback_added": ("timer callback", "callback", ("timer_handle",)),
}
"""By event: the table that it fills, the field with the address that is the key, and the fields to keep."""
_CALLBACK_TABLES = tuple(table for table, _, _ in _INITIALISATIONS.values() if table.endswith("callback"))


class CallbackOwner(NamedTuple):
    """What runs a callback: a subscription (`name` is its topic), a service, or a timer (`name` is its period in ns)."""

    kind: CallbackKind
    node: str
    name: str


class TraceRegistry:
    """The things that the events of initialisation tell of."""

    def __init__(self) -> None:
        self._rows: dict[tuple[str, Process, str], tuple[str, ...]] = {}
        self._names_by_process: dict[Process, set[str]] = {}
        self.node_lines: dict[str, dict[tuple[str, ...], int]] = {}
        """The processes in which each node runs, by its full name, and the lines that say so."""

    def read_event(self, event: TraceEvent) -> bool:
        """Whether an event tells of a thing; it is kept then."""
        entry = _INITIALISATIONS.get(event.name)
        if entry is None:
            return False
        table, key, value_keys = entry
        address = event.fields.get(key, "")
        self._rows[table, event.process, address] = tuple(event.fields.get(value_key, "") for value_key in value_keys)
        if table == "node":
            name = self._name_node(event.process, address)
            # Without a process in the trace, two nodes of one name are told apart by their addresses.
            process = event.process if event.process[1] else (*event.process, address)
            self.node_lines.setdefault(name, {}).setdefault(process, event.line)
            self._names_by_process.setdefault(event.process, set()).add(name)
        elif table.endswith("callback"):
            self._forget_callback(table, event.process, address)
        return True

    def is_too_large(self) -> bool:
        """Whether there are more things than any robot has."""
        return len(self._rows) + len(self.node_lines) > MAX_ADDRESSES

    def find_topic(self, process: Process, publisher: str) -> str | None:
        """Return a publisher's topic."""
        row = self._rows.get(("publisher", process, publisher))
        return row[1] if row else None

    def find_owner(self, process: Process, callback: str) -> CallbackOwner | None:
        """Return what runs a callback, None where the trace does not say."""
        if row := self._rows.get(("subscription callback", process, callback)):
            handle = self._rows.get(("subscription object", process, row[0]))
            named = self._find_named("subscription", process, handle[0]) if handle else None
            return CallbackOwner("subscription", *named) if named else None
        if row := self._rows.get(("service callback", process, callback)):
            named = self._find_named("service", process, row[0])
            return CallbackOwner("service", *named) if named else None
        row = self._rows.get(("timer callback", process, callback))
        return self._find_timer(process, row[0]) if row else None

    def _find_timer(self, process: Process, handle: str) -> CallbackOwner | None:
        period = self._rows.get(("timer", process, handle))
        node = self._rows.get(("timer node", process, handle))
        # Before ROS 2 Humble no event said whose a timer is.
        name = self._name_node(process, node[0]) if node else self._find_only_node(process)
        return CallbackOwner("timer", name, period[0]) if name and period and period[0].isdecimal() else None

    def _find_only_node(self, process: Process) -> str:
        names = self._names_by_process.get(process, set()) if process[1] else set()
        return min(names) if len(names) == 1 else ""

    def _find_named(self, table: str, process: Process, handle: str) -> tuple[str, str] | None:
        """Return the full name of the node that something belongs to, and its own name."""
        row = self._rows.get((table, process, handle))
        node = self._name_node(process, row[0]) if row else ""
        return (node, row[1]) if row and node else None

    def _name_node(self, process: Process, handle: str) -> str:
        row = self._rows.get(("node", process, handle))
        return f"{row[0].rstrip('/')}/{row[1]}" if row else ""

    def _forget_callback(self, table: str, process: Process, callback: str) -> None:
        """Forget what had a callback's address before."""
        for other_table in _CALLBACK_TABLES:
            if other_table != table:
                self._rows.pop((other_table, process, callback), None)


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
