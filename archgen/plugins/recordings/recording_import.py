"""Read recordings of the running robot, whatever their format, as observations of a design's elements.

Read the metadata.yaml of rosbag2: how many messages of each topic came in how much time.

The keys are the same in versions 1 to 9 of the file; later ones only added others. A topic's rate is its count by the whole
duration, so that one that began later or paused comes out slower.

Read the logs of `ros2 topic hz` and `ros2 topic delay`. Neither prints which topic it listens to, unless it waits for the
topic or listens to several: the command, as a terminal shows it, has to stand in the log. Figures are rounded to a
millisecond, as the tools print them.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import Literal

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import (
    MAX_BYTES,
    MappingNode,
    ReadRecordings,
    RecordingRefusedError,
    ScalarNode,
    SequenceNode,
    YamlNode,
    open_named_file,
    parse_yaml,
)
from archgen.plugin.model import Architecture, Quantity
from archgen.plugin.ros import is_common_callback
from archgen.plugin.timing import Analysis, ChainResult, Observation, format_rate, read_observations
from archgen.plugins.recordings.caret_tables import is_caret_heading, read_caret_table
from archgen.plugins.recordings.recorded_figures import (
    Oddities,
    OddityText,
    RecordedFigures,
    RecordingError,
    RecordingSource,
    make_duration,
)
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.trace_events import is_trace_line
from archgen.plugins.recordings.trace_reading import read_trace

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


def _read_topic_log(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
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


BAG_KEY = "rosbag2_bagfile_information"
_LATEST_METADATA_VERSION = 9
_MAX_METADATA_BYTES = 16_000_000
_MAX_COUNT_DIGITS = 20


def read_bag_metadata(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
    """Read the metadata of a bag. Raise RecordingError where the duration is missing."""
    bag = parse_bag(source, figures)
    if bag is None:
        return
    version = _read_count(bag.get("version"))
    if version is None or version > _LATEST_METADATA_VERSION:
        shown_version = "no number" if version is None else str(version)
        message = (
            f"the version of this file is {shown_version}; archgen knows those from 1 to {_LATEST_METADATA_VERSION}"
        )
        figures.diagnostics.append(Diagnostic("wrong-value", message, bag.span, Severity.WARNING))
    duration = read_bag_duration(bag)
    if not duration:
        message = "`duration: {nanoseconds: ...}` is missing or 0: without it there are no rates"
        raise source.refuse(
            bag.span.line, message, "write the file again with `ros2 bag reindex FOLDER`", "missing-key"
        )
    for name, count, node, _ in list_bag_topics(bag):
        if not names.has_topic(name):
            if count and not is_common_callback("subscription", name):
                figures.add_unmapped(f"messages of {name}", count, "the design has no topic of this name", node.span)
        elif count > 1:
            rate = Fraction(count * 10**9, duration)
            # One message more or less, before the first or behind the last, makes no difference to the design.
            observation = Observation(
                name, {"rate": Quantity(rate, format_rate(rate))}, node.span, {}, {"rate": Fraction(10**9, duration)}
            )
            figures.observations.append(observation)


def read_bag_duration(bag: MappingNode) -> int | None:
    """Return the duration of a whole bag in ns, None where it is not written."""
    duration_node = bag.get("duration")
    return _read_count(duration_node.get("nanoseconds")) if isinstance(duration_node, MappingNode) else None


def parse_bag(source: RecordingSource, figures: RecordedFigures) -> MappingNode | None:
    """Return what stands below the key of a bag, None for what is no YAML. Raise RecordingError."""
    source.stream.seek(0)
    data = source.stream.read(_MAX_METADATA_BYTES + 1)
    if len(data) > _MAX_METADATA_BYTES:
        message = f"metadata.yaml has more than {_MAX_METADATA_BYTES:,} bytes"
        raise source.refuse(1, message, "give the file that rosbag2 wrote", "too-large")
    document, diagnostics = parse_yaml(source.name, data.decode("utf-8", "replace").removeprefix("\ufeff"))
    figures.diagnostics += diagnostics
    if document is None:
        return None
    bag = document.root.get(BAG_KEY)
    if not isinstance(bag, MappingNode):
        message = f"`{BAG_KEY}` is no mapping: this is not what rosbag2 wrote"
        raise source.refuse(1, message, "write the file again with `ros2 bag reindex FOLDER`", "missing-key")
    return bag


def list_bag_topics(bag: MappingNode) -> Iterator[tuple[str, int, YamlNode, MappingNode]]:
    """Yield the name, the count of messages, where the name stands, and the whole metadata of each topic."""
    topics = bag.get("topics_with_message_count")
    for item in topics.items if isinstance(topics, SequenceNode) else ():
        if not isinstance(item, MappingNode):
            continue
        topic, count = item.get("topic_metadata"), _read_count(item.get("message_count"))
        name = topic.get("name") if isinstance(topic, MappingNode) else None
        if isinstance(topic, MappingNode) and isinstance(name, ScalarNode) and count is not None:
            yield name.text, count, name, topic


def _read_count(node: YamlNode | None) -> int | None:
    """Return a whole number that is not negative."""
    text = node.text if isinstance(node, ScalarNode) else ""
    return int(text) if text.isascii() and text.isdecimal() and len(text) <= _MAX_COUNT_DIGITS else None


_READERS = {
    "trace": read_trace,
    "caret": read_caret_table,
    "topic log": _read_topic_log,
    "bag": read_bag_metadata,
}


def read_measured(
    paths: Iterable[Path], architecture: Architecture, analysis: Analysis, chains: Mapping[str, ChainResult]
) -> ReadRecordings:
    """Read recordings as observations of a design that is analysed. Raise RecordingRefusedError and OSError."""
    return read_recordings(paths, RecordedNames(architecture, analysis.system, chains))


def read_recordings(paths: Iterable[Path], names: RecordedNames) -> ReadRecordings:
    """Read recordings. Samples of the same figure count together, in whichever of the files they are.

    Raise RecordingRefusedError for what is none, and OSError. A file that turns out to be wrong while it is read gives a
    diagnostic, and no figure.
    """
    figures = RecordedFigures()
    written_observations: list[Observation] = []
    texts: list[tuple[str, str]] = []
    for path in map(find_recording_file, paths):
        with open_named_file(path) as stream:
            source = RecordingSource(str(path), stream)
            recording_format = find_format(path, source)
            if recording_format != "figures":
                _read_recording(recording_format, source, names, figures)
                continue
            text = _read_text(path, source)
            texts.append((source.name, text))
            observations, diagnostics = read_observations(source.name, text)
            written_observations += observations
            figures.diagnostics += diagnostics
    return ReadRecordings(
        (*written_observations, *figures.list_observations()),
        figures.unmapped,
        tuple(figures.diagnostics),
        tuple(texts),
    )


def _read_recording(
    recording_format: str, source: RecordingSource, names: RecordedNames, figures: RecordedFigures
) -> None:
    try:
        _READERS[recording_format](source, names, figures)
    except RecordingError as error:
        figures.diagnostics.append(error.diagnostic)


def _read_text(path: Path, source: RecordingSource) -> str:
    source.stream.seek(0)
    data = source.stream.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise RecordingRefusedError(f"{path} is no recording that archgen knows, and has more than {MAX_BYTES:,} bytes")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise RecordingRefusedError(f"{path} is not UTF-8 text") from None


RecordingFormat = Literal["trace", "caret", "topic log", "bag", "figures"]
"""A trace as text; a table of CARET's; a log of `ros2 topic`; metadata of a bag; figures that people wrote (YAML, CSV)."""
_HEAD_LINES = 200
_CTF_MAGICS = (b"\xc1\x1f\xfc\xc1", b"\xc1\xfc\x1f\xc1", b"\x75\xd1\x1d\x57", b"\x57\x1d\xd1\x75", b"/* CTF ")
"""How the streams and the metadata of the Common Trace Format begin, in both orders of bytes."""
_BAG_MAGICS = (b"SQLite format 3\0", b"\x89MCAP0\r\n")
BAG_METADATA = "metadata.yaml"


