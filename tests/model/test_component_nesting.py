"""Where components stand: inside of groups and of one another."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.model.component_nesting import (
    find_closed,
    find_component,
    find_passed_shell,
    list_members,
    list_surrounding,
    list_written_connections,
)

ROBOT = """
archgen: 1
groups:
  g:
    components:
      arm:
        inputs: {goal: planner.goal, open: planner.goal}
        outputs: {state: {from: hand.state}}
        components:
          hand:
            inputs: {goal: self.goal, near: joint.state}
            outputs: {state: {from: finger.state}}
            components: {finger: {inputs: {goal: self.goal, near: self.near}, outputs: {state: State}}}
          joint: {inputs: {goal: self.goal}, outputs: {state: State}}
      planner: {inputs: {state: arm.state}, outputs: {goal: Goal}}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Architecture:
    """Return an arm with a hand inside, of which one input is not designed yet."""
    (tmp_path / "archgen.yaml").write_text(ROBOT)
    return pipeline.check_project(tmp_path).architecture


def test_what_is_around_a_component_is_told_from_the_outside_in(robot: Architecture) -> None:
    assert list_surrounding(robot, "g.arm.hand.finger") == ("g.arm", "g.arm.hand")
    assert list_surrounding(robot, "g.arm") == ()
    assert list_surrounding(robot, "g.planner") == ()


def test_a_closed_component_stands_for_what_is_inside(robot: Architecture) -> None:
    assert find_closed(robot, "g.arm.hand.finger") == "g.arm"
    assert find_closed(robot, "g.arm.hand.finger", {"g.arm"}) == "g.arm.hand"
    assert find_closed(robot, "g.arm.hand.finger", {"g.arm", "g.arm.hand"}) == "g.arm.hand.finger"
    assert find_closed(robot, "g.planner") == "g.planner"


def test_a_group_has_its_composed_components_once(robot: Architecture) -> None:
    assert sorted(list_members(robot, "g")) == ["g.arm", "g.planner"]


def test_a_composed_component_is_found_with_all_of_its_ports(robot: Architecture) -> None:
    # Among the leaves it has just the input that nothing inside reads.
    assert list(robot.components["g.arm"].inputs) == ["open"]
    assert list(find_component(robot, "g.arm").inputs) == ["goal", "open"]


def test_each_connection_is_listed_where_it_is_written(robot: Architecture) -> None:
    connections = {port.id: connection for port, connection in list_written_connections(robot)}
    assert sorted(connections) == [
        "g.arm.goal",
        "g.arm.hand.finger.goal",
        "g.arm.hand.finger.near",
        "g.arm.hand.goal",
        "g.arm.hand.near",
        "g.arm.joint.goal",
        "g.arm.open",
        "g.planner.state",
    ]
    passed = {
        port_id: find_passed_shell(robot, port_id.rpartition(".")[0], each) for port_id, each in connections.items()
    }
    assert {port_id: shell for port_id, shell in passed.items() if shell} == {
        "g.arm.hand.finger.goal": "g.arm.hand",
        "g.arm.hand.finger.near": "g.arm.hand",
        "g.arm.hand.goal": "g.arm",
        "g.arm.joint.goal": "g.arm",
    }
