"""Read recordings of the running robot, whatever their format, as observations of a design's elements."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from itertools import islice
from pathlib import Path
from typing import Literal

from archgen.plugin.importing import MAX_BYTES, ReadRecordings, RecordingRefusedError, open_named_file
from archgen.plugin.model import Architecture
from archgen.plugin.timing import Analysis, ChainResult, Observation, read_observations
from archgen.plugins.recordings.bag_metadata import BAG_KEY, read_bag_metadata
from archgen.plugins.recordings.caret_tables import is_caret_heading, read_caret_table
from archgen.plugins.recordings.recorded_figures import RecordedFigures
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_lines import RecordingError, RecordingSource
from archgen.plugins.recordings.topic_logs import is_topic_log_line, read_topic_log
from archgen.plugins.recordings.trace_events import is_trace_line
from archgen.plugins.recordings.trace_reading import read_trace

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
        msg = f"{path} is no recording that archgen knows, and has more than {MAX_BYTES:,} bytes"
        raise RecordingRefusedError(msg)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        msg = f"{path} is not UTF-8 text"
        raise RecordingRefusedError(msg) from None


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
    msg = f"{path} is a folder, and neither that of a trace nor that of a bag (`{BAG_METADATA}`)"
    raise RecordingRefusedError(msg)


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
