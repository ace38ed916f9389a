"""The view `middleware`: classes, operations, parameters, instances and what joins them, for any robotic middleware."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.model.parameter import CallMode, Operation
from archgen.pipeline import check_project
from archgen.plugins.middlewares.middleware_classes import is_command
from archgen.plugins.middlewares.middleware_names import (
    make_class_name,
    name_inside,
    name_member,
    name_port_member,
    name_space,
    shorten_wire_name,
)
from archgen.plugins.middlewares.middleware_types import record_interface
from archgen.plugins.middlewares.middleware_view import make_view
from archgen.views.generation.generation_context import GenerationContext
from tests.plugins.middlewares.middleware_projects import HEADLAMP, write_project


def make(folder: Path, text: str = HEADLAMP, **context: object) -> tuple[dict[str, Any], list[str]]:
    project = write_project(folder, text)
    view = make_view(GenerationContext(project.architecture, **context))  # type: ignore[arg-type]
    return dict(view.data), [each.message for each in view.findings]


def test_a_class_stands_for_all_instances_of_a_type(tmp_path: Path) -> None:
    data, findings = make(tmp_path)
    assert findings == ["nobody says the fields of `Words`: it is text in what is generated"]
    classes = {each["name"]: each for each in data["components"]}
    assert list(classes) == ["Guppy80", "FourPoint", "AssemblyForceSensor", "AssemblyController", "AssemblyRobot"]
    camera = classes["Guppy80"]
    assert camera["instances"] == ["assembly.camera", "assembly.spare_camera"]
    assert [each["name"] for each in camera["methods"]] == ["get_image"]
    assert [each["name"] for each in camera["commands"]] == ["set_exposure"]
    assert [each["key"] for each in camera["parameters"]] == ["exposure", "mode"]
    assert (camera["is_periodic"], camera["rate_hz"]) == (True, 25.0)
    assert [(each["name"], each["server"]) for each in classes["AssemblyController"]["calls"]] == [
        ("grip", "AssemblyRobot")
    ]
    assert [(each["name"], each["is_fed"]) for each in classes["AssemblyController"]["inputs"]][-2:] == [
        ("words", True),
        ("outside", False),
    ]


def test_instances_have_their_own_values_and_periods(tmp_path: Path) -> None:
    data, _ = make(tmp_path)
    instances = {each["id"]: each for each in data["instances"]}
    values = {name: {each["key"]: each["value"] for each in instances[name]["values"]} for name in instances}
    assert values["assembly.camera"] == {"exposure": 0.02, "mode": "careful"}
    assert values["assembly.spare_camera"] == {"exposure": 0.01, "mode": "careful"}
    assert values["assembly.pos_sensor"]["big"] == 5_000_000_000
    assert [each["period_s"] for each in instances.values()] == [0.04, 0.04, 0.0, 0.01, 0.01, 0.0]


def test_records_stand_behind_what_they_hold(tmp_path: Path) -> None:
    data, _ = make(tmp_path)
    names = [f"{each['space']}::{each['name']}" for each in data["records"]]
    assert names.index("geometry_msgs::Vector3") < names.index("geometry_msgs::Wrench")
    assert names.index("geometry_msgs::Wrench") < names.index("geometry_msgs::WrenchStamped")
    assert "calls::FourPointFindAllResponse" in names
    fixed = {each["name"]: each["is_fixed"] for each in data["records"]}
    assert (fixed["Vector3"], fixed["Header"], fixed["Image"]) == (True, False, False)


def test_connections_have_the_readers_buffers(tmp_path: Path) -> None:
    data, _ = make(tmp_path)
    found = {each["id"]: each for each in data["connections"]}
    controller = "-> assembly.controller."
    buffers = {
        name: (each["buffer"], each["size"], each["keeps_last"])
        for name, each in found.items()
        if controller in name and not each["is_call"]
    }
    assert list(buffers.values()) == [("data", 1, False), ("circular", 5, False), ("buffer", 1000, True)]
    assert found["assembly.robot.grip -> assembly.controller.grip"]["is_call"]


def test_a_host_knows_what_it_shares_with_others(tmp_path: Path) -> None:
    data, _ = make(tmp_path)
    vision, robot = data["hosts"]
    assert [each["id"] for each in vision["remote"]] == ["assembly.controller"]
    assert [each["id"] for each in robot["remote"]] == ["assembly.pos_sensor"]
    # Who only sends waits for nobody.
    assert [[each["id"] for each in host["remote_sources"]] for host in (vision, robot)] == [
        [],
        ["assembly.pos_sensor"],
    ]
    part, _ = make(tmp_path, host="robot_pc")
    assert [each["id"] for each in part["hosts"]] == ["robot_pc"]
    assert [each["name"] for each in part["components"]] == [
        "AssemblyForceSensor",
        "AssemblyController",
        "AssemblyRobot",
    ]


def test_a_record_that_holds_itself_is_cut(tmp_path: Path) -> None:
    text = """\
archgen: 1
ros: {definitions: {p_msgs/msg/Tree: "int8 value\\np_msgs/Tree[] below\\n"}}
types: {Tree: p_msgs/msg/Tree}
groups: {g: {components: {a: {outputs: {tree: Tree}}}}}
"""
    data, findings = make(tmp_path, text)
    assert [[field["name"] for field in each["fields"]] for each in data["records"]] == [["value"]]
    assert len(findings) == 1
    assert findings[0].startswith("the field `below`")


@pytest.mark.parametrize(
    ("name", "call", "answer"),
    [
        ("set_gain", None, True),
        ("setGain", None, True),
        ("settle", None, False),
        ("get_gain", None, False),
        ("set_gain", "synchronous", False),
        ("move", "asynchronous", True),
    ],
)
def test_what_is_a_command(name: str, call: CallMode | None, answer: bool) -> None:  # noqa: FBT001
    assert is_command(Operation(name, name, call=call)) is answer


def test_names_are_no_words_of_anybody() -> None:
    assert [name_member(each) for each in ("class", "Sequence", "maxSpeed", "linux", "x")] == [
        "class_",
        "sequence_",
        "max_speed",
        "linux_",
        "x",
    ]
    assert [name_port_member(each) for each in ("start", "image", "operations")] == ["start_", "image", "operations_"]
    assert [make_class_name(each) for each in ("object", "laser_scan")] == ["Object_", "LaserScan"]
    assert [name_space(each) for each in ("rtt", "robot")] == ["rtt_", "robot"]
    assert [name_inside(each, "Image") for each in ("image", "width")] == ["image_value", "width"]
    assert shorten_wire_name("x" * 40) == "x" * 40
    assert len(shorten_wire_name("x" * 41)) == 40
    assert shorten_wire_name("x" * 41) != shorten_wire_name("x" * 42)


def test_interfaces_of_player_have_their_words() -> None:
    found = record_interface("position2d")
    assert found is not None
    assert found["data"] == "PLAYER_POSITION2D_DATA_STATE"
    assert found["command_struct"] == "player_position2d_cmd_vel_t"
    assert record_interface("speech") == {
        "name": "speech",
        "code": "PLAYER_SPEECH_CODE",
        "data": "",
        "data_struct": "",
        "command": "PLAYER_SPEECH_CMD_SAY",
        "command_struct": "player_speech_cmd_t",
    }
    assert record_interface("nothing") is None
    assert record_interface(["opaque"]) is None


def test_a_project_without_components_is_empty(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\nproject: {id: p}\n", encoding="utf-8")
    data = make_view(GenerationContext(check_project(tmp_path).architecture)).data
    assert (data["components"], data["instances"], data["hosts"], data["connections"]) == ([], [], [], [])
