"""Parse the lines that `babeltrace2` prints of a trace: time, process, thread, event, fields.

    [18:04:10.875980976] (+0.000000866) robot ros2:callback_start: { cpu_id = 3 }, { vpid = 12, vtid = 12 }, { callback = 0x5 }

The time is that of the day, or with `--clock-date` has the date before it, or with `--clock-seconds` is in seconds.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import date
from typing import Literal

from archgen.plugin import dataclass
from archgen.plugins.recordings.recording_lines import Oddities, RecordingSource

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
