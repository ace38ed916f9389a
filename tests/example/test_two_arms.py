"""Two arms of one type: what the few lines of the example stand for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.analyses.size_counts import measure_size
from archgen.checking.checked_packing import pack_checked_project
from archgen.compose.project_expansion import expand_project
from archgen.link import mapping_values
from archgen.pipeline import CheckedProject, check_project
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlNode
from archgen.syntax.yaml_writer import write_yaml
from tests.running import ROOT

FOLDER = ROOT / "examples" / "arm"
CONTROLLERS = {"strong_joint": 4, "wrist_joint": 3, "finger": 5}
"""How many controllers of each type an arm has."""


@pytest.fixture(scope="module")
def checked() -> CheckedProject:
    return check_project(FOLDER)


def test_there_is_nothing_to_complain_about(checked: CheckedProject) -> None:
    assert [str(finding) for finding in checked.findings] == []


def test_its_size(checked: CheckedProject) -> None:
    size = measure_size(checked.architecture)
    assert (size.components, size.composed, size.component_types) == (32, 4, 6)
    assert (size.connections, size.made_connections, size.nodes) == (67, 24, 32)


@pytest.mark.parametrize("arm", ["left_arm", "right_arm"])
def test_an_arm_has_twelve_controllers_of_three_types(checked: CheckedProject, arm: str) -> None:
    types = [
        each.component_type for id_, each in checked.architecture.components.items() if id_.startswith(f"body.{arm}.")
    ]
    assert {name: types.count(name) for name in CONTROLLERS} == CONTROLLERS


@pytest.mark.parametrize(
    ("component", "values"),
    [
        ("left_arm.elbow", {"side": "left", "joint": "left_elbow", "max_speed": 1.0, "gain": 80.0}),
        ("right_arm.elbow", {"side": "right", "joint": "right_elbow", "max_speed": 0.8, "gain": 80.0}),
        ("right_arm.shoulder_lift", {"side": "right", "joint": "right_shoulder_lift", "max_speed": 0.8, "gain": 120.0}),
        ("left_arm.wrist_roll", {"side": "left", "joint": "left_wrist_roll", "max_speed": 2.0, "gain": 20.0}),
        ("left_arm.hand.thumb", {"side": "left", "joint": "left_thumb", "max_speed": 2.0, "touch_threshold": 0.3}),
        ("right_arm.hand.thumb", {"side": "right", "joint": "right_thumb", "max_speed": 2.0, "touch_threshold": 0.5}),
    ],
)
def test_the_arm_hands_in_what_its_controllers_go_by(
    checked: CheckedProject, component: str, values: dict[str, object]
) -> None:
    parameters = checked.architecture.components[f"body.{component}"].parameters
    assert {name: parameters[name].value for name in values} == values


def test_each_arm_has_frames_of_its_own(checked: CheckedProject) -> None:
    frames = checked.architecture.frames
    links = ("shoulder", "elbow", "wrist_roll", "palm")
    assert set(frames) == {"torso", *(f"{side}_{link}" for side in ("left", "right") for link in links)}
    assert frames["right_palm"].parent == "right_wrist_roll"
    assert frames["right_palm"].by == "body.right_arm.hand.grip"


def test_the_same_written_out_by_hand_is_more_than_twice_as_long(checked: CheckedProject, tmp_path: Path) -> None:
    short, long = write_yaml(pack_checked_project(checked).data), write_yaml(write_out(checked))
    file = tmp_path / "written_out.yaml"
    file.write_text(long, encoding="utf-8")
    written_out = check_project(file)
    assert [str(finding) for finding in written_out.findings] == []
    assert set(written_out.architecture.components) == set(checked.architecture.components)
    assert {(e.output, e.input) for e in written_out.architecture.edges} == {
        (e.output, e.input) for e in checked.architecture.edges
    }
    assert len(short.splitlines()) * 2 < len(long.splitlines())


def write_out(checked: CheckedProject) -> dict[str, Any]:
    """Return a project without component types: every instance has all that its type has."""
    expansion = expand_project(checked.merged_table)
    data = read_mapping(expansion.root)
    del data["component_types"], data["sources"]
    bodies = {shell.id: read_mapping(mapping_values.get_body(shell.entry)) for shell in expansion.shells.values()}
    for group_id, group in data["groups"].items():
        leaves = group.pop("components")
        bodies |= {f"{group_id}.{path}": body for path, body in leaves.items()}
    for component_id, body in bodies.items():
        body.pop("is", None)
        group_id, own_id = component_id.partition(".")[0], component_id.rpartition(".")[2]
        parent = expansion.parents.get(component_id)
        around = bodies[parent] if parent else data["groups"][group_id]
        around.setdefault("components", {})[own_id] = body
    return data


def read_mapping(mapping: MappingNode) -> dict[str, Any]:
    """Return what a mapping of the tree holds."""
    return {entry.key: read_value(entry.value) for entry in mapping}


def read_value(node: YamlNode) -> object:
    """Return what a node of the tree holds."""
    if isinstance(node, MappingNode):
        return read_mapping(node)
    return [read_value(item) for item in node.items] if isinstance(node, SequenceNode) else node.value
