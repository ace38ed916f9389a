"""Use cases as they are declared: actors and steps, with what their ends name. Findings: cases/use_cases.txt."""

from __future__ import annotations

from collections.abc import Callable

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.use_case_steps import StepEnd

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]

ROBOT = """
use_cases:
  UC-1:
    actors: {the_pilot: The pilot, tower: }
    steps:
      - {from: the_pilot, to: drone, say: 1.10}
      - {from: drone.pose, to: tower, say: }
      - {from: drone, to: drone}
  UC-2: Plain
groups: {g: {components: {drone: {outputs: {pose: Pose}}}}}
"""


def test_actors_and_steps(linked: Linked) -> None:
    architecture, found = linked(ROBOT)
    assert found == ()
    use_case = architecture.use_cases["UC-1"]
    assert [(actor.id, actor.title, actor.at.column) for actor in use_case.actors.values()] == [
        ("the_pilot", "The pilot", 14),
        ("tower", "Tower", 36),
    ]
    assert [(step.source, step.target, step.say, step.is_inner) for step in use_case.steps] == [
        (StepEnd("actor", "the_pilot"), StepEnd("component", "g.drone"), "1.10", False),
        (StepEnd("output", "g.drone.pose"), StepEnd("actor", "tower"), None, False),
        (StepEnd("component", "g.drone"), StepEnd("component", "g.drone"), None, True),
    ]
    assert [(step.at.line, step.at.column) for step in use_case.steps] == [(6, 16), (7, 16), (8, 16)]
    assert use_case.steps[1].source.participant == "g.drone"
    assert (architecture.use_cases["UC-2"].actors, architecture.use_cases["UC-2"].steps) == ({}, ())


def test_an_end_that_names_nothing_keeps_its_words(linked: Linked) -> None:
    architecture, found = linked(ROBOT.replace("to: tower, say", "to: towers.top, say"))
    assert [each.rule for each in found] == ["unknown-reference"]
    step = architecture.use_cases["UC-1"].steps[1]
    assert (step.target.kind, step.target.id, step.is_resolved) == ("unknown", "towers.top", False)
