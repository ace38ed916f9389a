"""Requirements that ask for something else, and policies that keep less apart: whom that breaks, and whom it concerns."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import broken

ROBOT = """\
partners: {a: A, b: B, c: C}
hosts: {pc: {cores: 2}}
requirements:
  R1: {title: It stops before an obstacle, description: Below 1 m/s, priority: must, verified_by: c}
  R2: {title: It is blue}
policies:
  p: {forbid: {from: drive act, to: sense}, title: No way back}
  q: {require: {of: act, inputs_from: drive}, title: Only drive acts}
groups:
  sense: {owner: a, components: {eye: {outputs: {rows: Rows}, requirements: [R1, R2]}}}
  drive: {owner: b, components: {base: {inputs: {rows: eye.rows}, outputs: {speed: Speed}}}}
  act: {owner: c, components: {motor: {inputs: {speed: base.speed}}}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  base: {implements: base, host: pc, timing: {wcet: 1 ms}}
chains: {c: {through: [eye, base], deadline: 300 ms}}
"""
MAY = "R1/title {}: asks by `R1` for `It may slow down` instead of `It stops before an obstacle`; A and B answer for it"
POLICY_P = (
    "p/{} {}: takes something out of the policy `p` (`No way back`); `sense.eye` of A, `drive.base` of B and "
    "`act.motor` of C are under it"
)
EVERYBODY = ("a", "b", "c")


@pytest.mark.parametrize(
    ("old", "new", "said", "concerned"),
    [
        ("It stops before an obstacle", "It may slow down", [MAY.format(each) for each in "ab"], "ab"),
        ("It stops before an obstacle", "it stops - before an Obstacle", [], "ab"),
        (
            "Below 1 m/s",
            "Below 10 m/s",
            [
                f"R1/description {each}: asks by `R1` for `Below 10 m/s` instead of `Below 1 m/s`; A and B answer for it"
                for each in "ab"
            ],
            "ab",
        ),
        (
            ", priority: must",
            "",
            [
                f"R1/priority {each}: asks by `R1` for nothing more instead of `must`; A and B answer for it"
                for each in "ab"
            ],
            "ab",
        ),
        # It is a's alone.
        ("It is blue", "It is green", [], "a"),
        (
            "  p: {forbid: {from: drive act, to: sense}, title: No way back}\n",
            "",
            [
                f"p {each}: takes away the policy `p` (`No way back`); `sense.eye` of A, `drive.base` of B and "
                "`act.motor` of C are under it"
                for each in EVERYBODY
            ],
            "abc",
        ),
        ("from: drive act,", "from: drive,", [POLICY_P.format("forbid.from", each) for each in EVERYBODY], "abc"),
        ("to: sense}", "to: '-tag:x sense'}", [], "abc"),
        (
            "title: No way",
            "accepted: {act.motor.speed: why not}, title: No way",
            [POLICY_P.format("accepted.act.motor.speed", each) for each in EVERYBODY],
            "abc",
        ),
        ("from: drive act,", "from: drive act sense,", [], "abc"),
        # Of c alone: more may come in, but nobody else had anything of that.
        ("inputs_from: drive", "inputs_from: drive sense", [], "c"),
        ("No way back", "No way back at all", [], ""),
    ],
)
def test_who_answers_for_a_demand(compared: Compared, old: str, new: str, said: list[str], concerned: str) -> None:
    assert broken(compared, ROBOT, [(old, new)]) == said
    assert compared(ROBOT, ROBOT.replace(old, new)).concerned_owners == tuple(concerned)


def test_a_component_that_is_gone_needs_no_policy(compared: Compared) -> None:
    edits = [
        ("  act: {owner: c, components: {motor: {inputs: {speed: base.speed}}}}\n", ""),
        ("drive act,", "drive,"),
        ("  q: {require: {of: act, inputs_from: drive}, title: Only drive acts}\n", ""),
    ]
    assert not [each for each in broken(compared, ROBOT, edits) if each.startswith("p")]


def test_who_leaves_what_a_policy_selects_without_a_word_about_it(compared: Compared) -> None:
    tagged = ROBOT.replace("to: sense}", "to: 'tag:quiet'}").replace("eye: {outputs", "eye: {tags: [quiet], outputs")
    said = broken(compared, tagged, [("tags: [quiet], ", "")])
    words = POLICY_P.replace("p/{}", "sense.eye/tags").replace(
        "`sense.eye` of A, `drive.base` of B", "`drive.base` of B"
    )
    assert said == [words.format(each) for each in ("b", "c")]
