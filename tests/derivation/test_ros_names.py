"""Absolute names, as ROS resolves them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.derivation.ros_names import default_port_name, resolve_ros_name, shared_topic_names
from archgen.model.architecture import Architecture


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("image", "/robot/image"),
        ("/image", "/image"),
        ("//image", "/image"),
        ("~/image", "/robot/camera/image"),
        ("~image", "/robot/camera/image"),
        ("~", "/robot/camera"),
        ("{node}/image", "/robot/camera/image"),
        ("/{ns}/image", "/robot/image"),
        ("/{namespace}/{node}", "/robot/camera"),
    ],
)
def test_a_name_is_resolved_in_the_namespace_of_its_node(
    derived: Callable[[str], Architecture], written: str, name: str
) -> None:
    node = derived("nodes: {camera: {namespace: /robot/}}").nodes["camera"]
    assert resolve_ros_name(written, node) == name


@pytest.mark.parametrize(
    ("written", "name"), [("image", "/image"), ("~/image", "/camera/image"), ("/{ns}/image", "/image")]
)
def test_without_a_namespace_names_begin_at_the_root(
    derived: Callable[[str], Architecture], written: str, name: str
) -> None:
    assert resolve_ros_name(written, derived("nodes: {camera: {}}").nodes["camera"]) == name


def test_a_port_without_a_topic_is_called_by_its_path() -> None:
    assert default_port_name("sensing.camera.image") == "/sensing/camera/image"


def test_topics_that_everybody_may_use() -> None:
    shared = shared_topic_names(("joint_states", "/odom"))
    assert {"/joint_states", "/odom", "/tf", "/clock"} <= shared
    assert "joint_states" not in shared
