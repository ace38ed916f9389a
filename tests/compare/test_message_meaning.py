"""What a message means: constants, defaults and comments change, and its fields stay as they were."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared

ROBOT = """\
archgen: 1
project: {id: robot}
partners: {a: A, b: B}
groups:
  sense:
    owner: a
    components:
      eye: {outputs: {stop: Stop}}
  drive:
    owner: b
    components:
      base: {inputs: {stop: eye.stop}}
types: {Stop: m_msgs/msg/Stop}
ros:
  distro: DISTRO
  definitions:
    m_msgs/msg/Stop: |
      uint8 RESUME=0
      uint8 STOP=1
      float32 offset  # m, positive to the left
      uint8 what
"""
ROBOT_2, ROBOT_1 = ROBOT.replace("DISTRO", "jazzy"), ROBOT.replace("DISTRO", "noetic")
SAYS = "says of `offset` in `m_msgs/msg/Stop`"
USES = "of `m_msgs/msg/Stop`, which B uses; what was built before"


def test_constants_that_swap_their_values_break_who_uses_them(compared: Compared) -> None:
    swapped = ROBOT_2.replace("RESUME=0", "RESUME=1").replace("STOP=1", "STOP=0")
    comparison = compared(ROBOT_2, swapped)
    assert [
        (change.text, [(each.partner, each.reason) for each in change.breaks]) for change in comparison.changes
    ] == [
        (
            "message `m_msgs/msg/Stop`: constant `RESUME` `uint8 0` → `uint8 1`; it carries `Stop`",
            [("b", f"changes the constant `RESUME` {USES} means something else by the same bytes")],
        ),
        (
            "message `m_msgs/msg/Stop`: constant `STOP` `uint8 1` → `uint8 0`; it carries `Stop`",
            [("b", f"changes the constant `STOP` {USES} means something else by the same bytes")],
        ),
    ]


@pytest.mark.parametrize(
    ("robot", "old", "new", "reason"),
    [
        (
            ROBOT_2,
            "      uint8 RESUME=0\n",
            "",
            f"takes away the constant `RESUME` {USES} means something else by the same bytes",
        ),
        (ROBOT_2, "uint8 what", "uint8 PAUSE=2\n      uint8 what", None),
        (
            ROBOT_1,
            "uint8 what",
            "uint8 PAUSE=2\n      uint8 what",
            f"changes the constant `PAUSE` {USES} cannot talk to what is built after",
        ),
        (ROBOT_2, "uint8 what", "uint8 what 1", None),
        (
            ROBOT_2,
            "# m, positive to the left",
            "# mm, positive to the left",
            f"{SAYS} `mm, positive to the left` instead of `m, positive to the left`; B uses it",
        ),
        (ROBOT_2, "# m, positive to the left", "", f"{SAYS} no longer `m, positive to the left`; B uses it"),
        (ROBOT_2, "# m, positive to the left", "# m: Positive to the left.", None),
        (ROBOT_2, "uint8 what", "# Of the base.\n\n      uint8 what", None),
    ],
)
def test_whom_a_change_of_meaning_breaks(
    compared: Compared, robot: str, old: str, new: str, reason: str | None
) -> None:
    (change,) = compared(robot, robot.replace(old, new)).changes
    assert [each.reason for each in change.breaks] == ([reason] if reason else [])


def test_a_changed_default_breaks_who_relies_on_it(compared: Compared) -> None:
    robot = ROBOT_2.replace("uint8 what", "uint8 what 1")
    for new, verb in (("uint8 what 2", "changes"), ("uint8 what", "takes away")):
        (change,) = compared(robot, robot.replace("uint8 what 1", new)).changes
        (loss,) = change.breaks
        assert loss.reason == (
            f"{verb} the default of `what` in `m_msgs/msg/Stop`, which B uses: what does not set it sends something else"
        )


def test_another_unit_is_shown_in_its_words_and_concerns_the_readers(compared: Compared) -> None:
    comparison = compared(ROBOT_2, ROBOT_2.replace("# m,", "# mm,"))
    (change,) = comparison.changes
    assert change.text == (
        "message `m_msgs/msg/Stop`: what is said of `offset` `m, positive to the left` → `mm, positive to the left`; "
        "it carries `Stop`"
    )
    assert comparison.concerned_owners == ("a", "b")
