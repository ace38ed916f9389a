"""What RViz reads and sends, by the displays and tools of its configuration."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.plugins.ros.workspace.test_workspace_import import write_workspace

ROS_2 = """
    Visualization Manager:
      Displays:
        - {Class: rviz_default_plugins/LaserScan, Enabled: true, Topic: {Value: /scan}}
        - {Class: rviz_default_plugins/LaserScan, Enabled: true, Topic: {Value: /scan}}
        - {Class: rviz_default_plugins/Path, Enabled: false, Topic: {Value: /hidden}}
        - {Class: rviz_default_plugins/TF, Enabled: true}
        - Class: rviz_common/Group
          Enabled: true
          Displays:
            - {Class: rviz_default_plugins/Map, Enabled: true, Topic: {Value: map}, Update Topic: {Value: map_updates}}
            - {Class: rviz_default_plugins/Camera, Enabled: true, Topic: {Value: /front/image}}
        - {Class: rviz_default_plugins/Image, Enabled: true, Topic: {Value: /rear/compressed}}
        - {Class: rviz_default_plugins/RobotModel, Enabled: true, Description Source: File, Description Topic: {Value: /robot_description}}
        - {Class: my_plugins/Strange, Enabled: true, Topic: {Value: /strange}}
        - {Class: rviz_default_plugins/Grid, Enabled: true}
        - 5
      Tools:
        - {Class: rviz_default_plugins/SetGoal, Topic: {Value: /goal_pose}}
        - {Class: rviz_default_plugins/Interact}
"""
ROS_1 = """
    Visualization Manager:
      Displays:
        - {Class: rviz/MarkerArray, Enabled: true, Marker Topic: /marks}
        - {Class: rviz/Image, Enabled: true, Image Topic: /front/image}
        - {Class: rviz/Map, Enabled: true, Topic: /map}
        - {Class: rviz/RobotModel, Enabled: true, Robot Description: robot_description}
      Tools: [{Class: rviz/SetInitialPose, Topic: /initialpose}]
"""


@pytest.mark.parametrize(
    ("package", "endpoints"),
    [
        (
            "rviz2",
            [
                "publishes /goal_pose (geometry_msgs/msg/PoseStamped)",
                "subscribes to /front/camera_info (sensor_msgs/msg/CameraInfo)",
                "subscribes to /front/image (sensor_msgs/msg/Image)",
                "subscribes to /left/map (nav_msgs/msg/OccupancyGrid)",
                "subscribes to /left/map_updates (map_msgs/msg/OccupancyGridUpdate)",
                "subscribes to /rear/compressed (sensor_msgs/msg/CompressedImage)",
                "subscribes to /scan (sensor_msgs/msg/LaserScan)",
                "subscribes to /strange (?)",
                "subscribes to /tf (tf2_msgs/msg/TFMessage)",
                "subscribes to /tf_static (tf2_msgs/msg/TFMessage)",
            ],
        ),
        (
            "rviz",
            [
                "publishes /initialpose (geometry_msgs/msg/PoseWithCovarianceStamped)",
                "subscribes to /front/image (sensor_msgs/msg/Image)",
                "subscribes to /map (nav_msgs/msg/OccupancyGrid)",
                "subscribes to /map_updates (map_msgs/msg/OccupancyGridUpdate)",
                "subscribes to /marks (visualization_msgs/msg/MarkerArray)",
            ],
        ),
    ],
)
def test_displays_are_inputs(
    package: str, endpoints: list[str], tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    is_ros_1 = package == "rviz"
    tool, file = ("catkin", ROS_1) if is_ros_1 else ("ament_cmake", ROS_2)
    find = "find" if is_ros_1 else "find-pkg-share"
    program = "type" if is_ros_1 else "exec"
    names = 'ns="left"' if is_ros_1 else 'namespace="left"'
    launch = f'<launch><node pkg="{package}" {program}="{package}" name="view" {names} args="-d $({find} see)/see.rviz"/></launch>'
    files = {"see/launch/see.launch" + ("" if is_ros_1 else ".xml"): launch, "see/see.rviz": file}
    write_workspace(Path("src"), files, tool)
    distro = [] if is_ros_1 else ["--distro", "jazzy"]
    done = run("import", "workspace", "src", *distro, "-o", "robot")
    assert done.status == 0, done.err
    shown = run("show", "-C", "robot", "view").out
    assert sorted(re.findall(r"(?:publishes|subscribes to) .*\)", shown)) == endpoints
    assert run("check", "robot").status == 0


def test_without_its_file_it_is_the_librarys(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    launch = '<launch><node pkg="rviz2" exec="rviz2" args="-d /elsewhere.rviz"/></launch>'
    write_workspace(Path("src"), {"see/launch/see.launch.xml": launch})
    assert run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot").status == 0
    assert "is: ros.rviz" in Path("robot/robot.yaml").read_text(encoding="utf-8")
