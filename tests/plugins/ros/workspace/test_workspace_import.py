"""`archgen import workspace`: launch files, packages, sources and the library that ships become one architecture."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import dedent

import pytest

from tests.cli.conftest import Run

MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>x</description>
<license>MIT</license><buildtool_depend>{tool}</buildtool_depend><export><build_type>{tool}</build_type></export></package>
"""
BRINGUP = """
    from launch import LaunchDescription
    from launch.actions import DeclareLaunchArgument
    from launch.conditions import IfCondition
    from launch.substitutions import EnvironmentVariable, LaunchConfiguration
    from launch_ros.actions import ComposableNodeContainer, Node
    from launch_ros.descriptions import ComposableNode
    from ament_index_python.packages import get_package_share_directory

    def generate_launch_description():
        return LaunchDescription([
            DeclareLaunchArgument("rviz", default_value="false"),
            Node(package="my_driver", executable="driver", name="front_driver", namespace="front",
                 parameters=[get_package_share_directory("my_bringup") + "/config/driver.yaml"],
                 remappings=[("odom", "/odom")]),
            Node(package="robot_localization", executable="ekf_node", name="ekf",
                 parameters=[{"odom0": "/odom"}], remappings=[("odometry/filtered", "odom/filtered")]),
            Node(package="slam_toolbox", executable="async_slam_toolbox_node", name="slam",
                 remappings=[("scan", EnvironmentVariable("MY_SCAN", default_value="scan"))]),
            ComposableNodeContainer(package="rclcpp_components", executable="component_container", name="box",
                namespace="", composable_node_descriptions=[
                    ComposableNode(package="my_filter", plugin="my_filter::Filter", remappings=[("in", "/front/laser")])]),
            Node(package="my_driver", executable="viewer", condition=IfCondition(LaunchConfiguration("rviz"))),
        ])
"""
DRIVER = """
    import rclpy
    from rclpy.node import Node
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan
    from std_srvs.srv import Trigger
    from my_msgs.msg import Bump

    class Driver(Node):
        def __init__(self):
            super().__init__("driver")
            self.declare_parameter("scan_topic", "scan")
            self.create_publisher(LaserScan, self.get_parameter("scan_topic").value, 10)
            self.create_publisher(Odometry, "odom", 10)
            self.create_publisher(Bump, self.find_name(), 10)
            self.create_service(Trigger, "~/reset", self.reset)

        def find_name(self):
            return open("/etc/hostname").read()

    def main():
        rclpy.init()
        rclpy.spin(Driver())
"""
VIEWER = """
    import rclpy
    from nav_msgs.msg import Odometry

    def main():
        node = rclpy.create_node("viewer")
        node.create_subscription(Odometry, "odom/filtered", print, 10)
"""
FILTER = """
    #include <rclcpp/rclcpp.hpp>
    namespace my_filter {
    class Filter : public rclcpp::Node {
    public:
      explicit Filter(const rclcpp::NodeOptions & options) : Node("filter", options) {
        sub_ = create_subscription<sensor_msgs::msg::LaserScan>("in", 10, [this](auto message) {});
        pub_ = create_publisher<sensor_msgs::msg::LaserScan>("/scan", rclcpp::SensorDataQoS());
        client_ = create_client<std_srvs::srv::Trigger>("/front/front_driver/reset");
      }
    };
    }
    RCLCPP_COMPONENTS_REGISTER_NODE(my_filter::Filter)
"""
WORKSPACE = {
    "my_bringup/launch/robot.launch.py": BRINGUP,
    "my_bringup/config/driver.yaml": "/front/front_driver:\n  ros__parameters: {scan_topic: laser, speed: 3}\n",
    "my_driver/setup.py": """
        from setuptools import setup
        setup(entry_points={"console_scripts": ["driver = my_driver.driver:main", "viewer = my_driver.viewer:main"]})
    """,
    "my_driver/my_driver/__init__.py": "",
    "my_driver/my_driver/driver.py": DRIVER,
    "my_driver/my_driver/viewer.py": VIEWER,
    "my_filter/CMakeLists.txt": """
        project(my_filter)
        set(SOURCES src/filter.cpp)
        add_library(filter SHARED ${SOURCES})
        rclcpp_components_register_node(filter PLUGIN "my_filter::Filter" EXECUTABLE filter_node)
    """,
    "my_filter/src/filter.cpp": FILTER,
    "my_msgs/msg/Bump.msg": "bool hit\n",
}