def find_recording_file(path: Path) -> Path:
    """Return the file to read for what a user named: of a bag's folder its metadata. Raise RecordingRefusedError."""
    if not path.is_dir():
        return path
    if (path / BAG_METADATA).is_file():
        return path / BAG_METADATA
    if (path / "metadata").is_file() or any((path / name).is_dir() for name in ("ust", "kernel")):
        raise RecordingRefusedError(_explain_trace_folder(path))
    raise RecordingRefusedError(f"{path} is a folder, and neither that of a trace nor that of a bag (`{BAG_METADATA}`)")


def find_format(path: Path, source: RecordingSource) -> RecordingFormat:
    """Return the format of a file. Raise RecordingRefusedError for the binary ones."""
    source.stream.seek(0)
    head = source.stream.read(16)
    if head.startswith(_CTF_MAGICS):
        raise RecordingRefusedError(_explain_trace_folder(path.parent))
    if head.startswith(_BAG_MAGICS):
        msg = f"{path} holds the messages of a bag: give the `{BAG_METADATA}` beside it (`ros2 bag reindex` writes it)"
        raise RecordingRefusedError(msg)
    lines = [line for _, line in islice(source.read_lines(), _HEAD_LINES) if line.strip()]
    if any(map(is_trace_line, lines)):
        return "trace"
    if any(map(is_topic_log_line, lines)):
        return "topic log"
    if any(line.startswith(f"{BAG_KEY}:") for line in lines):
        return "bag"
    return "caret" if is_caret_heading(lines) else "figures"


def _explain_trace_folder(folder: Path) -> str:
    command = f"babeltrace2 {shlex.quote(str(folder))} > trace.txt 2>&1"
    return f"{folder} is a trace in binary form: print it as text with `{command}`, and give trace.txt"
