"""What bridges of Gazebo and its spawner say to ROS, by their arguments and files."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_entities import LaunchedNode
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_import import load_noted
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.workspace.workspace_import import read_gazebo_program
from tests.cli.conftest import Run
from tests.plugins.ros.workspace.test_workspace_import import write_workspace


def test_other_programs_and_those_that_are_told_nothing_are_left_alone(tmp_path: Path) -> None:
    run = LaunchRun(LaunchFiles([tmp_path]), load_noted)
    words = ["@" * 100_000, "/a@b/C", "/a@b/C[", "x" * 100_000 + "@", "-topic"]
    node = LaunchedNode("node", "Node", Span.of_file("a"), "a", arguments=words)
    assert read_gazebo_program(node, "gz_bridge", run) is None
    assert read_gazebo_program(node, "gz_spawner", run) is None
    assert read_gazebo_program(node, "ekf", run) is None


def test_topics_of_bridges_to_gazebo_are_those_of_their_arguments_and_files(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a bridge hands on stands in its arguments, or in its file; a broken file costs nothing but itself."""
    monkeypatch.chdir(tmp_path)
    launch = """
        import os
        from ament_index_python.packages import get_package_share_directory
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            config = os.path.join(get_package_share_directory("my_sim"), "config", "bridge.yaml")
            broken = os.path.join(get_package_share_directory("my_sim"), "config", "broken.yaml")
            return LaunchDescription([
                Node(package="ros_gz_bridge", executable="parameter_bridge", name="one", namespace="sim",
                     arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock", "scan@sensor_msgs/LaserScan[gz.msgs.LaserScan",
                                "/cmd@geometry_msgs/msg/Twist]gz.msgs.Twist", "/both@std_msgs/msg/String@gz.msgs.StringMsg",
                                "/world/w/control@ros_gz_interfaces/srv/ControlWorld", "nonsense", "@@",
                                "--ros-args", "-p", "a@b/C[d:=1"],
                     remappings=[("scan", "/scan")]),
                Node(package="ros_gz_bridge", executable="parameter_bridge", name="two",
                     parameters=[{"config_file": config}]),
                Node(package="ros_gz_bridge", executable="parameter_bridge", name="three",
                     parameters=[{"config_file": broken}]),
                Node(package="ros_gz_image", executable="image_bridge", name="images", arguments=["camera/image"]),
                Node(package="ros_gz_sim", executable="create", arguments=["-name", "r", "-topic", "robot_description"]),
            ])
    """
    bridge = """
        ---
        # a camera
        - ros_topic_name: camera/points
          gz_topic_name: points
          ros_type_name: sensor_msgs/msg/PointCloud2
          gz_type_name: gz.msgs.PointCloudPacked
          direction: GZ_TO_ROS
        - {topic_name: /cmd_vel, ros_type_name: geometry_msgs/msg/Twist, direction: ROS_TO_GZ}
        - {gz_topic_name: /odd, ros_type_name: std_msgs/msg/Bool, direction: SIDEWAYS}
        - text
    """
    files = {"launch/sim.launch.py": launch, "config/bridge.yaml": bridge, "config/broken.yaml": "{ [ a: -"}
    write_workspace(Path("src"), {f"my_sim/{name}": text for name, text in files.items()})
    done = run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot")
    assert done.status == 0, done.err
    architecture = check_project(Path("robot")).architecture
    ends = [each for each in architecture.endpoints if each.medium == "ros"]
    assert {(each.node, each.use, each.name, each.message) for each in ends} == {
        ("one", "publishes", "/clock", "rosgraph_msgs/msg/Clock"),
        ("one", "publishes", "/scan", "sensor_msgs/msg/LaserScan"),
        ("one", "subscribes", "/cmd", "geometry_msgs/msg/Twist"),
        ("one", "publishes", "/both", "std_msgs/msg/String"),
        ("one", "subscribes", "/both", "std_msgs/msg/String"),
        ("one", "serves", "/world/w/control", "ros_gz_interfaces/srv/ControlWorld"),
        ("two", "publishes", "/camera/points", "sensor_msgs/msg/PointCloud2"),
        ("two", "subscribes", "/cmd_vel", "geometry_msgs/msg/Twist"),
        ("images", "publishes", "/camera/image", "sensor_msgs/msg/Image"),
        ("create", "subscribes", "/robot_description", "std_msgs/msg/String"),
    }
    assert "is: ros.gz_bridge" in Path("robot/robot.yaml").read_text(), (
        "of the one whose file is broken nothing is known"
    )
