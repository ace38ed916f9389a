"""Read recordings of the running robot, whatever their format, as observations of a design's elements."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from archgen.plugin.importing import MAX_BYTES, ReadRecordings, RecordingRefusedError, open_named_file
from archgen.plugin.model import Architecture
from archgen.plugin.timing import Analysis, ChainResult, Observation, read_observations
from archgen.plugins.recordings.bag_metadata import read_bag_metadata
from archgen.plugins.recordings.caret_tables import read_caret_table
from archgen.plugins.recordings.recorded_figures import RecordedFigures
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_formats import find_format, find_recording_file
from archgen.plugins.recordings.recording_lines import RecordingError, RecordingSource
from archgen.plugins.recordings.topic_logs import read_topic_log
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
