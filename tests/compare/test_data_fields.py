"""Fields, constants and values of types change: as those of a definition do, which is what they are."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared

ROBOT = """\
archgen: 1
project: {id: robot}
ros: {distro: jazzy}
partners: {a: A, b: B}
groups:
  sense:
    owner: a
    components:
      eye: {outputs: {pose: Robot pose, mode: Mode, box: Box<Robot pose>, gain: Set gain}}
  drive:
    owner: b
    components:
      base: {inputs: {pose: eye.pose, mode: eye.mode, box: eye.box, gain: eye.gain}}
types:
  Place: geometry_msgs/msg/Point
  Target: geometry_msgs/msg/Point
  Robot pose: {fields: {place: Place, heading: {type: float64, unit: rad, default: 0.5}}, constants: {MAX: {type: uint8, value: 32}}}
  Mode: {values: [IDLE, RUN]}
  Box: {generic: [T], fields: {sender: string, content: T}}
  Set gain: {request: {gain: float64}, response: {ok: bool}}
"""
POSE, BUILT = "`robot_msgs/msg/RobotPose`", "what was built before cannot talk to what is built after"


@pytest.mark.parametrize(
    ("old", "new", "changes", "breaks"),
    [
        (
            "place: Place, heading",
            "heading",
            ["message robot_msgs/msg/RobotPose fields"],
            [("wire", f"removes `place` in {POSE}, which B uses; {BUILT}")],
        ),
        (
            "place: Place,",
            "place: Place, extra: bool,",
            ["message robot_msgs/msg/RobotPose fields"],
            [("wire", f"adds `extra` in {POSE}, which B uses; even a field more makes another message to ROS: {BUILT}")],
        ),
        (
            "place: Place,",
            'place: "Place[]",',
            ["message robot_msgs/msg/RobotPose fields"],
            [("wire", f"changes the type of `place` in {POSE}, which B uses; {BUILT}")],
        ),
        (
            "{sender: string, content: T}",
            "{content: T, sender: string}",
            ["message robot_msgs/msg/BoxRobotPose fields"],
            [("wire", f"puts fields in another order in `robot_msgs/msg/BoxRobotPose`, which B uses; {BUILT}")],
        ),
        (
            "place: Place,",
            "place: Target,",
            ["type Robot pose fields.place"],
            [("meaning", "puts `Target` instead of `Place` into `place` of `Robot pose`; B uses it")],
        ),
        (
            "unit: rad",
            "unit: deg",
            ["message robot_msgs/msg/RobotPose comments.heading"],
            [("meaning", f"says of `heading` in {POSE} `[deg]` instead of `[rad]`; B uses it")],
        ),
        (
            "value: 32",
            "value: 33",
            ["message robot_msgs/msg/RobotPose constants.MAX"],
            [("wire", f"changes the constant `MAX` of {POSE}, which B uses; what was built before means something else by the same bytes")],
        ),
        (
            "[IDLE, RUN]",
            "[IDLE, RUN, STOP]",
            ["message robot_msgs/msg/Mode constants.STOP"],
            [],
        ),
        (
            "gain: float64",
            "gain: float32",
            ["message robot_msgs/srv/SetGain fields"],
            [("wire", f"changes the type of `gain` in `robot_msgs/srv/SetGain`, which B uses; {BUILT}")],
        ),
        ("fields: {place: Place, ", "message: robot_msgs/msg/RobotPose, fields: {place: {type: Place}, ", [], []),
        ("default: 0.5", 'default: "0.5"', [], []),
        ("Box<Robot pose>", '"Box< Robot pose >"', [], []),
    ],
)  # fmt: skip
def test_a_changed_type_is_a_changed_message(
    compared: Compared, old: str, new: str, changes: list[str], breaks: list[tuple[str, str]]
) -> None:
    comparison = compared(ROBOT, ROBOT.replace(old, new))
    assert [f"{each.element_kind} {each.element_id} {each.key}" for each in comparison.changes] == changes
    assert [(each.category, each.reason) for change in comparison.changes for each in change.breaks] == breaks


def test_a_generic_type_says_what_changed_in_it(compared: Compared) -> None:
    comparison = compared(ROBOT, ROBOT.replace("content: T}", "content: T, when: Place}"))
    assert [change.text for change in comparison.changes] == [
        "message `robot_msgs/msg/BoxRobotPose`: fields `geometry_msgs/msg/Point when` added; it carries `Box<Robot pose>`",
        "type `Box`: field `when` set to `Place`",
    ]
    comparison = compared(
        ROBOT, ROBOT.replace("[T], fields", "[S, T], fields").replace("Box<Robot pose>", '"Box<Place, Robot pose>"')
    )
    assert "type `Box`: type parameters `S` added" in [change.text for change in comparison.changes]


def test_fields_are_the_same_message_as_its_file(compared: Compared) -> None:
    fields = """  Robot pose: {fields: {place: geometry_msgs/Point, heading: {type: float64, default: 0.5, comment: Left.}}, constants: {MAX: {type: uint8, value: 32, comment: All.}}}"""
    text = """
    robot_msgs/msg/RobotPose: |
      uint8 MAX=32  # All.
      geometry_msgs/Point place
      float64 heading 0.5  # Left.
"""
    head, _, _ = ROBOT.replace(
        "pose: Robot pose, mode: Mode, box: Box<Robot pose>, gain: Set gain", "pose: Robot pose"
    ).partition("types:")
    head = head.replace(", mode: eye.mode, box: eye.box, gain: eye.gain", "")
    before = (
        head.replace("{distro: jazzy}", f"\n  distro: jazzy\n  definitions:{text}")
        + "types: {Robot pose: robot_msgs/msg/RobotPose}"
    )
    assert compared(before, f"{head}types:\n{fields}\n").changes == ()
