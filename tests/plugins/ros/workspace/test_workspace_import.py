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


def test_a_variant_stops_what_runs_only_without_it(workspace: Path, run: Run) -> None:
    """One program, started in one way if an argument is true and in another unless it is; what the library cannot say stays open."""
    launch = workspace / "src/my_driver/launch/two.launch.xml"
    launch.parent.mkdir()
    launch.write_text(
        """<launch><arg name="fuse" default="false"/>
        <node pkg="my_driver" exec="driver" name="plain" unless="$(var fuse)"/>
        <node pkg="my_driver" exec="driver" name="fused" if="$(var fuse)"/>
        <node pkg="topic_tools" exec="relay" name="relay" args="a b"/>
        <node pkg="robot_state_publisher" exec="robot_state_publisher" name="states" args="robot.urdf"/></launch>"""
    )
    done = run(
        "import", "workspace", "src", "--launch", "my_driver/two.launch.xml", "--distro", "humble", "-o", "robot"
    )
    assert done.status == 0, done.err

    def list_nodes(*words: str) -> set[str]:
        return {line.split()[0] for line in run("list", "-C", "robot", *words, "--of", "nodes").out.splitlines()[1:]}

    assert list_nodes() - {"nodes"} >= {"plain", "relay", "states"}
    assert "fused" not in list_nodes()
    assert "fused" in list_nodes("--variant", "fuse")
    assert "plain" not in list_nodes("--variant", "fuse")
    assert "is: ros.topic_relay" not in Path("robot/robot.yaml").read_text()
    assert "warning" not in run("check", "robot").out


def test_groups_are_made_by_what_is_asked_for(workspace: Path, run: Run) -> None:
    """What nobody owns, or lies in no namespace, is in a group of its own; a later import leaves people's groups as they are."""
    (workspace / "src/CODEOWNERS").write_text("/my_driver/ @acme/drivers\n", encoding="utf-8")
    expected = {
        "package": {"my_driver", "my_filter", "robot_localization", "slam_toolbox"},
        "codeowners": {"drivers", "others"},
        "namespace": {"front", "others"},
    }
    for way, groups in expected.items():
        done = run("import", "workspace", "src", "--distro", "humble", "--group-by", way, "-o", way)
        assert done.status == 0, done.err
        found = {line.split()[0] for line in run("list", "-C", way, "--of", "groups").out.splitlines()[1:]}
        assert (way, found) == (way, groups)
        assert run("check", way).status == 0
    again = run("import", "workspace", "src", "--distro", "humble", "--merge", "-o", "codeowners")
    assert again.status == 0, again.err
    assert "others" in run("list", "-C", "codeowners", "--of", "groups").out
    assert (
        "--group-by does not go with package" in run("import", "package", "src", "--group-by", "folder", "-o", "x").err
    )


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
        "`--launch`, likeliest first: my_bringup/launch/robot.launch.py (6 nodes), my_driver/launch/driver.launch.xml (1 node)"
        in done.err
    )
    assert not Path("robot").exists()
    done = run("import", "workspace", "src", "--launch", "my_driver/driver.launch.xml", "-o", "robot")
    assert done.status == 0, done.err
    # What the program calls itself where the launch file names nothing (R8).
    assert "ROS name:       /driver" in run("show", "-C", "robot", "driver").out
    done = run("import", "workspace", "src", "--launch", "my_driver/none.launch.xml", "-o", "robot")
    assert "there is no such launch file in the workspace" in done.err


def test_likeliest_is_what_is_called_a_robot_not_several(workspace: Path, run: Run) -> None:
    launch = workspace / "src/my_driver/launch/multirobot.launch.xml"
    launch.parent.mkdir()
    nodes = "".join(f'<node pkg="my_driver" exec="driver" name="n{number}"/>' for number in range(7))
    launch.write_text(f"<launch>{nodes}</launch>")
    said = run("import", "workspace", "src", "-o", "robot").err
    assert "my_bringup/launch/robot.launch.py (6 nodes), my_driver/launch/multirobot.launch.xml (7 nodes)" in said


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
        "  filter:  # its name, and what it says to ROS, are not known: no sources, no type of the library"
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
        foreach(name motor_program)
          add_executable(${name} ${SRC})
          set_target_properties(${name} PROPERTIES OUTPUT_NAME "motor")
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