def write_workspace(folder: Path, files: dict[str, str], tool: str = "ament_cmake") -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text).lstrip("\n"), encoding="utf-8")
        manifest = folder / name.partition("/")[0] / "package.xml"
        manifest.write_text(MANIFEST.format(name=name.partition("/")[0], tool=tool), encoding="utf-8")


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    pytest.importorskip("tree_sitter_cpp")
    monkeypatch.chdir(tmp_path)
    write_workspace(tmp_path / "src", WORKSPACE)
    return tmp_path


ROBOT = """\
# From src by `archgen import workspace`; with --merge it is brought up to date.
groups:
  robot:
    components:
      front_driver:
        outputs:
          laser: sensor_msgs/msg/LaserScan
          odom: nav_msgs/msg/Odometry
          bump: my_msgs/msg/Bump  # name unknown: `open("/etc/hostname").read()`, my_driver/my_driver/driver.py:18
          reset: std_srvs/srv/Trigger
      ekf:
        is: ros.ekf
        inputs: {odom0: front_driver.odom}
      slam:
        is: ros.slam_toolbox
        inputs: {scan: filter.scan}
      filter:
        inputs: {in: front_driver.laser, reset: front_driver.reset}
        outputs: {scan: sensor_msgs/msg/LaserScan}
containers:
"""


@pytest.mark.usefixtures("workspace")
def test_workspace_of_ros_2(run: Run) -> None:
    """A component for each node, wired by topics after parameters, remaps and namespaces; what is computed is said."""
    done = run("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    assert done.out.startswith(
        "taken: 4 connection, 8 endpoint, 1 endpoint without a name, 1 message, 5 node, 2 node of the library, 3 node with sources, 1 variant\n"
        '  noted: my_driver/my_driver/driver.py:18:16: name: the name of what it publishes is computed: `open("/etc/hostname").read()`\n'
    )
    text = Path("robot/robot.yaml").read_text(encoding="utf-8")
    assert text.startswith(ROBOT)
    assert (
        "    implements: robot.front_driver\n    namespace: /front\n    package: my_driver\n    executable: driver\n"
        "    status: existing\n    remaps:\n      odom: /odom\n    parameter_files:\n"
        "      - $(find-pkg-share my_bringup)/config/driver.yaml\n    parameters:\n      scan_topic: laser\n"
        "    publishes: {laser: {own_name: scan, named_by: scan_topic}, odom: {own_name: odom}, bump: {}}\n"
        '    serves: {reset: "~/reset"}\n'
    ) in text
    shown = run("show", "-C", "robot", "filter").out
    assert "subscribes to /front/laser (sensor_msgs/msg/LaserScan)" in shown
    assert "calls /front/front_driver/reset (std_srvs/srv/Trigger)" in shown
    checked = run("check", "robot")
    assert checked.status == 0
    assert "0 warnings" in checked.out or "warning" not in checked.out, checked.out
    again = run("import", "workspace", "src", "--distro", "humble", "-o", "robot", "--merge")
    assert "robot.yaml: as before" in again.out


