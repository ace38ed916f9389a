"""What is offered while somebody writes: each row is a change of a file, with `|` where the cursor stands."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.lsp.client import Client
from tests.lsp.conftest import Workspace
from tests.property_sizes import try_some

STATE = "groups/robot_state.yaml"
ROWS = [
    # references: what fits the type first, then the own group
    (STATE, "from: base_controller.odometry, type", "from: |, type", "base_controller.odometry", 3),
    (STATE, "from: base_controller.odometry, type", "from: base_c|, type", "base_controller.odometry", 3),
    (STATE, "map: {from: metric_map.grid", "map: {from: met|", "metric_map.grid", 3),
    (STATE, "inertia: mobile_base.imu", "inertia: mobile_base.|", "mobile_base.imu", 400),
    (STATE, "scans: hardware.laser_scanners", "scans: [hardware.la|", "hardware.laser_scanners", 400),
    # ids by kind
    (STATE, "    owner: accrea", "    owner: |", "accrea", 8),
    (STATE, "requirements: [R-61, R-62]", "requirements: [R-61, |]", "R-62", 40),
    (STATE, "requirements: [R-61, R-62]", "requirements:\n          - |", "R-62", 40),
    (STATE, "          pose: Robot pose", "          pose: Robot p|", "Robot pose", 120),
    (STATE, "          pose: Robot pose", "          pose: {type: Ro|", "Robot pose", 120),
    (STATE, "parent: odom, by", "parent: |, by", "odom", 10),
    (STATE, "type: Odometry, frame: odom", "type: Odometry, frame: |", "odom", 10),
    (STATE, "tags: [navigation]", "tags: [nav|", "navigation", 20),
    ("nodes/devices.yaml", "namespace: /hand\n    host: arm_pc", "namespace: /hand\n    host: |", "arm_pc", 5),
    ("nodes/devices.yaml", "implements: hardware.hand_drives", "implements: |", "hardware.hand_drives", 200),
    ("nodes/action.yaml", "calls: {plan: /compute", "calls: {|plan: /compute", "plan", 20),
    ("timing.yaml", "through: [body_drives, arm_state_estimator", "through: [body_drives, arm_s|", "arm_state_estimator", 600),
    ("timing.yaml", "    requirements: [R-03]", "    requirements: [|", "R-03", 40),
    ("use_cases.yaml", "{from: home, to: head_camera, say: the stick", "{from: h|, to: head_camera, say: the stick", "home", 5),
    ("variants.yaml", "without: robot_action_planner.gaze_controller", "without: ta|", "tag:safety", 80),
    ("archgen.yaml", 'show: "tag:manipulation"', 'show: "owner:tum tag:ma|', "tag:manipulation", 80),
    ("archgen.yaml", "forbid: {from: cognitive_reasoning, to", "forbid: {from: cog|, to", "cognitive_reasoning", 80),
    ("ros_types.yaml", "{message: sensor_msgs/msg/Imu", "{message: sensor_msgs/msg/I|", "sensor_msgs/msg/Imu", 2000),
    # keys, with those that are there left out
    (STATE, "from: base_controller.odometry, type: Odometry}", "from: base_controller.odometry, |}", "type", 10),
    (STATE, "      hand_contact_monitor:\n", "      hand_contact_monitor:\n        |\n", "description", 25),
    (STATE, "      hand_contact_monitor:\n", "      hand_contact_monitor:\n        des|\n", "description", 25),
    (STATE, "frames:\n", "fra|\n", "frames", 40),
    (STATE, "by: body_frames, title: The inside", "by: body_frames, r|, title: The inside", "rate", 10),
    ("timing.yaml", "    deadline: 60 ms\n", "    dea|\n", "deadline", 10),
    ("hardware.yaml", "          imu: IMU", "          imu: {type: IMU, p|}", "promise", 15),
    # words and units
    (STATE, "owner: sssa\n        role: filter", "owner: sssa\n        role: |", "filter", 4),
    ("timing.yaml", "    deadline: 60 ms\n", "    deadline: 60|\n", "60 ms", 6),
    ("timing.yaml", "    deadline: 60 ms\n", "    deadline: 60 m|\n", "60 ms", 6),
    (STATE, "execution_time: 80 ms", "execution_time: 80 |", "80 ms", 6),
    ("nodes/devices.yaml", "executable: hand_driver\n    status: planned", "executable: hand_driver\n    status: |", "planned", 3),
]  # fmt: skip


def list_items(robot: Workspace, file: str, old: str, new: str) -> tuple[list[dict[str, Any]], str, int]:
    """Write a change, and return what is offered at its mark, with the line there and the cursor's column from 0."""
    text = robot.read(file)
    assert text.count(old) == 1, (file, old, text.count(old))
    marked = text.replace(old, new)
    before = marked[: marked.index("|", text.index(old))]
    changed = before + marked[len(before) + 1 :]
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    try:
        robot.client.write(file, changed)
        items = robot.client.at("completion", file, line, column)["items"]
    finally:
        robot.client.write(file, text)
    return items, changed.split("\n")[line - 1], column - 1


