"""Changes as partners make them in a month: each as small edits, with all that a reviewer is told, and nothing else."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from tests.compare.conftest import Compared

ROBOT = """\
partners: {agri: {}, bor: {}, cnr: {}}
requirements: {R-1: Finds apples, R-5: Shows what was picked}
groups:
  seeing:
    owner: agri
    components:
      camera: {outputs: {image: Picture}}
      detector:
        title: Detector
        functionality: Finds apples in the picture.
        requirements: [R-1]
        inputs: {image: camera.image}
        outputs: {apples: Apples}
      weather: {outputs: {report: Weather}}
  arm:
    owner: cnr
    components:
      planner: {functionality: Plans how to grasp., inputs: {apples: detector.apples, weather: weather.report}, outputs: {grasp: Grasp}}
      gripper: {functionality: Closes the fingers., inputs: {grasp: planner.grasp}, outputs: {held: Held}}
  shop:
    owner: bor
    components:
      screen: {requirements: [R-5], inputs: {held: gripper.held}, outputs: {light: {medium: physical}}}
      counter: {requirements: [R-5], inputs: {held: gripper.held}, outputs: {light: {medium: physical}}}
nodes:
  net:
    implements: detector
    host: front
    subscribes: {image: {qos: sensor_data}}
    publishes: {apples: /apples}
    timing: {trigger: [image], wcet: 30 ms}
  driver: {implements: camera, host: front, publishes: {image: {topic: /image, qos: sensor_data}}, timing: {rate: 10 Hz, wcet: 1 ms}}
types: {Apples: geometry_msgs/msg/PoseArray, Picture: sensor_msgs/msg/Image, Held: std_msgs/msg/Bool}
hosts: {front: {cores: 4}, back: {cores: 2}}
chains: {pick: {through: [camera, detector], deadline: 1 s}}
"""


@dataclass(frozen=True)
class Case:
    """An edit of the robot, each pair replaced once; what is told; whom it concerns."""

    name: str
    edits: tuple[tuple[str, str], ...]
    told: tuple[str, ...]
    owners: tuple[str, ...]


NET = ROBOT[ROBOT.index("  net:") : ROBOT.index("  driver:")]
PARTS = """\
  net: {implements: detector, host: front, subscribes: {image: {qos: sensor_data}}, timing: {trigger: [image], wcet: 20 ms}}
  lift: {implements: detector, host: back, publishes: {apples: /apples}}