def test_what_people_moved_and_renamed_is_followed_when_the_robot_changes(workspace: Path, run: Run) -> None:
    """R3: a second import brings in what changed, where people have it by now."""
    options = ("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert run(*options).status == 0
    slice_file = Path("robot/robot.yaml")
    text = slice_file.read_text(encoding="utf-8")
    place = text.index("      front_driver:\n")
    end = re.compile(r"\n {6}\w").search(text, place + 8)
    assert end is not None
    component = text[place : end.start() + 1].replace("front_driver:", "base:  # ours")
    text = text.replace(text[place : end.start() + 1], "").replace("robot.front_driver", "front.base")
    text = re.sub(r"(from: |: |\[)front_driver\.", r"\1front.base.", text)
    text = text.replace("groups:\n", f"groups:\n  front:\n    components:\n{component}", 1)
    slice_file.write_text(text.replace("  front_driver:\n", "  first:\n    name: front_driver\n"), encoding="utf-8")
    edited = slice_file.read_text(encoding="utf-8")
    assert run("check", "robot").status == 0
    assert run(*options, "--check").status == 0
    launch = workspace / "src/my_bringup/launch/robot.launch.py"
    launch.write_text(launch.read_text().replace('remappings=[("odom", "/odom")]', 'remappings=[("odom", "/ground")]'))
    done = run(*options, "--merge")
    assert done.status == 0, done.err
    assert "  changed: nodes.first.remaps.odom: from `/odom` to `/ground`\n" in done.out
    changed = slice_file.read_text(encoding="utf-8")
    assert changed.count("front_driver") == edited.count("front_driver")
    assert "  first:\n    name: front_driver\n" in changed
    assert run("check", "robot").status == 0


@pytest.mark.usefixtures("workspace")
def test_nodes_off_by_default_are_variants(run: Run) -> None:
    """R14: what runs only by an argument stands in a variant, with its wiring; the project itself is what is launched."""
    assert run("import", "workspace", "src", "--distro", "humble", "-o", "robot").status == 0
    assert "viewer" not in run("list", "-C", "robot", "--of", "nodes").out
    shown = run("show", "-C", "robot", "--variant", "rviz", "viewer").out
    assert "odom <- robot.ekf.odometry_filtered" in shown or "filtered <- robot.ekf.odometry_filtered" in shown
    assert run("check", "robot").status == 0
    done = run("import", "workspace", "src", "rviz:=true", "--distro", "humble", "-o", "other")
    assert "6 node" not in done.out
    assert "viewer" in run("list", "-C", "other", "--of", "nodes").out


@pytest.mark.usefixtures("workspace")
def test_environment_is_given(run: Run) -> None:
    """R9: variables of the environment are what `--env` says; what is none is refused."""
    done = run("import", "workspace", "src", "--distro", "humble", "--env", "MY_SCAN=/other", "-o", "robot")
    assert done.status == 0, done.err
    assert "scan: {external: Nobody here publishes /other}" in Path("robot/robot.yaml").read_text()
    assert "`MY_SCAN` is no variable" in run("import", "workspace", "src", "--env", "MY_SCAN", "-o", "x").err
    assert "--launch does not go with package" in run("import", "package", "src", "--launch", "a/b", "-o", "x").err


def test_several_launch_files_are_other_robots(workspace: Path, run: Run) -> None:
    """R6: which launch file starts the robot is asked where several do; `--launch` says it."""
    launch = workspace / "src/my_driver/launch/driver.launch.xml"
    launch.parent.mkdir()
    launch.write_text('<launch><node pkg="my_driver" exec="driver"/></launch>')
    done = run("import", "workspace", "src", "-o", "robot")
    assert done.status == 1
    assert "2 launch files start nodes, and none of them includes the others" in done.err
    assert (
        "`--launch`, likeliest first: my_bringup/launch/robot.launch.py (6 nodes), my_driver/launch/driver.launch.xml (1 nodes)"
        in done.err
    )
    assert not Path("robot").exists()
    done = run("import", "workspace", "src", "--launch", "my_driver/driver.launch.xml", "-o", "robot")
    assert done.status == 0, done.err
    # What the program calls itself where the launch file names nothing (R8).
    assert "ROS name:       /driver" in run("show", "-C", "robot", "driver").out
    done = run("import", "workspace", "src", "--launch", "my_driver/none.launch.xml", "-o", "robot")
    assert "there is no such launch file in the workspace" in done.err


def test_what_one_of_several_launch_files_starts_is_a_variant(workspace: Path, run: Run) -> None:
    """What all start is the project itself; each launch file is a variant with what it adds."""
    launch = workspace / "src/my_driver/launch/lab.launch.xml"
    launch.parent.mkdir()
    launch.write_text(
        '<launch><node pkg="robot_localization" exec="ekf_node" name="ekf"/><node pkg="my_driver" exec="viewer" name="eye"/></launch>'
    )
    files = ("my_bringup/robot.launch.py", "my_driver/lab.launch.xml")
    options = [word for file in files for word in ("--launch", file)]
    done = run("import", "workspace", "src", *options, "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    assert [line.split()[0] for line in run("list", "-C", "robot", "--of", "nodes").out.splitlines()[1:2]] == ["ekf"]
    assert "eye" in run("list", "-C", "robot", "--variant", "lab", "--of", "nodes").out
    assert "front_driver" in run("list", "-C", "robot", "--variant", "robot", "--of", "nodes").out
    titles = re.findall(r"title: (.*)", Path("robot/robot.yaml").read_text(encoding="utf-8"))
    assert [title.rpartition("/")[2] for title in titles] == [
        "robot.launch.py",
        "Launched if $(var rviz)",
        "lab.launch.xml",
    ]
    assert run("check", "robot").status == 0


@pytest.mark.usefixtures("workspace")
def test_without_a_launch_file_each_program_is_taken_once(run: Run) -> None:
    done = run("import", "workspace", "src", "--launch", "none", "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    assert "ROS name:       /driver" in run("show", "-C", "robot", "driver").out
    text = Path("robot/robot.yaml").read_text(encoding="utf-8")
    assert (
        "    package: my_driver\n    executable: driver\n    status: existing\n    publishes: {scan: scan, odom: odom, bump: {}}"
        in text
    )
    assert "remaps" not in text


def test_the_list_of_a_lifecycle_manager_is_taken_from_its_file(workspace: Path, run: Run) -> None:
    package = workspace / "src/my_bringup"
    (package / "config/nav.yaml").write_text(
        "manager: {ros__parameters: {autostart: true, node_names: [map_server], bond_timeout: 4.0}}\n"
    )
    launch = package / "launch/nav.launch.xml"
    file = '<param from="$(find-pkg-share my_bringup)/config/nav.yaml"/>'
    launch.write_text(
        f'<launch><node pkg="nav2_lifecycle_manager" exec="lifecycle_manager" name="manager">{file}</node>'
        '<node pkg="nav2_map_server" exec="map_server" name="map_server"/></launch>'
    )
    done = run(
        "import", "workspace", "src", "--launch", "my_bringup/nav.launch.xml", "--distro", "humble", "-o", "robot"
    )
    assert done.status == 0, done.err
    text = Path("robot/robot.yaml").read_text(encoding="utf-8")
    assert "    parameters:\n      autostart: true\n      node_names:\n        - map_server\n" in text
    assert "bond_timeout" not in text
    assert "silent-node" not in run("check", "robot").out


@pytest.mark.usefixtures("workspace")
def test_without_the_extra_cpp_is_unread_and_said(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("archgen.plugins.ros.sources.source_index.make_cpp_parser", lambda: None)
    done = run("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert done.status == 0
    assert "sources in C++ are not read, those of `my_filter::Filter` for one" in done.out
    assert "= help: `pip install 'archgen[sources]'` installs what reads them" in done.out
    assert (
        "  filter:  # what it says to ROS is not known: no sources, no type of the library"
        in Path("robot/robot.yaml").read_text()
    )


ROS_1 = {
    "my_base/launch/base.launch": """
        <launch>
          <group ns="front">
            <node pkg="my_base" type="drive.py" name="drive"><remap from="cmd_vel" to="/cmd_vel"/><param name="topic" value="speed"/></node>
            <node pkg="my_base" type="motor" name="motor"/>
          </group>
        </launch>
    """,
    "my_base/scripts/drive.py": """
        #!/usr/bin/env python
        import rospy
        from geometry_msgs.msg import Twist
        rospy.init_node("any")
        rospy.Subscriber("cmd_vel", Twist, print)
        pub = rospy.Publisher(rospy.get_param("~topic", "none"), Twist, queue_size=1)
    """,
    "my_base/CMakeLists.txt": """
        project(my_base)
        file(GLOB SRC src/*.cpp)
        foreach(name motor)
          add_executable(${name} ${SRC})
        endforeach()
        catkin_install_python(PROGRAMS scripts/drive.py DESTINATION bin)
    """,
    "my_base/src/motor.cpp": """
        #include <ros/ros.h>
        void drive(const geometry_msgs::TwistConstPtr& message) {}
        int main(int argc, char** argv) {
          ros::init(argc, argv, "any");
          ros::NodeHandle handle;
          ros::NodeHandle own("~");
          ros::Subscriber sub = handle.subscribe("speed", 1, drive);
          ros::Publisher pub = own.advertise<std_msgs::Float64>("current", 1);
          ros::spin();
        }
    """,
}


def test_workspace_of_ros_1(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("tree_sitter_cpp")
    monkeypatch.chdir(tmp_path)
    write_workspace(tmp_path / "src", ROS_1, "catkin")
    done = run("import", "workspace", "src", "-o", "robot")
    assert done.status == 0, done.err
    assert "distro: noetic" in Path("robot/archgen.yaml").read_text()
    drive, motor = (run("show", "-C", "robot", name).out for name in ("drive", "motor"))
    assert (
        "publishes /front/speed (geometry_msgs/Twist)" in drive
        or "publishes /front/speed (geometry_msgs/msg/Twist)" in drive
    )
    assert "subscribes to /cmd_vel" in drive
    assert "publishes /front/motor/current" in motor
    assert "speed <- robot.drive.speed" in motor
    assert run("check", "robot").status == 0


def test_nothing_outside_of_the_workspace_is_read(workspace: Path, run: Run) -> None:
    """Symbolic links, ignored and broken packages, two of one name, sources that do not parse: said, and the rest is read."""
    secret = workspace / "secret.py"
    secret.write_text("import rclpy\nrclpy.create_node('stolen').create_publisher(None, 'secret', 1)\n")
    driver = workspace / "src/my_driver/my_driver/driver.py"
    driver.unlink()
    driver.symlink_to(secret)
    (workspace / "src/my_driver/my_driver/viewer.py").write_text("def main(:\n")
    (workspace / "src/broken").mkdir()
    (workspace / "src/broken/package.xml").write_text("<package>")
    write_workspace(workspace / "src/old", {"my_filter/src/a.cpp": "int x;"})
    ignored = workspace / "src/ignored"
    write_workspace(ignored, {"my_other/setup.py": ""})
    (ignored / "COLCON_IGNORE").touch()
    done = run("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    assert "secret" not in Path("robot/robot.yaml").read_text() + done.out
    assert "the sources of the program `driver` of `my_driver` were not found" in done.out
    assert "my_driver/my_driver/viewer.py:1:10: sources: it is not read: invalid syntax" in done.out
    assert "not taken: broken/package.xml:1:" in done.out
    assert (
        "old/my_filter/package.xml:1:1: package.xml: there is another package `my_filter`, my_filter/package.xml: that one counts"
        in done.out
    )
    assert "there is no package.xml in it" in run("import", "workspace", "robot", "-o", "x").err
    assert "it is no folder" in run("import", "workspace", "secret.py", "-o", "x").err


@pytest.mark.usefixtures("workspace")
def test_a_computed_remap_leaves_the_name_unknown(run: Run) -> None:
    """A name that a remap gives away, nobody knows to what, is not the one that the program says."""
    launch = Path("src/my_bringup/launch/robot.launch.py")
    launch.write_text(launch.read_text().replace('("odom", "/odom")', '("odom", open("/x").read())'))
    assert run("import", "workspace", "src", "--distro", "humble", "-o", "robot").status == 0
    text = Path("robot/robot.yaml").read_text()
    assert (
        "odometry: nav_msgs/msg/Odometry  # name unknown: `a computed remap of odom`, my_bringup/launch/robot.launch.py:"
        in text
    )
    assert "odometry: {}" in text
