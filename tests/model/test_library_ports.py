"""Ports of a library's component types: offered to several projects, none of which uses them all."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.model.library_ports import is_offered_by_library, waits_for_calls

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
