"""Recognise what a recording is by its content, and say what to do with what cannot be read."""

from __future__ import annotations

import shlex
from itertools import islice
from pathlib import Path
from typing import Literal

from archgen.plugin.importing import RecordingRefusedError
from archgen.plugins.recordings.bag_metadata import BAG_KEY
from archgen.plugins.recordings.caret_tables import is_caret_heading
from archgen.plugins.recordings.recording_lines import RecordingSource
from archgen.plugins.recordings.topic_logs import is_topic_log_line
from archgen.plugins.recordings.trace_events import is_trace_line

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