def test_what_an_input_of_the_library_is_called_may_not_be_known(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From Jazzy on a rectifying node finds `camera_info` beside its images, wherever a remap brings these."""
    monkeypatch.chdir(tmp_path)
    launch = """
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            return LaunchDescription([
                Node(package="image_proc", executable="rectify_node", name="it", remappings=[("image", "front/image_raw")]),
            ])
    """
    write_workspace(Path("src"), {"my_camera/launch/camera.launch.py": launch})
    for distro, told in (("humble", "Nobody here publishes /camera_info"), ("jazzy", "Its name is not known")):
        assert run("import", "workspace", "src", "--distro", distro, "-o", distro).status == 0
        assert f"camera_info: {{external: {told}}}" in Path(f"{distro}/robot.yaml").read_text()
        assert "warning" not in run("check", distro).out


def test_a_workspace_newer_than_its_distribution_defines_its_messages(workspace: Path, run: Run) -> None:
    """As the main line of Nav2: a message that the distribution has not is the workspace's own, one that it has is not written again."""
    for name, text in {
        "nav2_msgs/package.xml": "<package><name>nav2_msgs</name><version>1.0.0</version><description>d</description></package>",
        "nav2_msgs/srv/Later.srv": "int32 a\n---\nbool ok\n",
        "nav2_msgs/msg/Costmap.msg": "std_msgs/Header header\n",
        "later/package.xml": "<package><name>later</name><version>1.0.0</version><description>d</description></package>",
        "later/setup.py": "setup(name='later', entry_points={'console_scripts': ['later = later.node:main']})",
        "later/later/__init__.py": "",
        "later/later/node.py": """
import rclpy
from rclpy.node import Node
from nav2_msgs.msg import Costmap
from nav2_msgs.srv import Later
def main():
    rclpy.init()
    node = Node("later")
    node.create_service(Later, "later", print)
    node.create_publisher(Costmap, "costmap", 10)
    rclpy.spin(node)
""",
        "later/launch/later.launch.xml": '<launch><node pkg="later" exec="later"/></launch>',
    }.items():
        (workspace / "src" / name).parent.mkdir(parents=True, exist_ok=True)
        (workspace / "src" / name).write_text(text)
    done = run("import", "workspace", "src", "--launch", "later/later.launch.xml", "--distro", "humble", "-o", "robot")
    assert done.status == 0, done.err
    text = Path("robot/messages.yaml").read_text(encoding="utf-8")
    assert ("nav2_msgs/srv/Later" in text, "Costmap" in text) == (True, False)
    assert "unknown-message" not in run("check", "robot").out


def test_scripts_of_ros_1_beside_the_modules_are_programs(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Duckietown has them: `rosrun` finds whatever lies in a package."""
    monkeypatch.chdir(tmp_path)
    package = tmp_path / "src/lane"
    (package / "src").mkdir(parents=True)
    (package / "launch").mkdir()
    (package / "package.xml").write_text(
        "<package format='2'><name>lane</name><version>1.0.0</version><description>d</description>"
        "<buildtool_depend>catkin</buildtool_depend></package>"
    )
    (package / "CMakeLists.txt").write_text("find_package(catkin REQUIRED)\ncatkin_package()\n")
    (package / "launch/lane.launch").write_text('<launch><node pkg="lane" type="lane_node.py" name="lane"/></launch>')
    (package / "src/lane_node.py").write_text(
        "import rospy\nfrom std_msgs.msg import String\nif __name__ == '__main__':\n    rospy.init_node('x')\n"
        "    rospy.Publisher('~pose', String, queue_size=1)\n    rospy.spin()\n"
    )
    done = run("import", "workspace", "src", "-o", "robot")
    assert done.status == 0, done.err
    assert "1 node with sources" in done.out
    assert "publishes /lane/pose" in " ".join(run("show", "-C", "robot", "lane").out.split())


SPEED = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool, Int8, Int16, Int32
class Speed(Node):
    def __init__(self):
        super().__init__("speed")
        self.create_publisher(Int8, self.declare_parameter("first", "default_first").value, 10)
        self.create_publisher(Int16, self.declare_parameter("second", "default_second").value, 10)
        self.create_publisher(Int32, "fixed", 10)
        if self.declare_parameter("debug", False).value:
            self.create_publisher(Bool, "debug", 10)
def main():
    rclpy.init()
    rclpy.spin(Speed())
main()
"""


@pytest.mark.parametrize(
    ("parameters", "names"),
    [
        ('[{"first": "a"}]', ["/a", "/default_second", "/fixed"]),
        ('[{"first": "a"}, "/somewhere/else.yaml"]', ["/a", "/fixed", "/debug"]),
        ('[open("/x").read(), {"first": "a"}]', ["/a", "/fixed", "/debug"]),
        ('[{"first": open("/x").read()}]', ["/default_second", "/fixed"]),
        ('[{"first": LaunchConfiguration("not_given")}]', ["/default_second", "/fixed"]),
        ('[{"first": EnvironmentVariable("NOT_GIVEN")}, {"debug": True}]', ["/default_second", "/fixed", "/debug"]),
    ],
)
def test_what_a_parameter_names_is_unknown_where_its_value_is(
    parameters: str, names: list[str], tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The program's own default is not taken for the value of a file that nobody can read, nor of an argument without one."""
    monkeypatch.chdir(tmp_path)
    launch = f"""
        from launch import LaunchDescription
        from launch.substitutions import EnvironmentVariable, LaunchConfiguration
        from launch_ros.actions import Node

        def generate_launch_description():
            return LaunchDescription([Node(package="drive", executable="speed", parameters={parameters})])
    """
    files = {"launch/drive.launch.py": launch, "drive/__init__.py": "", "drive/speed.py": SPEED}
    files["setup.py"] = "setup(entry_points={'console_scripts': ['speed = drive.speed:main']})"
    write_workspace(Path("src"), {f"drive/{name}": text for name, text in files.items()})
    done = run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot")
    assert done.status == 0, done.err
    published = re.findall(r"publishes (/\w+)", run("show", "-C", "robot", "speed").out)
    assert published == names
    # A module that calls its own entry point is one node all the same.
    assert len(run("list", "-C", "robot", "--of", "nodes").out.splitlines()) == 2  # a heading and a node


@pytest.mark.parametrize("shared", ["", '<node pkg="joy" exec="joy_node" name="both" namespace="both"/>'])
def test_groups_may_stand_in_variants_alone(
    shared: str, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two launch files that have no node in common, or one: a group that only one of them changes is declared."""
    monkeypatch.chdir(tmp_path)
    nodes = {
        name: f'<launch><node pkg="joy" exec="joy_node" name="{name}" namespace="{name}"/>{shared}</launch>'
        for name in ("left", "base")
    }
    write_workspace(Path("src"), {f"both/launch/{name}.launch.xml": text for name, text in nodes.items()})
    options = [word for name in nodes for word in ("--launch", f"both/{name}.launch.xml")]
    done = run("import", "workspace", "src", *options, "--distro", "jazzy", "-o", "robot")
    assert done.status == 0, done.err
    assert run("check", "robot").status == 0
    assert "left" in run("list", "-C", "robot", "--variant", "left", "--of", "nodes").out
    # `base` is the project itself.
    assert "base" in run("list", "-C", "robot", "--variant", "base_variant", "--of", "nodes").out


@pytest.mark.parametrize(("distro", "stamped"), [("jazzy", "True"), ("kilted", "False")])
def test_velocities_have_a_time_where_a_parameter_says_so(
    distro: str, stamped: str, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    launch = f"""
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            return LaunchDescription([
                Node(package="nav2_velocity_smoother", executable="velocity_smoother", name="velocity_smoother",
                     parameters=[{{"enable_stamped_cmd_vel": {stamped}}}], remappings=[("cmd_vel_smoothed", "/out")]),
                Node(package="twist_mux", executable="twist_mux", name="twist_mux",
                     parameters=[{{"use_stamped": {stamped}, "topics.nav.topic": "/out"}}]),
            ])
    """
    write_workspace(Path("src"), {"drive/launch/drive.launch.py": launch})
    done = run("import", "workspace", "src", "--distro", distro, "-o", "robot")
    assert done.status == 0, done.err
    message = f"(geometry_msgs/msg/Twist{'Stamped' if stamped == 'True' else ''})"
    shown = run("show", "-C", "robot", "velocity_smoother").out
    assert f"publishes /out {message}" in shown
    assert f"subscribes to /cmd_vel {message}" in shown
    assert "type-mismatch" not in run("check", "robot").out


MUX = """
    from launch import LaunchDescription
    from launch.actions import DeclareLaunchArgument
    from launch.conditions import IfCondition, UnlessCondition
    from launch.substitutions import LaunchConfiguration
    from launch_ros.actions import Node

    def generate_launch_description():
        filtered = LaunchConfiguration("filtered")
        lidar = {"package": "sllidar_ros2", "executable": "sllidar_node", "name": "lidar"}
        return LaunchDescription([
            DeclareLaunchArgument("filtered", default_value="false"),
            Node(condition=UnlessCondition(filtered), **lidar),
            Node(condition=IfCondition(filtered), remappings=[("scan", "scan_raw")], **lidar),
            Node(condition=IfCondition(filtered), package="laser_filters", executable="scan_to_scan_filter_chain",
                 remappings=[("scan", "scan_raw"), ("scan_filtered", "scan")]),
            Node(package="twist_mux", executable="twist_mux", name="twist_mux",
                 parameters=[{"topics.navigation.topic": "cmd_vel", "topics.gamepad.topic": "cmd_vel_pad",
                              "locks.stop.topic": "stop", "topics.gamepad.timeout": 0.5}]),
        ])
"""


def test_topics_that_a_library_type_has_no_port_for_are_told(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_workspace(Path("src"), {"drive/launch/drive.launch.py": MUX})
    done = run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot")
    assert done.status == 0, done.err
    told = [line for line in done.out.splitlines() if "has no port for it" in line]
    assert [line.partition(": topic: ")[2] for line in told] == [
        "`cmd_vel_pad` (parameter `topics.gamepad.topic` of `/twist_mux`): `ros.twist_mux` has no port for it",
        "`stop` (parameter `locks.stop.topic` of `/twist_mux`): `ros.twist_mux` has no port for it",
    ]
    # What the help says is enough.
    Path("robot/own.yaml").write_text(
        "component_types:\n  mux: {is: ros.twist_mux, inputs: {pad: {type: geometry_msgs/msg/TwistStamped}},"
        " node: {subscribes: {pad: {named_by: topics.gamepad.topic}}}}\n",
        encoding="utf-8",
    )
    slice_ = Path("robot/robot.yaml")
    slice_.write_text(slice_.read_text(encoding="utf-8").replace("is: ros.twist_mux", "is: mux"), encoding="utf-8")
    assert "subscribes to /cmd_vel_pad" in run("show", "-C", "robot", "twist_mux").out


def test_what_another_way_to_start_a_node_gives_is_not_called_unpublished(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_workspace(Path("src"), {"drive/launch/drive.launch.py": MUX})
    assert run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot").status == 0
    text = Path("robot/robot.yaml").read_text(encoding="utf-8")
    assert "Nobody here publishes /scan_raw" not in text
    assert "lidar has /scan_raw in another way to start it than this one" in text


def test_cmake_files_that_are_included_are_read(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs whose targets stand in another file; messages are written without the package inside of its namespace."""
    pytest.importorskip("tree_sitter_cpp")
    monkeypatch.chdir(tmp_path)
    files = {
        "CMakeLists.txt": """
            project(mow)
            find_package(rclcpp REQUIRED)
            include(cmake/map.cmake)
            include(Elsewhere)
            mow_add_node(map_node src/*.cpp tf2 rclcpp)
        """,
        "cmake/map.cmake": """
            macro(mow_add_node name sources)
                file(GLOB FOUND ${sources})
                mow_add_program(${name} ${FOUND})
                ament_target_dependencies(${name} ${ARGN})
            endmacro()
            function(mow_add_program name)
                add_executable(${name} ${ARGN})
                mow_add_program(${name} ${ARGN})
            endfunction()
        """,
        "src/map.cpp": """
            #include <rclcpp/rclcpp.hpp>
            namespace mow::map {
            class Map : public rclcpp::Node {
            public:
              Map() : Node("map") {
                create_publisher<msg::Area>("area", 10);
                create_service<srv::Save>("save", [](const srv::Save::Request::SharedPtr a, srv::Save::Response::SharedPtr b) {});
              }
            };
            }
            class Plain : public rclcpp::Node {
            public:
              Plain() : Node("plain") { create_publisher<msg::Area>("plain_area", 10); }
            };
            int main() { rclcpp::spin(std::make_shared<mow::map::Map>()); rclcpp::spin(std::make_shared<Plain>()); }
        """,
        "msg/Area.msg": "float64 size\n",
        "srv/Save.srv": "---\nbool ok\n",
        "launch/map.launch.xml": '<launch><node pkg="mow" exec="map_node"/></launch>',
    }
    write_workspace(Path("src"), {f"mow/{name}": text for name, text in files.items()})
    done = run("import", "workspace", "src", "--distro", "jazzy", "-o", "robot")
    assert done.status == 0, done.err
    shown = "".join(run("show", "-C", "robot", name).out for name in ("map_node", "plain"))
    assert "publishes /area (mow/msg/Area)" in shown
    assert "serves /save (mow/srv/Save)" in shown
    assert "publishes /plain_area (?)" in shown


def test_files_of_ros_1_are_filled_in_where_the_launch_file_says_so(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    launch = """
        <launch>
          <arg name="robot" default="taluy"/>
          <node pkg="robot_localization" type="ekf_localization_node" name="filled">
            <rosparam file="$(find sea)/config/ekf.yaml" subst_value="true"/>
          </node>
          <node pkg="robot_localization" type="ekf_localization_node" name="plain">
            <rosparam file="$(find sea)/config/ekf.yaml"/>
          </node>
        </launch>
    """
    files = {"sea/launch/sea.launch": launch, "sea/config/ekf.yaml": "odom0: /$(arg robot)/odom\nfrequency: 20\n"}
    write_workspace(Path("src"), files, "catkin")
    done = run("import", "workspace", "src", "-o", "robot")
    assert done.status == 0, done.err
    assert "subscribes to /taluy/odom (nav_msgs/msg/Odometry)" in run("show", "-C", "robot", "filled").out
    assert "/odom (" not in run("show", "-C", "robot", "plain").out.replace("/odom0", "")


@pytest.mark.usefixtures("workspace")
def test_a_workspace_without_launch_files_says_what_to_do(run: Run) -> None:
    for file in Path("src").rglob("*.launch*"):
        file.unlink()
    done = run("import", "workspace", "src", "--distro", "humble", "-o", "robot")
    assert done.status == 1
    assert "there is no launch file in it" in done.err
    assert "with `--launch none` each program is taken as if something started it once" in done.err