# After each the server checks the case study again: `make test` tries one row of each sort.
@pytest.mark.parametrize(
    "row",
    [
        pytest.param(row, id=row[2][-50:], marks=() if number % 6 == 0 else pytest.mark.slow)
        for number, row in enumerate(ROWS)
    ],
)
def test_what_fits_is_offered(robot: Workspace, row: tuple[str, str, str, str, int]) -> None:
    file, old, new, label, rank = row
    items, line, cursor = list_items(robot, file, old, new)
    labels = [item["label"] for item in sorted(items, key=lambda item: item["sortText"])]
    assert label in labels[:rank], labels[:20]
    edit = next(item["textEdit"] for item in items if item["label"] == label)
    start, end = edit["range"]["start"]["character"], edit["range"]["end"]["character"]
    # What is replaced is what was typed of it.
    assert end == cursor
    assert label.casefold().startswith(line[start:end].casefold().strip()) or line[start:end].strip() in label
    assert len(labels) == len(set(labels))


PARTNERS = """archgen: 1
groups:
  see:
    components:
      eye: {role: source, outputs: {image: Image}}
      finder:
        inputs: {picture: eye.image, place: {from: wheels.odometry}}
        outputs: {apples: Apples, view: Image}
        timing: {trigger: [picture]}
      smooth: {is: smoother<Apples>, inputs: {raw: finder.apples}}
      wheels: {outputs: {odometry: Odometry}, inputs: {speed: {external: a stick}}}
component_types:
  smoother: {generic: [T], inputs: {raw: T}, outputs: {clean: T}, timing: {trigger: any}}
nodes:
  finder: {implements: finder, subscribes: {place: {qos: default}}}
types: {Apples: std_msgs/msg/String, Image: sensor_msgs/msg/Image, Odometry: nav_msgs/msg/Odometry}
"""
OWN_ROWS = [
    ("trigger: [picture]", "trigger: [|]", ["any", "all", "picture", "place"]),
    ("trigger: any", "trigger: |", ["any", "all", "raw"]),
    ("trigger: [picture]", "inputs: {|}", ["picture", "place"]),
    ("trigger: [picture]", "outputs: {|}", ["apples", "view"]),
    ("smoother<Apples>", "smoother<|>", ["Apples", "Image", "Odometry"]),
    ("smoother<Apples>", "smoother<App|", ["Apples", "Image", "Odometry"]),
]


@pytest.mark.parametrize(("old", "new", "labels"), try_some(OWN_ROWS, 2))
def test_ports_are_those_of_what_stands_around_and_parameters_are_types(
    tmp_path: Path, old: str, new: str, labels: list[str]
) -> None:
    items = list_items_alone(tmp_path, PARTNERS, old, new)
    assert [item["label"] for item in items][: len(labels)] == labels
    assert not {"speed", "smoother"} & {item["label"] for item in items}


def test_outputs_of_the_reader_itself_come_last(tmp_path: Path) -> None:
    items = list_items_alone(tmp_path, PARTNERS, "picture: eye.image", "picture: |")
    labels = [item["label"] for item in sorted(items, key=lambda item: item["sortText"])]
    assert labels[0] == "eye.image"
    assert [each for each in labels if "finder." in each] == labels[-4:]


def list_items_alone(folder: Path, text: str, old: str, new: str) -> list[dict[str, Any]]:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    marked = text.replace(old, new)
    before = marked[: marked.index("|")]
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.wait_for("archgen.yaml")
        client.write("archgen.yaml", marked.replace("|", "", 1))
        column = len(before) - before.rfind("\n")
        answer = client.at("completion", "archgen.yaml", before.count("\n") + 1, column)
    return list(answer["items"] if isinstance(answer, dict) else answer)


def test_keys_are_explained_and_end_in_a_colon(robot: Workspace) -> None:
    items, _, _ = list_items(robot, STATE, "      hand_contact_monitor:\n", "      hand_contact_monitor:\n        |\n")
    offered = {item["label"]: item for item in items}
    assert "title" not in offered
    assert offered["image"]["textEdit"]["newText"] == "image: "
    assert offered["image"]["documentation"]


def test_a_key_that_has_its_colon_gets_no_second_one(robot: Workspace) -> None:
    items, _, _ = list_items(robot, STATE, "frames:\n", "fra|:\n")
    assert next(item for item in items if item["label"] == "frames")["textEdit"]["newText"] == "frames"


def test_nothing_is_offered_in_texts_and_comments(robot: Workspace) -> None:
    for old, new in (
        ("title: Base Localisation", "title: Base Loc|"),
        ("# What moves against", "# What |moves against"),
        ("          Fuses wheel odometry", "          Fuses |wheel odometry"),
    ):
        items, _, _ = list_items(robot, STATE, old, new)
        assert items == [], new


@pytest.mark.slow
def test_every_offered_source_is_one_that_a_check_takes(robot: Workspace) -> None:
    items, _, _ = list_items(robot, STATE, "inertia: mobile_base.imu", "inertia: |")
    for item in items[::25]:
        text = robot.read(STATE).replace("inertia: mobile_base.imu", f"inertia: {item['label']}")
        robot.client.write(STATE, text)
        robot.client.rest(0.6)
        codes = [each["code"] for each in robot.client.diagnostics[STATE]["diagnostics"] if each["severity"] == 1]
        assert "unknown-reference" not in codes, item["label"]
    robot.client.write(STATE, robot.read(STATE))
