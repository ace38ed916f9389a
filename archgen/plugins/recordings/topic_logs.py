"""Read the logs of `ros2 topic hz` and `ros2 topic delay`.

Neither prints which topic it listens to, unless it waits for the topic or listens to several: the command, as a terminal shows
it, has to stand in the log. Figures are rounded to a millisecond, as the tools print them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

from archgen.plugin.findings import Severity
from archgen.plugin.model import Quantity
from archgen.plugin.timing import Observation, format_rate
from archgen.plugins.recordings.recorded_figures import RecordedFigures, make_duration
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_lines import Oddities, OddityText, RecordingSource

_NUMBER = r"(-?\d{1,12}(?:\.\d{1,9})?)"
_OPTION_FIRST = re.compile(r"ros2 topic (?:hz|delay)\b(.*)")
_TOPIC_NAMES = (
    re.compile(r"WARNING: topic \[([^\]]+)\] does not appear to be published yet"),
    re.compile(r"Subscribed to \[([^\]]+)\]"),
)
_AVERAGE = re.compile(rf"average (rate|delay): {_NUMBER}\s*$")
_EXTREMES = re.compile(rf"\s*min: {_NUMBER}(\w+) max: {_NUMBER}(\w+) std dev: {_NUMBER}(\w+) window: (\d{{1,12}})\s*$")
_TABLE_HEAD = re.compile(r"\s*topic\s+rate\s+min_delta\s+max_delta\s+std_dev\s+window\s*$")
_TABLE_ROW = re.compile(rf"\s*(/\S+)\s+{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s+(\d{{1,12}})\s*$")
_RESET = "time has reset, resetting counters"
_IDLE_LINE = re.compile(r"\s*+(?:no new messages|=++|\[(?:INFO|WARN)\].*+|WARNING: .*+|Subscribed to .*+)?\s*+$")
_ROUNDING = dict.fromkeys(("min_period", "max_period", "delay"), Fraction(10**6, 2))
"""Half a millisecond: the tools round to the next one."""
_MAX_TOPICS = 10_000
_ODDITIES = {
    "reset": OddityText(
        "the clock was set back while this was recorded, {count} time{s}: the figures after it count anew"
    ),
    "backwards": OddityText(
        "{count} delay{s} below zero: the clocks of sender and receiver differ, and no delay of this log is right",
        "synchronise the computers' clocks (chrony, PTP) and record again",
    ),
    "cut off": OddityText(
        "the log is cut off: {count} average{s} without the line of extremes, here first",
        severity=Severity.NOTE,
        rule="syntax-error",
    ),
    "unreadable": OddityText(
        "{count} line{s} that `ros2 topic hz` and `delay` do not print, this one first; not counted",
        severity=Severity.NOTE,
        rule="syntax-error",
    ),
}


@dataclass(slots=True)
class _TopicFigures:
    """What the blocks of one topic say together, in ns: the last mean, the extremes of all."""

    line: int
    mean: Fraction
    least: Fraction
    largest: Fraction

    def add_block(self, mean: Fraction, least: Fraction, largest: Fraction) -> None:
        # Each block counts all messages since the start (the last 10,000 of them): the last mean is the best.
        self.mean = mean
        self.least, self.largest = min(self.least, least), max(self.largest, largest)


def is_topic_log_line(line: str) -> bool:
    """Whether a line is one that only `ros2 topic hz` or `delay` prints."""
    return bool(_AVERAGE.match(line) or _TABLE_HEAD.match(line) or _TOPIC_NAMES[0].match(line))


def read_topic_log(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
    """Read a log. Raise RecordingError where it does not say of which topic it is, or gives other units."""
    reader = _LogReader(source)
    for number, line in source.read_lines():
        reader.read_line(number, line)
    reader.finish(names, figures)


class _LogReader:
    def __init__(self, source: RecordingSource) -> None:
        self._source = source
        self._oddities = Oddities(source)
        self._topic = ""
        self._open_average: tuple[int, str, Fraction] | None = None
        self._figures: dict[tuple[str, str], _TopicFigures] = {}

    def read_line(self, number: int, line: str) -> None:
        # A terminal shows the keys that end the command in front of what is printed then.
        line = line.removeprefix("^C")
        if average := _AVERAGE.match(line):
            self._note_open_average()
            self._open_average = (number, average[1], Fraction(average[2]))
        elif extremes := _EXTREMES.match(line):
            self._read_extremes(number, extremes)
        elif (row := _TABLE_ROW.match(line)) and Fraction(row[2]):
            least, largest = (Fraction(text) * 10**9 for text in row.group(3, 4))
            self._add_block(number, row[1], "rate", (10**9 / Fraction(row[2]), least, largest))
        elif line.strip() == _RESET:
            self._oddities.note("reset", number)
        elif not self._read_topic_name(line) and not (_IDLE_LINE.match(line) or _TABLE_HEAD.match(line)):
            self._oddities.note("unreadable", number)

    def _read_topic_name(self, line: str) -> bool:
        """Take in the topic that a line names, if it does."""
        matches = [*(pattern.match(line) for pattern in _TOPIC_NAMES)]
        name = next((match[1] for match in matches if match), "") or _find_command_topic(line)
        if name:
            self._topic = name if name.startswith("/") else f"/{name}"
        return bool(name)

    def _read_extremes(self, number: int, extremes: re.Match[str]) -> None:
        if self._open_average is None:
            self._oddities.note("unreadable", number)
            return
        line, kind, mean = self._open_average
        self._open_average = None
        units = set(extremes.group(2, 4, 6))
        if units != {"s"}:
            message = f"the tool prints seconds (`s`), and here stands `{' '.join(sorted(units))}`"
            raise self._source.refuse(number, message, "give the log as `ros2 topic` printed it")
        if not self._topic:
            message = "the log does not say which topic it is of"
            help_line = "write the command as its first line, such as `ros2 topic hz /scan`"
            raise self._source.refuse(line, message, help_line, "missing-key")
        least, largest = (Fraction(text) * 10**9 for text in extremes.group(1, 3))
        if kind == "rate":
            if mean:
                self._add_block(line, self._topic, kind, (10**9 / mean, least, largest))
            return
        if least < 0 or mean < 0:
            self._oddities.note("backwards", number)
        self._add_block(line, self._topic, kind, (mean * 10**9, least, largest))

    def _add_block(self, line: int, topic: str, kind: str, block: tuple[Fraction, Fraction, Fraction]) -> None:
        figures = self._figures.get((topic, kind))
        if figures is not None:
            figures.add_block(*block)
        elif len(self._figures) < _MAX_TOPICS:
            self._figures[topic, kind] = _TopicFigures(line, *block)
        else:
            message = f"the log has more than {_MAX_TOPICS:,} topics"
            raise self._source.refuse(line, message, "record one robot at a time", "too-large")

    def _note_open_average(self) -> None:
        if self._open_average is not None:
            self._oddities.note("cut off", self._open_average[0])
            self._open_average = None

    def finish(self, names: RecordedNames, figures: RecordedFigures) -> None:
        self._note_open_average()
        figures.diagnostics += self._oddities.diagnose(_ODDITIES)
        for (topic, kind), topic_figures in self._figures.items():
            span = self._source.span_of(topic_figures.line)
            if not names.has_topic(topic):
                figures.add_unmapped(f"{kind} of {topic}", 1, "the design has no topic of this name", span)
            elif kind == "rate":
                figures.observations.append(Observation(topic, _rate_quantities(topic_figures), span, {}, _ROUNDING))
            elif topic_figures.least >= 0:
                delay = {"delay": make_duration(topic_figures.largest)}
                figures.observations.append(Observation(topic, delay, span, {}, _ROUNDING))


def _find_command_topic(line: str) -> str:
    """Return the topic of a command in a line: the first word behind the verb that is no option and no option's value."""
    match = _OPTION_FIRST.search(line)
    words = match[1].split() if match else []
    is_value = False
    for word in words:
        if is_value:
            is_value = False
        elif word.startswith("-"):
            is_value = word in {"--window", "-w", "--filter", "--spin-time"}
        elif re.fullmatch(r"/?[A-Za-z_][\w/]*", word):
            return word
        else:
            return ""
    return ""


def _rate_quantities(figures: _TopicFigures) -> dict[str, Quantity]:
    rate = 10**9 / figures.mean
    return {
        "rate": Quantity(rate, format_rate(rate)),
        "min_period": make_duration(figures.least),
        "max_period": make_duration(figures.largest),
    }
