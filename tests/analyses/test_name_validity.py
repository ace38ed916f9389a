"""Tests of the names that ROS accepts."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.analyses.name_validity import duplicate_node_name, invalid_ros_name
from archgen.derivation.wire.wire_names import find_name_fault, find_node_name_fault

Found = Callable[..., list[str]]
_LETTERS = "and only letters (a to z), digits and `_` are allowed"


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("/camera/rgbd", None),
        ("rgbd", None),
        ("~/debug", None),
        ("~", None),
        ("/", None),
        ("_hidden/a_b2", None),
        ("{node}/state", None),
        ("/Camera_1/Image", None),
        ("", "it is empty"),
        ("~debug", "`~` is followed by `/`"),
        ("/camera/", "it ends with `/`"),
        ("//camera", "two `/` follow one another"),
        ("/camera//image", "two `/` follow one another"),
        ("/front-camera", f"it holds `-`, {_LETTERS}"),
        ("/front camera", f"it holds a blank, {_LETTERS}"),
        ("/wärme", f"it holds `ä`, {_LETTERS}"),
        ("/a/~b", f"it holds `~`, {_LETTERS}"),
        ("/camera/2d", "`2d` begins with a digit"),
        ("{robot}/state", f"it holds `{{`, {_LETTERS}"),
    ],
)
def test_names_of_topics_and_services_in_ros_2(name: str, fault: str | None) -> None:
    assert find_name_fault(name) == fault


def test_ros_1_minds_digits_only_at_the_beginning() -> None:
    assert find_name_fault("/camera/2d", ros_1=True) is None
    assert find_name_fault("~scan", ros_1=True) is None
    assert find_name_fault("~front/scan", ros_1=True) is None
    assert find_name_fault("~front-scan", ros_1=True) == f"it holds `-`, {_LETTERS}"
    assert find_name_fault("2d/camera", ros_1=True) == "`2d` begins with a digit"


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("recognizer", None),
        ("Recognizer2", None),
        ("", "it is empty"),
        ("2nd", "`2nd` begins with a digit"),
        ("my node", f"it holds a blank, {_LETTERS}"),
        ("/perception/node", "it holds `/`: what stands before the name belongs into `namespace`"),
    ],
)
def test_names_of_nodes(name: str, fault: str | None) -> None:
    assert find_node_name_fault(name) == fault


def test_all_names_that_a_node_writes_are_checked(found: Found) -> None:
    text = """
        node a name=my-node namespace=/rob/
        node b namespace=/ok
        use b publishes image topic=/front-camera
        use b calls reset topic=/reset/
        node c name=not-ours planned
        use b subscribes all topic=/
    """
    assert found(invalid_ros_name, text) == [
        "1: `/rob/` cannot be the name of a namespace: it ends with `/`",
        f"1: `my-node` cannot be the name of a node: it holds `-`, {_LETTERS}",
        f"3: `/front-camera` cannot be the name of a topic: it holds `-`, {_LETTERS}",
        "4: `/reset/` cannot be the name of a service or action: it ends with `/`",
        "6: `/` cannot be the name of a topic: it is only a `/`",
    ]


def test_two_nodes_of_one_full_name_clash(found: Found) -> None:
    text = """
        node a name=cam
        node b name=cam namespace=/left
        node c name=cam namespace=/left/
        node d name=cam
        node e name=cam planned
    """
    assert found(duplicate_node_name, text) == [
        "3: `c` has the name `/left/cam`, which is the name of `b`",
        "4: `d` has the name `/cam`, which is the name of `a`",
    ]
