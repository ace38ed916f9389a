"""What stands beside arrows of outputs that are going away, or that do not keep what they promise."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.explorer.explorer_map import make_explorer_map
from archgen.views.graphs.component_graph import draw_component
from archgen.views.graphs.drawn_level import DrawnLevel, merge_flows, warn_of_outputs
from archgen.views.lookup import Lookup

ROBOT = """\
archgen: 1
groups:
  sensing:
    components:
      lidar:
        outputs:
          scan: {type: sensor_msgs/msg/LaserScan, deprecated: {until: 2999-03-01, use: cloud}}
          cloud: {type: sensor_msgs/msg/PointCloud2, promise: {rate: 20 Hz}}
          log: {type: std_msgs/msg/String, promise: {rate: 1 Hz}}
      filter: {inputs: {scan: lidar.scan, cloud: lidar.cloud, log: lidar.log}}
nodes:
  lidar: {implements: lidar, timing: {period: 100 ms, wcet: 5 ms, bcet: 5 ms}}
  filter: {implements: filter, timing: {period: 100 ms, wcet: 5 ms}}
"""


def draw(folder: Path) -> Lookup:
    (folder / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    checked = pipeline.check_project(folder / "robot.yaml")
    return project_views.make_scoped_lookup(checked, OutputOptions())


def test_outputs_that_are_going_away_or_break_a_promise_are_told(tmp_path: Path) -> None:
    lookup = draw(tmp_path)
    outputs = lookup.architecture.outputs
    words = {name.rpartition(".")[2]: warn_of_outputs(lookup, (each,)) for name, each in outputs.items()}
    assert words == {"scan": "deprecated", "cloud": "promise not kept", "log": ""}
    assert warn_of_outputs(lookup, outputs.values()) == "deprecated, promise not kept"


def test_pictures_and_the_explorer_have_it_beside_what_flows(tmp_path: Path) -> None:
    lookup = draw(tmp_path)
    drawn = {arrow.label for arrow in draw_component(lookup, "sensing.lidar").arrows}
    assert drawn == {
        "sensor_msgs/msg/LaserScan\n(deprecated)",
        "sensor_msgs/msg/PointCloud2\n(promise not kept)",
        "std_msgs/msg/String",
    }
    assert {arrow.label for arrow in draw_component(lookup, "sensing.filter").arrows} == drawn
    (merged,) = merge_flows(DrawnLevel(lookup).list_flows(), lambda flow: (flow.tail, flow.head), labels=True)
    assert merged.label.split("\n") == [line for label in sorted(drawn) for line in label.split("\n")]
    assert sum("(deprecated)" in sentence for sentence in merged.flows) == 1
    rows = make_explorer_map(lookup).tables["outputs"]
    assert [row[4] for row in rows] == ["deprecated", "promise not kept", ""]
