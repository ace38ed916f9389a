"""What is counted of one commit, for whom."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from archgen.history.history_counting import count_point, point_from_data
from archgen.model.project_history import FindingCounts, HistoryPoint
from archgen.pipeline import check_project

PROJECT = """\
archgen: 1
partners: {p: , q: }
groups:
  sensing:
    owner: p
    components:
      camera: {outputs: {image: }, inputs: {light: camer.x}}
  acting:
    components: {arm: {owner: q, title: Arm}, hand: }
nodes: {driver: {implements: camera}}
"""


@pytest.fixture
def point(tmp_path: Path) -> HistoryPoint:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    return count_point(check_project(tmp_path), "1a2b3c4", "2026-01-05")


def test_size_is_what_is_written(point: HistoryPoint) -> None:
    assert (point.commit, point.day) == ("1a2b3c4", "2026-01-05")
    assert (point.groups, point.nodes, point.connections, point.mapped_connections) == (2, 1, 0, 0)


def test_there_is_a_row_for_the_whole_each_group_each_partner_and_nobody(point: HistoryPoint) -> None:
    assert [(row.scope, row.id, row.components) for row in point.rows] == [
        ("project", point.project_row.id, 3),
        ("group", "sensing", 1),
        ("group", "acting", 2),
        ("partner", "p", 1),
        ("partner", "q", 1),
        ("partner", "", 1),
    ]


def test_an_error_counts_for_the_whole_for_its_group_and_for_the_owner_of_its_element(point: HistoryPoint) -> None:
    errors = {(row.scope, row.id): row.findings.error for row in point.rows if row.findings.error}
    assert errors == {("project", point.project_row.id): 1, ("group", "sensing"): 1, ("partner", "p"): 1}


def test_a_point_survives_json(point: HistoryPoint) -> None:
    assert point_from_data(json.loads(json.dumps(asdict(point)))) == point
    assert isinstance(point_from_data(asdict(point)).rows[0].findings, FindingCounts)


@pytest.mark.parametrize("data", [{}, {"rows": [{}]}, {"rows": [], "surplus": 1}])
def test_other_data_are_refused(data: dict[str, object]) -> None:
    with pytest.raises((KeyError, TypeError)):
        point_from_data(data)
