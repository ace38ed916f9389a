"""What a partner reads is something else now: which type, which message, which fields, and whose."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import BASE, TYPED, broken

READS = "as `sensing.camera.image`; `tracking.tracker.image` of SSSA reads it"
INSTEAD = f"gives `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image` {READS}"
COMPRESSED = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
NAMED = (
    BASE.replace(", depth: Depth image", "")
    + "nodes: {eye: {implements: camera, publishes: {image: {message: a_msgs/msg/A}}}, mind: {implements: tracker}}\n"
)
TWO_NODES = TYPED + "nodes: {one: {implements: camera}, two: {implements: camera}, mind: {implements: tracker}}\n"
OUTPUTS = {
    "a type that has no message any more": (
        TYPED,
        (": sensor_msgs/msg/Image", ": {size: 1 MB}"),
        [f"Colour image/message sssa: gives no message any more instead of `sensor_msgs/msg/Image` {READS}"],
    ),
    "a type that has a message now": (TYPED, (": x_msgs/msg/Tracks", ": {message: x_msgs/msg/Tracks, size: 1 kB}"), []),
    "an output without a type": (
        TYPED,
        ("image: Colour image", "image: "),
        [f"sensing.camera.image/type sssa: gives no type any more instead of `Colour image` {READS}"],
    ),
    "a type with another message": (
        TYPED,
        ("image: Colour image", "image: Tracks"),
        [f"sensing.camera.image/type sssa: gives `Tracks` instead of `Colour image` {READS}"],
    ),
    "a message that is read twice": (
        TYPED.replace("{image: camera.image}", "{image: camera.image, more: camera.image}"),
        COMPRESSED,
        ["Colour image/message sssa: " + INSTEAD.replace("image` of SSSA reads", "image` and `tracking.tracker.more` of SSSA read")],
    ),
    "a message that is optional to its reader": (
        TYPED.replace("{image: camera.image}", "{image: {from: camera.image, optional: true}}"),
        COMPRESSED,
        [],
    ),
    "a message that its own partner reads": (TYPED.replace("owner: sssa", "owner: certh"), COMPRESSED, []),
    "a message that somebody without a partner reads": (TYPED.replace("owner: sssa", "title: T"), COMPRESSED, []),
    "the message of a type whose output no node names": (TWO_NODES, COMPRESSED, [f"Colour image/message sssa: {INSTEAD}"]),
    "a message that a node names": (
        NAMED,
        ("a_msgs/msg/A", "b_msgs/msg/B"),
        [f"eye.publishes.image/message sssa: gives `b_msgs/msg/B` instead of `a_msgs/msg/A` {READS}"],
    ),
    "a message that a node no longer names": (
        NAMED,
        ("publishes: {image: {message: a_msgs/msg/A}}", "package: p"),
        [f"eye.publishes.image/message sssa: gives `sensor_msgs/msg/Image` instead of `a_msgs/msg/A` {READS}"],
    ),
    "the message of a type where the node names another one": (
        NAMED + "types: {Colour image: sensor_msgs/msg/Image}\n",
        COMPRESSED,
        [],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("project", "edit", "said"), OUTPUTS.values(), ids=OUTPUTS.keys())
def test_what_an_output_gives(compared: Compared, project: str, edit: tuple[str, str], said: list[str]) -> None:
    assert broken(compared, project, [edit]) == said


TASK = BASE.replace("image: Colour image", "image: Task") + "types: {Task: {request: Order, response: Done}}\n"


@pytest.mark.parametrize(
    ("project", "old", "new", "said"),
    [
        (TASK, "request: Order", "request: Wish", ["Task/request sssa: changes the request of `Task`, which SSSA uses"]),
        (TASK, "response: Done", "size: 1 kB", ["Task/response sssa: changes the response of `Task`, which SSSA uses"]),
        (TASK, "response: Done", "response: Done, feedback: Step", []),
        (TASK, "response: Done", "response: Done, size: 1 kB", []),
        (TASK.replace("owner: sssa", "owner: certh"), "request: Order", "request: Wish", []),
        (TASK.replace("image: Task", "image: Other"), "request: Order", "request: Wish", []),
    ],
)  # fmt: skip
def test_types_inside_of_a_type(compared: Compared, project: str, old: str, new: str, said: list[str]) -> None:
    assert broken(compared, project, [(old, new)]) == said


REBUILT = "what was built before cannot talk to what is built after"
DEFINED = BASE.replace("Colour image", "x_msgs/msg/Image") + (
    "nodes: {eye: {owner: tum, implements: camera}, mind: {owner: tum, implements: tracker}}\n"
    "ros: {distro: jazzy, definitions: {x_msgs/msg/Image: int8 a, x_msgs/msg/More: int8 b}}\n"
)
DRIVER = BASE + (
    "nodes: {driver: {owner: tum, internal: {calls: {s: {name: /s, message: x_msgs/srv/S}}}}}\n"
    'ros: {distro: jazzy, definitions: {x_msgs/srv/S: "int8 a\\n---\\nint8 a"}}\n'
)


@pytest.mark.parametrize(
    ("project", "old", "new", "said"),
    [
        # The partner of a component uses its messages, whoever owns the node.
        (DEFINED, "int8 a", "int16 a", f"x_msgs/msg/Image/fields sssa: changes the type of `a` in `x_msgs/msg/Image`, which SSSA uses; {REBUILT}"),
        (DEFINED, "x_msgs/msg/Image: int8 a, ", "", "x_msgs/msg/Image sssa: takes away the definition of `x_msgs/msg/Image`, which SSSA uses"),
        (DEFINED, "x_msgs/msg/More: int8 b", "x_msgs/msg/Most: float64 c", ""),
        # A node without a component: its own partner.
        (DRIVER, "---\\nint8 a", "---\\nint16 a", f"x_msgs/srv/S/fields tum: changes the type of `a` in `x_msgs/srv/S`, which TUM uses; {REBUILT}"),
        (DRIVER, "int8 a\\n---", "int8 b\\n---", f"x_msgs/srv/S/fields tum: removes `a` and adds `b` in `x_msgs/srv/S`, which TUM uses; {REBUILT}"),
        (DRIVER.replace("owner: tum", "title: D"), "---\\nint8 a", "---\\nint16 a", ""),
    ],
)  # fmt: skip
def test_definitions_and_who_is_built_against_them(
    compared: Compared, project: str, old: str, new: str, said: str
) -> None:
    assert broken(compared, project, [(old, new)]) == ([said] if said else [])
