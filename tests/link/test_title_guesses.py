"""Titles that stand where ids are asked."""

from __future__ import annotations

import pytest

from archgen.link.title_guesses import add_title_guesses
from archgen.pipeline import check_text

_ROBOT = """\
partners: {logtech: LogTech GmbH, lab: Laboratory}
hosts: {pc: Main Computer, board: {title: Motor Board}}
groups:
  sensing:
    owner: logtech
    components:
      ring_lidar: {title: 360° Lidar, outputs: {scan: sensor_msgs/msg/LaserScan}}
      screen: {inputs: {scan: ring_lidar.scan}}
nodes:
  lidar: {implements: ring_lidar, host: pc}
  screen: {implements: screen, host: board}
"""


@pytest.mark.parametrize(
    ("text", "slip", "guess", "line"),
    [
        ("scan: ring_lidar.scan", "scan: 360° Lidar", "sensing.ring_lidar", 7),
        ("scan: ring_lidar.scan", 'scan: ["360° lidar"]', "sensing.ring_lidar", 7),
        ("implements: ring_lidar", "implements: 360° Lidar", "sensing.ring_lidar", 7),
        ("owner: logtech", "owner: LogTech GmbH", "logtech", 1),
        ("owner: logtech", "owner: [lab, LogTech Gmbh]", "logtech", 1),
        ("owner: logtech", "owner: LogTech", "logtech", 1),
        ("host: board", "host: Motor Board", "board", 2),
    ],
)
def test_a_title_means_its_element(text: str, slip: str, guess: str, line: int) -> None:
    errors = [d for d in check_text(_ROBOT.replace(text, slip)) if d.severity == "error"]
    assert [(d.help, d.labels[0].span.line) for d in errors] == [(f"did you mean `{guess}`?", line)]


def test_what_is_no_title_keeps_its_help() -> None:
    (error,) = (d for d in check_text(_ROBOT.replace("owner: logtech", "owner: No Body")) if d.severity == "error")
    assert (error.help or "").startswith("an id is")
    assert callable(add_title_guesses)
