"""Dumps of ROS 2 and ROS 1 as what was observed: names, types, places, quality of service, how often nodes run."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.robot_observation import ObservationOptions
from archgen.plugins.ros.running_graph.graph_observation import observe_graph
from tests.plugins.ros.running_graph.test_graph_import import ROS_2

ROS_1 = """\
Node [/lidar]
Publications:
 * /scan [sensor_msgs/LaserScan]
 * /rosout [rosgraph_msgs/Log]
Subscriptions: None
Services:
 * /lidar/reset
$ rosservice info /lidar/reset
Type: std_srvs/Empty
$ rosparam dump
lidar: {frame: laser, filter: {low: 1}}
"""


def test_a_dump_of_ros_2(tmp_path: Path) -> None:
    file = tmp_path / "graph.txt"
    file.write_text(f"{ROS_2}\n$ ros2 node list\n/planner\n/planner\n$ ros2 node list\n/planner\n", encoding="utf-8")
    robot = observe_graph(file, ObservationOptions())
    assert robot is not None
    assert (robot.kind, robot.unseen_uses, robot.has_all_parameters) == ("graph", frozenset(), True)
    assert {node.full_name: node.count for node in robot.nodes}["/planner"] == 2
    driver = next(node for node in robot.nodes if node.full_name == "/front/driver")
    assert driver.parameters == {"frame": "laser", "filter.angles": [1.0, 2.5]}
    scan = next(each for each in robot.endpoints if each.name == "/front/scan" and each.use == "publishes")
    assert (scan.node, scan.flow, scan.message) == ("/front/driver", "topic", "sensor_msgs/msg/LaserScan")
    assert scan.qos["reliability"] == "best_effort"
    assert "depth" not in scan.qos
    line = ROS_2.splitlines()[scan.at.line - 1]
    assert line == "    /front/scan: sensor_msgs/msg/LaserScan"
    drive = next(each for each in robot.endpoints if each.name == "/drive")
    assert (drive.use, drive.flow) == ("serves", "action")


def test_durations_on_the_wire(tmp_path: Path) -> None:
    """An end that has none says so by a number, or a word; what a dump does not say is not known."""
    file = tmp_path / "graph.txt"
    head = "$ ros2 topic info -v /a\nNode name: n\nNode namespace: /\nTopic type: std_msgs/msg/String\nEndpoint type: PUBLISHER\nQoS profile:\n"
    policies = "  Deadline: 100000000 nanoseconds\n  Lifespan: 9223372036854775807 nanoseconds\n  Liveliness lease duration: Infinite\n"
    file.write_text(head + policies, encoding="utf-8")
    robot = observe_graph(file, ObservationOptions())
    assert robot is not None
    qos = robot.endpoints[0].qos
    assert (qos["deadline"].value, qos["lifespan"], qos["lease_duration"]) == (Fraction(100_000_000), None, None)
    assert "reliability" not in qos


def test_a_dump_of_ros_1(tmp_path: Path) -> None:
    file = tmp_path / "graph.txt"
    file.write_text(ROS_1, encoding="utf-8")
    robot = observe_graph(file, ObservationOptions())
    assert robot is not None
    assert (robot.unseen_uses, robot.has_all_parameters) == ({"calls"}, False)
    assert robot.nodes[0].parameters == {"frame": "laser", "filter.low": 1}
    shown = {(each.use, each.flow, each.name, each.message) for each in robot.endpoints}
    assert ("publishes", "topic", "/scan", "sensor_msgs/msg/LaserScan") in shown
    assert ("serves", "service", "/lidar/reset", "std_srvs/srv/Empty") in shown


def test_what_is_no_dump(tmp_path: Path) -> None:
    (tmp_path / "empty").write_text("hello\n", encoding="utf-8")
    (tmp_path / "binary").write_bytes(b"\0")
    with pytest.raises(ForeignFileError, match="there is no node in it"):
        observe_graph(tmp_path / "empty", ObservationOptions())
    assert observe_graph(tmp_path / "binary", ObservationOptions()) is None
    assert observe_graph(tmp_path, ObservationOptions()) is None
