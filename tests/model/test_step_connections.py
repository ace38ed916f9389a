"""What the steps of use cases run along: topics one way, services and actions both ways, external ports, insides."""

from __future__ import annotations

from collections.abc import Callable

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.step_connections import StepConnection, StepConnections, UseCaseSteps

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]

ROBOT = """
use_cases:
  UC-0: Nothing said
  UC-1:
    actors: {pilot: The pilot}
    steps:
      - {from: pilot, to: drone, say: shouts}
      - {from: ear, to: brain}
      - {from: brain, to: brain}
      - {from: drone, to: ground}
      - {from: ground, to: drone.plan}
      - {from: drone.pose, to: ground}
      - {from: ground, to: pilot}
      - {from: stub, to: ground}
      - {from: ground, to: ear}
      - {from: nobody, to: ear}
component_types:
  quadrocopter:
    inputs: {voice: Voice}
    outputs: {pose: {from: brain.pose}, plan: {from: brain.plan}}
    components:
      ear: {inputs: {voice: self.voice}, outputs: {words: Words}}
      brain: {inputs: {words: ear.words}, outputs: {pose: geometry_msgs/msg/Pose, plan: nav_msgs/srv/GetPlan}}
groups:
  air: {components: {drone: {is: quadrocopter, inputs: {voice: {external: The pilot shouts, medium: physical}}}}}
  earth:
    components:
      stub:
      ground: {inputs: {pose: drone.pose, plan: drone.plan, s: stub}, outputs: {screen: {type: Picture, external: seen, medium: physical}}}
"""


def test_what_steps_run_along(linked: Linked) -> None:
    architecture, _ = linked(ROBOT)
    steps = UseCaseSteps(architecture).by_use_case
    assert list(steps) == ["UC-1"]
    pose = StepConnection("topic", "air.drone.brain.pose", "earth.ground.pose")
    plan = StepConnection("service", "air.drone.brain.plan", "earth.ground.plan")
    assert [each.connections for each in steps["UC-1"]] == [
        (StepConnection("outside", None, "air.drone.ear.voice"),),
        (StepConnection("topic", "air.drone.ear.words", "air.drone.brain.words"),),
        (),
        (pose, plan),
        (plan,),
        (pose,),
        (StepConnection("outside", "earth.ground.screen", None),),
        (StepConnection("topic", None, "earth.ground.s"),),
        (),
        (),
    ]
    assert [(each.number, each.way) for each in steps["UC-1"]][:5] == [
        (1, "outside"),
        (2, "topic"),
        (3, None),
        (4, "topic"),
        (5, "service"),
    ]
    assert [each.number for each in steps["UC-1"] if each.is_broken] == [9]


def test_who_takes_part_in_which_use_case(linked: Linked) -> None:
    architecture, _ = linked(ROBOT)
    assert dict(UseCaseSteps(architecture).by_component) == dict.fromkeys(
        ("air.drone", "air.drone.ear", "air.drone.brain", "earth.ground", "earth.stub"), ("UC-1",)
    )


def test_a_project_without_steps_has_nothing_to_index(linked: Linked) -> None:
    architecture, _ = linked(
        "use_cases: {UC-1: Plain}\ngroups: {g: {components: {a: {outputs: {x: X}}, b: {inputs: {x: a.x}}}}}"
    )
    assert dict(UseCaseSteps(architecture).by_use_case) == {}
    connections = StepConnections(architecture)
    assert connections.list_between("g.a", "g.b") == [StepConnection("topic", "g.a.x", "g.b.x")]
    assert connections.list_sent("g.b") == ()
