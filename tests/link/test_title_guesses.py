"""Titles that stand where ids are asked."""

from __future__ import annotations

from collections.abc import Collection

import pytest

from archgen.checking import project_judging
from tests.judged_projects import check_text

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


@pytest.mark.parametrize(
    ("text", "slip", "help_line"),
    [
        # A host or a partner is asked: that a component has this name is no help.
        ("host: board", "host: screen", "there are `pc` and `board`"),
        ("owner: logtech", "owner: screen", "there are `logtech` and `lab`"),
        ("implements: ring_lidar, host: pc", "implements: ring_lidar, callback_groups: {a: [screen]}", "there is `sensing.ring_lidar`"),
    ],
)  # fmt: skip
def test_no_guess_is_of_another_kind_than_what_is_asked(text: str, slip: str, help_line: str) -> None:
    errors = [d for d in check_text(_ROBOT.replace(text, slip)) if d.severity == "error"]
    assert [(d.help, d.labels) for d in errors] == [(help_line, ())]


def test_thousands_of_unknown_names_are_compared_with_few_titles(monkeypatch: pytest.MonkeyPatch) -> None:
    compared_counts: list[int] = []

    def count_candidates(_: str, candidates: Collection[str]) -> None:
        compared_counts.append(len(candidates))

    monkeypatch.setattr(project_judging, "find_closest", count_candidates)
    components = "".join(f"      c{number}: {{inputs: {{i: nix{number}.o}}}}\n" for number in range(800))
    assert len(check_text(f"groups:\n  g:\n    components:\n{components}")) == 800
    assert 0 < sum(compared_counts) <= 300_000


def test_what_is_no_title_keeps_its_help() -> None:
    (error,) = (d for d in check_text(_ROBOT.replace("owner: logtech", "owner: No Body")) if d.severity == "error")
    assert (error.help or "").startswith("an id is")
