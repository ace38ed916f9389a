"""Controllers of ros2_control are nodes in the process of their manager: by what spawners and commands load, and the manager's file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.plugins.ros.workspace.test_workspace_import import write_workspace

LAUNCH = """
    from launch import LaunchDescription
    from launch.actions import ExecuteProcess
    from launch_ros.actions import Node
    from ament_index_python.packages import get_package_share_directory

    def generate_launch_description():
        file = get_package_share_directory("arm") + "/config/controllers.yaml"
        return LaunchDescription([
            Node(package="controller_manager", executable="ros2_control_node", namespace="left", parameters=[file],
                 remappings=[("wheels/odom", "/odom"), ("lifter/odom", "/other"), ("joint_states", "/joints")]),
            Node(package="controller_manager", executable="spawner", namespace="left",
                 arguments=["wheels", "states", "--controller-manager-timeout", "10", "--inactive",
                            "--controller-ros-args", "-r wheels/cmd_vel_unstamped:=/drive"]),
            Node(package="controller_manager", executable="spawner", name="again",
                 arguments=["states", "-c", "/left/controller_manager", "--ros-args", "--log-level", "warn"]),
            Node(package="controller_manager", executable="spawner", arguments=["nobody"]),
            ExecuteProcess(cmd=["ros2", "control", "load_controller", "-c", "/left/controller_manager", "lifter", "strange"]),
        ])
"""
CONTROLLERS = """
    /left/controller_manager:
      ros__parameters:
        wheels: {type: diff_drive_controller/DiffDriveController}
        states: {type: joint_state_broadcaster/JointStateBroadcaster}
        lifter: {type: arm/Lifter}
        strange: {type: far_away/Strange}
    /left/wheels:
      ros__parameters: {use_stamped_vel: false, wheel_radius: 0.1, left_wheel_names: [l], right_wheel_names: [r], wheel_separation: 0.3}
    /left/lifter:
      ros__parameters: {goal: up}
"""
LIFTER = """
    #include <controller_interface/controller_interface.hpp>
    namespace arm {
    class Lifter : public controller_interface::ControllerInterface {
    public:
      CallbackReturn on_configure(const rclcpp_lifecycle::State &) override {
        goal_ = get_node()->create_subscription<std_msgs::msg::Float64>("~/" + get_node()->get_parameter("goal").as_string(), 1, take);
        return CallbackReturn::SUCCESS;
      }
    };
    }
    PLUGINLIB_EXPORT_CLASS(arm::Lifter, controller_interface::ControllerInterface)
"""


@pytest.fixture
def robot(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> Path:
    pytest.importorskip("tree_sitter_cpp")
    monkeypatch.chdir(tmp_path)
    files = {
        "launch/arm.launch.py": LAUNCH,
        "config/controllers.yaml": CONTROLLERS,
        "src/lifter.cpp": LIFTER,
        "CMakeLists.txt": "project(arm)\nadd_library(arm SHARED src/lifter.cpp)\n",
    }
    write_workspace(Path("src"), {f"arm/{name}": text for name, text in files.items()})
    done = run("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    return Path("robot")


@pytest.mark.parametrize(
    ("name", "endpoints"),
    [
        (
            "wheels",
            [
                "publishes /odom (nav_msgs/msg/Odometry)",
                "publishes /tf (tf2_msgs/msg/TFMessage)",
                "subscribes to /drive (geometry_msgs/msg/Twist)",
            ],
        ),
        ("states", ["publishes /joints (sensor_msgs/msg/JointState)"]),
        ("lifter", ["subscribes to /left/lifter/up (std_msgs/msg/Float64)"]),
        ("strange", []),
    ],
)
@pytest.mark.usefixtures("robot")
def test_a_controller_is_a_node(name: str, endpoints: list[str], run: Run) -> None:
    shown = run("show", "-C", "robot", name).out
    assert f"ROS name:       /left/{name}" in shown
    assert re.findall(r"(?:publishes|subscribes to) .*\)", shown) == endpoints


def test_each_controller_is_there_once(robot: Path, run: Run) -> None:
    """A manager that nothing here starts loads nothing that anybody knows; remaps stand at whom they are for."""
    text = (robot / "robot.yaml").read_text(encoding="utf-8")
    loaded = re.findall(r"^  (\w+):  # .*in the process of /left/controller_manager", text, re.MULTILINE)
    assert loaded == ["wheels", "states", "lifter", "strange"]
    assert "nobody:" not in text
    names = re.findall(r"/\S*spawner\S*|/again", run("list", "-C", "robot", "--of", "nodes").out)
    assert names == ["/left/spawner_wheels", "/again", "/spawner_nobody"]
    assert text.count("wheels/odom: /odom") == 2  # at the process and at the controller
    checked = run("check", "robot")
    assert (checked.status, "warning" in checked.out) == (0, False), checked.out