"""
CASES = (
    Case(
        "a component, read at once",
        (
            (
                "      weather:",
                "      trunks: {inputs: {image: camera.image}, outputs: {rows: Apples}}\n      weather:",
            ),
            ("weather: weather.report}", "weather: weather.report, rows: trunks.rows}"),
        ),
        (
            "component `seeing.trunks` is added with 1 input and 1 output; it reads `seeing.camera.image`",
            "input `arm.planner.rows` is added; it reads `seeing.trunks.rows`",
        ),
        ("agri", "bor", "cnr"),
    ),
    Case(
        "a component and its only reader removed",
        (("      weather: {outputs: {report: Weather}}\n", ""), (", weather: weather.report", "")),
        (
            "component `seeing.weather` is removed with 1 output",
            "input `arm.planner.weather` is removed",
        ),
        ("agri", "bor", "cnr"),
    ),
    Case(
        "a requirement dropped by all who served it",
        (
            ("screen: {requirements: [R-5], ", "screen: {requirements: [], "),
            ("counter: {requirements: [R-5], ", "counter: {requirements: [], "),
        ),
        (
            "`shop.counter` no longer serves `R-5`; no component serves `R-5` any more",
            "`shop.screen` no longer serves `R-5`",
        ),
        ("agri", "bor", "cnr"),
    ),
    Case(
        "a requirement removed",
        (
            (", R-5: Shows what was picked", ""),
            ("screen: {requirements: [R-5], ", "screen: {requirements: [], "),
            ("counter: {requirements: [R-5], ", "counter: {requirements: [], "),
        ),
        (("requirement `R-5` (Shows what was picked) is removed; it was served by `shop.counter` and `shop.screen`"),),
        ("bor",),
    ),
    Case(
        "a node removed with its timing",
        ((NET, ""),),
        ("node `net` is removed; no node implements `seeing.detector` any more",),
        ("agri", "cnr"),
    ),
    Case(
        "a node split in two",
        ((NET, PARTS),),
        (
            "node `lift` is added; it implements `seeing.detector` and runs on `back`",
            "node `net`: worst case execution time `30 ms` → `20 ms`",
            "node `net` no longer has `publishes.apples` on /apples: `lift` has it now",
        ),
        ("agri", "bor", "cnr"),
    ),
    Case(
        "a rename, and other words beside it",
        (
            ("      detector:\n        title: Detector\n", "      finder:\n        title: Finder\n"),
            ("detector.apples", "finder.apples"),
            ("implements: detector", "implements: finder"),
            ("[camera, detector]", "[camera, finder]"),
            ("wcet: 30 ms", "wcet: 40 ms"),
        ),
        (
            "component `seeing.detector` is called `finder` now",
            "`seeing.finder`: worst case execution time `30 ms` → `40 ms`",
        ),
        ("agri", "cnr"),
    ),
    Case(
        "into a container on the same host",
        (("    host: front\n", "    container: vision\n"), ("chains:", "containers: {vision: front}\nchains:")),
        ("container `vision` is added", "node `net` now runs in the container `vision`"),
        ("agri",),
    ),
    Case(
        "a weaker quality of service",
        (("apples: /apples", "apples: {topic: /apples, qos: {reliability: best_effort}}"),),
        ("`net.publishes.apples`: QoS reliability `reliable` → `best_effort`",),
        ("agri", "cnr"),
    ),
    Case(
        "a host with fewer cores",
        (("front: {cores: 4}", "front: {cores: 1}"),),
        ("host `front`: cores 4 → 1",),
        ("agri", "cnr"),
    ),
    Case(
        "a tighter deadline",
        (("deadline: 1 s", "deadline: 500 ms"),),
        ("chain `pick` now must end within `500 ms` instead of `1 s`",),
        ("agri",),
    ),
    Case(
        "a policy",
        (("chains:", "policies: {quiet: {title: No way, forbid: {from: shop, to: arm}}}\nchains:"),),
        ("policy `quiet` (No way) is added; nothing may lead from `shop` to `arm`",),
        ("bor", "cnr"),
    ),
    Case(
        "a syntax error",
        (("      gripper: {functionality", "      gripper: [functionality"),),
        (),
        (),
    ),
)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_change_tells_all_and_nothing_else(compared: Compared, case: Case) -> None:
    after = ROBOT
    for old, new in case.edits:
        assert old in after
        after = after.replace(old, new, 1)
    found = compared(ROBOT, after)
    assert sorted(change.text for change in found.changes) == sorted(case.told)
    assert found.concerned_owners == case.owners


def test_a_mended_file_brings_no_new_warnings(compared: Compared) -> None:
    broken = ROBOT.replace("      gripper: {functionality", "      gripper: [functionality")
    mended = ROBOT.replace("implements: camera, host: front", "implements: camera, host: nowhere")
    assert {each.rule for each in compared(broken, mended).new_findings} == {"unknown-reference"}
    assert compared(broken, ROBOT).new_findings == ()


def test_the_way_of_one_chain_does_not_break_another(compared: Compared) -> None:
    two = ROBOT.replace("deadline: 1 s}", "deadline: 1 s}, other: {through: [camera, detector], deadline: 2 s}")
    after = two.replace("[camera, detector], deadline: 2 s", "[detector], deadline: 2 s").replace(
        "  net:\n    implements: detector", "  net:\n    implements: [detector, weather]"
    )
    way = next(change for change in compared(two, after).changes if change.element_kind == "chain")
    assert not any("`pick`" in each.reason for each in way.breaks)
