"""Read recordings of the running robot, whatever their format, as observations of a design's elements.

Read the metadata.yaml of rosbag2: how many messages of each topic came in how much time.

The keys are the same in versions 1 to 9 of the file; later ones only added others. A topic's rate is its count by the whole
duration, so that one that began later or paused comes out slower.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
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
from archgen.plugins.recordings.recorded_figures import RecordedFigures
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_lines import RecordingError, RecordingSource
from archgen.plugins.recordings.topic_logs import is_topic_log_line, read_topic_log
from archgen.plugins.recordings.trace_events import is_trace_line
from archgen.plugins.recordings.trace_reading import read_trace

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
    "topic log": read_topic_log,
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
