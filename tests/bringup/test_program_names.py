"""What nodes of one generated program are called is one answer; that launch files and code give it, too, tests/plugins/ros_code shows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.bringup.program_names import ProgramNames, choose_own_names, group_endpoints, index_endpoints
from archgen.bringup.start_plan import make_start_plan
from archgen.model.architecture import Architecture
from archgen.pipeline import check_project

PROJECT = """\
archgen: 1
project: {id: arms}
ros: {distro: jazzy}
component_types:
  motor: {functionality: Turns., inputs: {target: std_msgs/Float64}, outputs: {state: std_msgs/Float64, oil: Unsaid}}
groups:
  g:
    components:
      planner: {functionality: Plans., outputs: {left_goal: std_msgs/Float64, right_goal: std_msgs/Float64}}
      left: {is: motor, inputs: {target: planner.left_goal}}
      right: {is: motor, inputs: {target: planner.right_goal}}
nodes:
  l: {implements: g.left, package: motors, executable: motor, remaps: {/tf: tf}, host: one}
  r: {implements: g.right, package: motors, executable: motor, host: two}
hosts: {one: , two: }
"""
EXPECTED = {
    "l": {"target": "/g/planner/left_goal", "state": "/g/left/state", "/tf": "tf"},
    "r": {"target": "/g/planner/right_goal", "state": "/g/right/state"},
}


def read(folder: Path) -> Architecture:
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return check_project(folder).architecture


def test_all_who_ask_get_one_answer(tmp_path: Path) -> None:
    architecture = read(tmp_path)
    assert {name: ProgramNames(architecture, 2).find_remaps(architecture.nodes[name]) for name in "lr"} == EXPECTED
    steps = {step.id: step for step in make_start_plan(architecture).steps}
    assert {name: step.ros.remaps for name, step in steps.items() if step.ros and name in "lr"} == EXPECTED
    assert "-r target:=/g/planner/left_goal" in " ".join(steps["l"].command)


def test_a_program_of_one_node_knows_its_ports_alone(tmp_path: Path) -> None:
    architecture = read(tmp_path)
    endpoints = index_endpoints(architecture)
    assert type(endpoints) is dict
    groups = group_endpoints([architecture.nodes["planner"]], endpoints)
    names = {key: own_name for (_, _, key), own_name in choose_own_names(architecture, groups).items()}
    assert names == {"left_goal": "left_goal", "right_goal": "right_goal"}
    remaps = ProgramNames(architecture, 2).find_remaps(architecture.nodes["planner"])
    assert remaps == {"left_goal": "/g/planner/left_goal", "right_goal": "/g/planner/right_goal"}


def test_ports_of_one_name_and_topics_of_all_nodes_are_told_apart(derived: Callable[[str], Architecture]) -> None:
    architecture = derived("""
groups:
  g:
    components:
      cam: {outputs: {pose: std_msgs/Float64}}
      filter: {inputs: {pose: cam.pose}, outputs: {pose: std_msgs/Float64, frames: tf2_msgs/TFMessage, odd: std_msgs/String}}
nodes:
  filter: {implements: g.filter, publishes: {frames: {topic: /tf}, odd: {topic: /odd, own_name: /here}}}
""")
    groups = group_endpoints([architecture.nodes["filter"]], index_endpoints(architecture))
    names = {use + " " + key: own_name for (use, _, key), own_name in choose_own_names(architecture, groups).items()}
    assert names == {
        "subscribes pose": "subscribes/pose",
        "publishes pose": "publishes/pose",
        "publishes frames": "/tf",
        "publishes odd": "/here",
    }
    assert ProgramNames(architecture, 2).find_remaps(architecture.nodes["filter"]) == {
        "subscribes/pose": "/g/cam/pose",
        "publishes/pose": "/g/filter/pose",
        "/here": "/odd",
    }


def test_a_plan_starts_what_generators_make(derived: Callable[[str], Architecture]) -> None:
    """The same programs and classes as launch files name, so that all of the start-up agrees."""
    architecture = derived("""
component_types: {arm: {functionality: Grips., inputs: {}, outputs: {state: std_msgs/String}}}
groups: {g: {components: {left: {is: arm}, filter: Filters.}}}
nodes:
  left: {implements: g.left}
  filter: {implements: g.filter, kind: composable, container: box}
containers: {box: {}}
""")
    commands = {step.id: " ".join(step.command) for step in make_start_plan(architecture).steps}
    assert commands["left"] == "ros2 run robot_g arm --ros-args -r __node:=left -r state:=/g/left/state"
    assert commands["filter"] == "ros2 component load /box robot_g_cpp robot_g_cpp::Filter --node-name filter"


GUARD = """\
archgen: 1
project: {id: farm}
ros: {distro: jazzy}
groups:
  arms:
    components:
      left: {outputs: {state: std_msgs/Float64}}
      right: {outputs: {state: std_msgs/Float64}}
  safety:
    components:
      guard: {inputs: {arms: SOURCES}}
      second: {is: reader, inputs: {in: [arms.left.state, arms.right.state]}}
      third: {is: reader, inputs: {in: [arms.right.state, arms.left.state]}}
component_types: {reader: {inputs: {in: std_msgs/Float64}}}
"""
BOTH = {"arms_left": "/arms/left/state", "arms_right": "/arms/right/state"}


def name_topics(folder: Path, text: str, node: str) -> dict[str, str]:
    """Return the topics of what the program of a node reads, by their names in it."""
    file = folder / "farm.yaml"
    file.write_text(text, encoding="utf-8")
    farm = check_project(file).architecture
    nodes = [each for each in farm.nodes.values() if each.id == node or (node == "reader" and each.id != "guard")]
    named = group_endpoints(nodes, index_endpoints(farm))
    return {key: each.label for (use, _, key), ends in named.items() if use == "subscribes" for each in ends}


@pytest.mark.parametrize(
    "sources", ["[arms.left.state, arms.right.state]", "[arms.right.state, arms.left.state]", "arms"]
)
def test_what_several_sources_are_called_does_not_hang_on_their_order(tmp_path: Path, sources: str) -> None:
    text = GUARD.replace("SOURCES", sources)
    assert name_topics(tmp_path, text, "guard") == BOTH
    moved = text.replace("      left: {outputs: {state: std_msgs/Float64}}\n", "")
    moved = moved.replace("  safety:", "      left: {outputs: {state: std_msgs/Float64}}\n  safety:")
    assert name_topics(tmp_path, moved, "guard") == BOTH


def test_one_source_has_the_name_of_its_port_alone(tmp_path: Path) -> None:
    assert name_topics(tmp_path, GUARD.replace("SOURCES", "arms.left.state"), "guard") == {"arms": "/arms/left/state"}


def test_nodes_of_one_program_on_the_same_topics_share_their_names(tmp_path: Path) -> None:
    text = GUARD.replace("SOURCES", "arms")
    assert name_topics(tmp_path, text, "reader") == {"in_left": "/arms/left/state", "in_right": "/arms/right/state"}
