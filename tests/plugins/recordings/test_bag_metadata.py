"""metadata.yaml of rosbag2: rates of topics, in all versions of the file."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from archgen.plugins.recordings import recording_import
from archgen.plugins.recordings.recording_import import read_recordings
from tests.plugins.recordings.recorded import list_figures, list_problems, list_unmapped, make_names, read

BAG = """\
rosbag2_bagfile_information:
  version: VERSION
  storage_identifier: sqlite3
  relative_file_paths: [bag_0.db3]
  duration: {nanoseconds: 10000000000}
  starting_time: {nanoseconds_since_epoch: 1664288798730941555}
  message_count: 207
  topics_with_message_count:
    - topic_metadata: {name: /scan, type: a_msgs/msg/T, serialization_format: cdr, offered_qos_profiles: QOS}
      message_count: 200
    - topic_metadata: {name: /odd, type: a_msgs/msg/T, serialization_format: cdr}
      message_count: 6
    - topic_metadata: {name: /map, type: a_msgs/msg/T, serialization_format: cdr}
      message_count: 1
    - topic_metadata: {name: /rosout, type: rcl_interfaces/msg/Log, serialization_format: cdr}
      message_count: 3
"""


def _bag(version: object = 9, qos: str = '""') -> str:
    return BAG.replace("VERSION", str(version)).replace("QOS", qos)


@pytest.mark.parametrize("version", range(1, 10))
def test_a_topics_rate_is_its_count_by_the_duration(tmp_path: Path, version: int) -> None:
    recordings = read(tmp_path, _bag(version, "[{depth: 5}]" if version > 8 else '""'))
    # One message is no rate, and what every node publishes belongs to no design.
    assert list_figures(recordings) == ["/scan: rate 20 Hz"]
    assert list_unmapped(recordings) == ["messages of /odd (6): the design has no topic of this name"]
    assert list_problems(recordings) == []


def test_a_rate_may_be_off_by_one_message(tmp_path: Path) -> None:
    assert [o.inaccuracies["rate"] for o in read(tmp_path, _bag()).observations] == [Fraction(1, 10)]


def test_a_bag_is_read_by_its_folder(tmp_path: Path) -> None:
    (tmp_path / "recording0").mkdir()
    (tmp_path / "recording0" / "metadata.yaml").write_text(_bag(), encoding="utf-8")
    assert list_figures(read_recordings([tmp_path / "recording0"], make_names(tmp_path))) == ["/scan: rate 20 Hz"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (_bag(12), "2 warning: the version of this file is 12; archgen knows those from 1 to 9"),
        (_bag("new"), "2 warning: the version of this file is no number; archgen knows those from 1 to 9"),
        (
            _bag().replace("10000000000", "0"),
            "2 error: `duration: {nanoseconds: ...}` is missing or 0: without it there are no rates",
        ),
        (
            _bag().replace("10000000000", "-5"),
            "2 error: `duration: {nanoseconds: ...}` is missing or 0: without it there are no rates",
        ),
    ],
)
def test_what_is_wrong_with_a_bag_is_said(tmp_path: Path, text: str, problem: str) -> None:
    assert list_problems(read(tmp_path, text)) == [problem]


@pytest.mark.parametrize("text", [_bag() + "  x: [\n", "rosbag2_bagfile_information: 5\n", _bag()[:250] + "\n"])
def test_a_broken_file_gives_nothing(tmp_path: Path, text: str) -> None:
    recordings = read(tmp_path, text)
    assert list_figures(recordings) == []
    assert list_problems(recordings)


def test_a_file_that_is_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recording_import, "_MAX_METADATA_BYTES", 100)
    assert list_problems(read(tmp_path, _bag())) == ["1 error: metadata.yaml has more than 100 bytes"]
