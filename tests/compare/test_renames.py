"""Elements that have another id or another group, and those that only look so."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, Told

ROBOT = """\
groups:
  sensing:
    components:
      camera:
        functionality: Sees what stands in front of the robot in colour.
        outputs: {image: Colour image, info: Calibration}
      lidar: {title: Lidar, functionality: Measures distances all around., outputs: {scan: Laser scan}}
  thinking:
    components:
      detector: {title: Detector, functionality: Finds cups., inputs: {image: camera.image}, outputs: {cups: Cup}}
types: {Colour image: sensor_msgs/msg/Image, Cup: {message: geometry_msgs/msg/Point}}
hosts: {pc: {cores: 4}, arm: {cores: 2}}
nodes:
  camera_driver: {implements: camera, host: pc, package: usb_cam, publishes: {image: /image}}
  detector: {implements: detector, host: arm}
chains: {see: {through: [camera, detector.cups], deadline: 1 s}}
views: {v: {show: "camera+ thinking.detector"}}
"""


def summary(compared: Compared, before: str, after: str) -> list[tuple[str, str, str, str | None]]:
    return [(c.kind, c.element_kind, c.element_id, c.old_id) for c in compared(before, after).changes]


RENAMES: tuple[tuple[dict[str, str], tuple[str, str], str, str], ...] = (
    ({"camera": "front_camera"}, ("renamed", "component"), "sensing.front_camera", "sensing.camera"),
    ({"sensing": "perception"}, ("renamed", "group"), "perception", "sensing"),
    (
        {"cups: Cup": "mugs: Cup", "detector.cups": "detector.mugs"},
        ("renamed", "output"),
        "thinking.detector.mugs",
        "thinking.detector.cups",
    ),
    ({"pc": "base_pc"}, ("renamed", "host"), "base_pc", "pc"),
    ({"camera_driver": "usb_camera"}, ("renamed", "node"), "usb_camera", "camera_driver"),
    ({"see": "watch"}, ("renamed", "chain"), "watch", "see"),
    ({"Cup:": "Mug:", "cups: Cup": "cups: Mug"}, ("renamed", "type"), "Mug", "Cup"),
)


def test_an_output_and_an_input_stay_in_their_component(compared: Compared) -> None:
    moved = ROBOT.replace("{image: Colour image, info", "{info").replace(
        "{scan: Laser scan}", "{scan: Laser scan, picture: Colour image}"
    )
    moved = (
        moved.replace("camera.image}", "lidar.picture}")
        .replace("publishes: {image: /image}", "package: p")
        .replace("    package: usb_cam,", "")
    )
    assert [head[:3] for head in summary(compared, ROBOT, moved) if head[1] == "output"] == [
        ("removed", "output", "sensing.camera.image"),
        ("added", "output", "sensing.lidar.picture"),
    ]
    turned = ROBOT.replace("{scan: Laser scan}", "{scan: Laser scan}, inputs: {picture: camera.image}").replace(
        "inputs: {image: camera.image}, outputs: {cups", "outputs: {cups"
    )
    assert [head[:3] for head in summary(compared, ROBOT, turned) if head[1] == "input"] == [
        ("added", "input", "sensing.lidar.picture"),
        ("removed", "input", "thinking.detector.image"),
    ]


SEEING = """\
groups:
  g:
    components:
      cam: {functionality: Sees what is there, outputs: {x: T}}
      eye: {inputs: {x: cam.x}}
