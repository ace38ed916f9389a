"""Several recordings of several formats at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.foreign_import import RecordingRefusedError
from archgen.plugins.recordings import recording_import
from archgen.plugins.recordings.recording_import import read_recordings
from tests.plugins.recordings.recorded import list_figures, list_problems, make_names, node, read, run, timer

LOG = "ros2 topic hz /scan\naverage rate: 20.000\n\tmin: 0.048s max: 0.052s std dev: 0.00043s window: 21\n"


def test_formats_may_be_mixed(tmp_path: Path) -> None:
    trace = node("1") + timer("1", "0x1", 50) + run("1", "0x1", 0, 3)
    assert list_figures(read(tmp_path, trace, LOG, "measured: {plan: {wcet: 7 ms}}\n")) == [
        "plan: wcet 7 ms",
        "scan: bcet 3 ms, wcet 3 ms",
        "/scan: rate 20 Hz, min_period 48 ms, max_period 52 ms",
    ]


def test_a_recording_that_cannot_be_used_leaves_the_others(tmp_path: Path) -> None:
    recordings = read(tmp_path, LOG.replace("/scan", ""), LOG)
    assert list_figures(recordings) == ["/scan: rate 20 Hz, min_period 48 ms, max_period 52 ms"]
    assert list_problems(recordings) == ["2 error: the log does not say which topic it is of"]


def test_figures_in_csv_are_read_as_before(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("id,rate\nscan,20 Hz\n", encoding="utf-8")
    assert list_figures(read_recordings([tmp_path / "run.csv"], make_names(tmp_path))) == ["scan: rate 20 Hz"]


def test_what_is_no_text_or_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "x").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(RecordingRefusedError, match="is not UTF-8 text"):
        read_recordings([tmp_path / "x"], make_names(tmp_path))
    monkeypatch.setattr(recording_import, "MAX_BYTES", 2)
    with pytest.raises(RecordingRefusedError, match="no recording that archgen knows, and has more than 2 bytes"):
        read_recordings([tmp_path / "x"], make_names(tmp_path))
