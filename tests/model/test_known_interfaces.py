"""The three answers about a message, and the guess at what a wrong name meant."""

from __future__ import annotations

import pytest

from archgen.model.known_interfaces import Interfaces, InterfaceStatus

HELD = Interfaces(
    "jazzy",
    names=frozenset(
        {
            "nav2_msgs/action/NavigateToPose",
            "nav2_msgs/msg/Costmap",
            "nav2_msgs/srv/LoadMap",
            "sensor_msgs/msg/Image",
            "sensor_msgs/msg/PointCloud2",
            "geometry_msgs/msg/Pose",
            "vision_msgs/msg/Point2D",
            "std_srvs/srv/Trigger",
        }
    ),
    complete_packages=frozenset({"nav2_msgs", "std_srvs", "vision_msgs"}),
)


@pytest.mark.parametrize(
    ("message", "answer"),
    [
        ("sensor_msgs/msg/Image", "known"),
        ("nav2_msgs/msg/Costmop", "wrong"),
        ("nav2_msgs/srv/Costmap", "wrong"),
        ("sensor_msgs/msg/Imgae", "not held"),
        ("demo_msgs/msg/Grasp", "not held"),
        ("nav2_msgs/action/NavigateToPose_FeedbackMessage", "known"),
        ("nav2_msgs/action/NavigateToPose_SendGoal_Request", "known"),
        ("nav2_msgs/action/NavigateToPoses_Goal", "wrong"),
        ("std_srvs/srv/Trigger_Request", "known"),
        ("nav2_msgs/msg/Costmap_Request", "wrong"),
    ],
)
def test_answers(message: str, answer: InterfaceStatus) -> None:
    assert HELD.status_of(message) == answer


def test_ros_1_appends_nothing() -> None:
    noetic = Interfaces("noetic", frozenset({"std_srvs/srv/Trigger"}), frozenset({"std_srvs"}))
    assert noetic.status_of("std_srvs/srv/Trigger_Request") == "wrong"


@pytest.mark.parametrize(
    ("message", "guess"),
    [
        ("sensor_msgs/msg/Imgae", "sensor_msgs/msg/Image"),
        ("sensor_msgs/msg/pointcloud2", "sensor_msgs/msg/PointCloud2"),
        ("std_srvs/msg/Trigger", "std_srvs/srv/Trigger"),
        ("nav2_msgs/msg/NavigateToPose", "nav2_msgs/action/NavigateToPose"),
        ("sensor_msg/msg/Image", "sensor_msgs/msg/Image"),
        ("nav_msgs/msg/Pose", "geometry_msgs/msg/Pose"),
        ("nav2_msgs/msg/Zebra", None),
        ("demo_msgs/msg/Zebra", None),
    ],
)
def test_nearest(message: str, guess: str | None) -> None:
    assert HELD.find_nearest(message) == guess


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sensor_msgs::msg::Image", "sensor_msgs/msg/Image"),
        ("sensor_msgs.msg.Image", "sensor_msgs/msg/Image"),
        ("nav2_msgs/costmap", "nav2_msgs/msg/Costmap"),
        ("nav2_msgs/msg/costmap", "nav2_msgs/msg/Costmap"),
        ("std_srvs/trigger", "std_srvs/srv/Trigger"),
        ("Image/Depth", None),
        ("/Image", None),
        ("v1.2", None),
        ("camera picture", None),
        ("a/b/c/d", None),
        ("nav2_msgs/thing/Costmap", None),
        ("nav2_msgs/", None),
    ],
)
def test_a_message_in_another_spelling(text: str, message: str | None) -> None:
    assert HELD.read_message(text) == message


def test_several_namesakes_are_no_guess_unless_one_package_is_close() -> None:
    held = Interfaces(names=frozenset({"vision_msgs/msg/Point", "geometry_msgs/msg/Point"}))
    assert held.find_nearest("foo/msg/Point") is None
    assert held.find_nearest("geometri_msgs/msg/Point") == "geometry_msgs/msg/Point"
