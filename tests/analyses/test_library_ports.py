"""Ports of a library's component types: offered to several projects, none of which uses them all."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.analyses.connectivity import is_offered_by_library, waits_for_calls

TEXT = """\
libraries:
  common:
    component_types:
      lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      manager: {inputs: {}, outputs: {start: std_srvs/srv/Trigger}}
      asked: {inputs: {pose: geometry_msgs/msg/PoseStamped}, outputs: {start: std_srvs/srv/Trigger}}
component_types:
  front: {is: common.lidar, outputs: {health: std_msgs/msg/String}}
groups:
  g:
    components:
      lidar: {is: common.lidar}
      front: {is: front}
      manager: {is: common.manager}
      asked: {is: common.asked}
      own: {inputs: {}, outputs: {start: std_srvs/srv/Trigger}}
"""


def test_what_is_offered_and_what_waits(tmp_path: Path) -> None:
    file = tmp_path / "project.yaml"
    file.write_text(TEXT, encoding="utf-8")
    architecture = pipeline.check_project(file).architecture
    offered = [each.id for each in architecture.outputs.values() if is_offered_by_library(architecture, each)]
    assert offered == ["g.lidar.scan", "g.front.scan", "g.manager.start", "g.asked.start"]
    assert [each.id for each in architecture.components.values() if waits_for_calls(architecture, each)] == [
        "g.manager"
    ]


@pytest.mark.parametrize("outputs", ["", ", outputs: {o: std_msgs/msg/String}"])
def test_types_that_are_made_from_themselves_come_to_an_end(tmp_path: Path, outputs: str) -> None:
    types = f"component_types: {{round: {{is: back{outputs}}}, back: {{is: round{outputs}}}}}\n"
    text = TEXT.partition("component_types:\n  front")[0] + types
    file = tmp_path / "project.yaml"
    file.write_text(text + "groups: {g: {components: {turned: {is: round}, lidar: {is: common.lidar}}}}\n")
    checked = pipeline.check_project(file)
    assert [each.rule for each in checked.findings if each.severity == "error"] == ["circular-types"]
    architecture = checked.architecture
    assert list(architecture.list_types_of(architecture.components["g.turned"])) == ["round", "back"]
    offered = [each.id for each in architecture.outputs.values() if is_offered_by_library(architecture, each)]
    assert offered == ["g.lidar.scan"]
