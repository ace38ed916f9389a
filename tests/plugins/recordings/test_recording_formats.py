"""What a recording is, by its content; and what is refused, with the way out."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from archgen.importers.foreign_import import RecordingRefusedError
from archgen.plugins.recordings.recorded_figures import RecordingSource
from archgen.plugins.recordings.recording_import import find_format, find_recording_file


def _find_format(data: bytes) -> str:
    return find_format(Path("session/file"), RecordingSource("file", io.BytesIO(data)))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[warning] x\n[12:00:00.1] (+?.?) pc ros2:callback_end: { }, { callback = 0x5 }\n", "trace"),
        ("$ ros2 topic hz /scan\naverage rate: 20.0\n", "topic log"),
        ("# of a run\nrosbag2_bagfile_information:\n  version: 5\n", "bag"),
        (",/n/callback_0/callback_start_timestamp,/n/callback_0/callback_end_timestamp\n", "caret"),
        ("id,rate\nscan,20 Hz\n", "figures"),
        ("measured: {scan: {rate: 20 Hz}}\n", "figures"),
        ("", "figures"),
    ],
)
def test_the_content_says_what_it_is_whatever_the_file_is_called(text: str, expected: str) -> None:
    assert _find_format(text.encode()) == expected
    assert _find_format(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode()) == expected


@pytest.mark.parametrize("data", [b"\xc1\x1f\xfc\xc1", b"\xc1\xfc\x1f\xc1", b"\x75\xd1\x1d\x57", b"/* CTF 1.8 */\n"])
def test_a_binary_trace_is_refused_with_the_command_that_prints_it(data: bytes) -> None:
    with pytest.raises(RecordingRefusedError, match=r"`babeltrace2 session > trace.txt 2>&1`"):
        _find_format(data + b"abc")


@pytest.mark.parametrize("data", [b"SQLite format 3\0", b"\x89MCAP0\r\n"])
def test_the_messages_of_a_bag_are_refused_with_the_file_to_give(data: bytes) -> None:
    with pytest.raises(RecordingRefusedError, match=r"give the `metadata.yaml` beside it"):
        _find_format(data + b"abc")


@pytest.mark.parametrize("inner", ["metadata", "ust/uid/metadata", "kernel/metadata"])
def test_the_folder_of_a_session_is_refused_with_the_command(tmp_path: Path, inner: str) -> None:
    (tmp_path / "my session" / inner).parent.mkdir(parents=True)
    (tmp_path / "my session" / inner).write_bytes(b"")
    with pytest.raises(RecordingRefusedError, match=r"`babeltrace2 '.*my session' > trace.txt 2>&1`"):
        find_recording_file(tmp_path / "my session")


def test_other_folders_are_refused_and_a_bags_metadata_is_read(tmp_path: Path) -> None:
    with pytest.raises(RecordingRefusedError, match="neither that of a trace nor that of a bag"):
        find_recording_file(tmp_path)
    (tmp_path / "metadata.yaml").write_text("x", encoding="utf-8")
    assert find_recording_file(tmp_path) == tmp_path / "metadata.yaml"