"""


@pytest.mark.parametrize(
    ("nodes", "follows"),
    [
        ("nodes: {n: {implements: cam}}", "; `/g/cam/x` becomes `/g/lens/x`"),
        ("nodes: {n: {implements: cam, publishes: {x: {topic: /x}}}}", ""),
        ("nodes: {n: {implements: eye}}", ""),
        ("", ""),
    ],
)
def test_a_topic_follows_a_rename_if_a_written_node_does_not_name_it(told: Told, nodes: str, follows: str) -> None:
    text = SEEING + nodes
    (line,) = told(text, text.replace("cam", "lens"))
    assert line == f"renamed component g.lens: component `g.cam` is called `lens` now{follows}"


@pytest.mark.parametrize("case", RENAMES, ids=lambda case: case[2])
def test_renames(compared: Compared, case: tuple[dict[str, str], tuple[str, str], str, str]) -> None:
    changes, what, element, was = case
    after = ROBOT
    for old, new in changes.items():
        after = _replaced(after, old, new)
    assert summary(compared, ROBOT, after) == [(*what, element, was)]
    assert summary(compared, after, ROBOT) == [(*what, was, element)]
    (change,) = compared(ROBOT, after).changes
    (back,) = compared(after, ROBOT).changes
    assert 0.6 <= change.confidence == back.confidence < 1


def _replaced(text: str, old: str, new: str) -> str:
    import re

    return re.sub(rf"(?<![\w/]){re.escape(old)}(?!\w)", new, text)


def test_a_move_to_another_group(compared: Compared) -> None:
    lidar = "      lidar: {title: Lidar, functionality: Measures distances all around., outputs: {scan: Laser scan}}\n"
    after = ROBOT.replace(lidar, "").replace("types:", f"{lidar}types:")
    (change,) = compared(ROBOT, after).changes
    assert (change.kind, change.element_id, change.old_id) == ("moved", "thinking.lidar", "sensing.lidar")
    assert change.text.startswith("component `sensing.lidar` moved to the group `thinking`")


def test_a_rename_and_what_changed_besides(told: Told) -> None:
    after = _replaced(ROBOT, "camera", "eye").replace("in colour", "in colour, and" + " far" * 20)
    assert told(ROBOT, after) == [
        (
            "renamed component sensing.eye: component `sensing.camera` is called `eye` now (recognised with 74 % confidence); "
            "`/sensing/camera/info` becomes `/sensing/eye/info`"
        ),
        (
            "changed component sensing.eye: the functionality of `sensing.eye` is rewritten: "
            f"`… of the robot in colour.` → `… of the robot in colour, and{' far' * 18} …`"
        ),
    ]


def test_another_component_with_the_same_ports_is_no_rename(compared: Compared) -> None:
    after = ROBOT.replace("camera:\n", "thermal_imager:\n").replace(
        "Sees what stands in front of the robot in colour", "Feels heat"
    )
    after = after.replace("camera.image", "thermal_imager.image").replace("camera+", "thermal_imager+")
    after = after.replace(
        "  camera_driver: {implements: camera, host: pc, package: usb_cam, publishes: {image: /image}}\n", ""
    )
    after = after.replace("[camera,", "[thermal_imager,")
    kinds = {(kind, sort, name) for kind, sort, name, _ in summary(compared, ROBOT, after)}
    assert ("removed", "component", "sensing.camera") in kinds
    assert ("added", "component", "sensing.thermal_imager") in kinds


def test_stubs_are_not_taken_for_each_other(compared: Compared) -> None:
    head = "groups:\n  g:\n    components:\n"
    found = summary(compared, f"{head}      arm: {{title: Arm}}\n", f"{head}      base: {{title: Base}}\n")
    assert found == [("removed", "component", "g.arm", None), ("added", "component", "g.base", None)]


def test_many_renames_at_once_are_told_apart(compared: Compared) -> None:
    def robot(prefix: str) -> str:
        lines = [
            f"      {prefix}{n}: {{outputs: {{x{n}: T{n % 7}}}, inputs: {{i{n}: {prefix}{(n + 1) % 60}.x{(n + 1) % 60}}}}}"
            for n in range(60)
        ]
        return "groups:\n  g:\n    components:\n" + "\n".join(lines) + "\n"

    found = compared(robot("part"), robot("piece")).changes
    assert {(change.old_id, change.element_id) for change in found} == {
        (f"g.part{n}", f"g.piece{n}") for n in range(60)
    }
    assert {change.kind for change in found} == {"renamed"}
