"""A workspace held against the model that was made of it: nothing differs, and what somebody changes in it is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.robot_observation import ObservationOptions
from archgen.plugins.ros.workspace.workspace_observation import observe_workspace
from tests.cli.conftest import Run
from tests.plugins.ros.workspace.test_workspace_import import WORKSPACE, write_workspace


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run) -> Path:
    """Return a folder with a workspace and the project that was imported from it."""
    pytest.importorskip("tree_sitter_cpp")
    monkeypatch.chdir(tmp_path)
    write_workspace(tmp_path / "src", WORKSPACE)
    assert run("import", "workspace", "src", "--distro", "humble", "-o", "robot").status == 0
    return tmp_path


def plant(file: str, old: str, new: str) -> None:
    """Replace a text that is there."""
    path = Path("src") / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


DRIVER = "my_driver/my_driver/driver.py"
LAUNCH = "my_bringup/launch/robot.launch.py"
FAULTS = {
    "type": (
        (DRIVER, '(Odometry, "odom"', '(LaserScan, "odom"'),
        "error[other-type]: `/odom`, which `/front/front_driver` publishes, has the type `sensor_msgs/msg/LaserScan` in src",
        f"{DRIVER}:13:9",
    ),
    "remap": (
        (LAUNCH, 'remappings=[("odom", "/odom")]', "remappings=[]"),
        "error[other-name]: `/front/front_driver` publishes `/front/odom` in src, and `/odom` in the design: its remap does not count there",
        f"{DRIVER}:13:9",
    ),
    "service": (
        (DRIVER, 'self.create_service(Trigger, "~/reset", self.reset)', "pass"),
        "error[not-running]: `/front/front_driver` does not serve `/front/front_driver/reset` in src",
        f"{LAUNCH}:12:9",
    ),
    "node": (
        (
            LAUNCH,
            'Node(package="slam_toolbox", executable="async_slam_toolbox_node", name="slam",',
            "Node(package='x', executable='y', name='z',",
        ),
        "error[not-running]: no launch file starts `/slam` in src",
        "robot.yaml",
    ),
    "quality of service": (
        ("my_filter/src/filter.cpp", "rclcpp::SensorDataQoS()", "rclcpp::QoS(5)"),
        "error[other-qos]: the reliability of `/scan` is `reliable` in src, and `best_effort` in the design",
        "my_filter/src/filter.cpp:7",
    ),
    "parameter": (
        (LAUNCH, '"odom0": "/odom"', '"odom0": "/other"'),
        'warning[other-parameter]: the parameter `odom0` of `/ekf` is `"/other"` in src, and `"/odom"` in the design',
        "src/my_bringup/launch/robot.launch.py:15:9",
    ),
    "new topic": (
        (
            DRIVER,
            'self.create_publisher(Odometry, "odom", 10)',
            'self.create_publisher(Odometry, "odom", 10)\n        self.create_subscription(Odometry, "/goal", print, 10)',
        ),
        "warning[not-in-model]: `/front/front_driver` subscribes to `/goal`, and the design does not say so",
        f"{DRIVER}:14:9",
    ),
}


@pytest.mark.usefixtures("robot")
def test_a_workspace_is_as_the_model_that_was_made_of_it(run: Run) -> None:
    """Its node that is off by default is that of a variant, and is known; what only running it tells is counted."""
    done = run("conform", "robot", "--against", "src", "--strict")
    assert (done.status, done.out.splitlines()) == (
        0,
        [
            "src (workspace): 4 of 4 nodes, 14 of 14 endpoints seen; 1 of its names unknown; 2 parameters compared",
            "no differences",
        ],
    )


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize("name", FAULTS)
def test_a_change_of_the_workspace_is_found_with_both_places(run: Run, name: str) -> None:
    change, sentence, place = FAULTS[name]
    plant(*change)
    done = run("conform", "robot", "--against", "src", "--strict")
    assert done.status == 1
    assert sentence in done.out
    assert place in done.out, done.out


@pytest.mark.usefixtures("robot")
def test_what_may_be_a_computed_name_is_not_missed(run: Run) -> None:
    """The name of one publisher of the driver is computed: a topic of its type may be that, and nobody says it is gone."""
    text = Path("robot/robot.yaml").read_text(encoding="utf-8")
    assert "bump: {}" in text
    Path("robot/robot.yaml").write_text(text.replace("bump: {}", "bump: /bump"), encoding="utf-8")
    done = run("conform", "robot", "--against", "src")
    assert done.status == 0
    assert "14 of 15 endpoints seen; 1 cannot be told; 1 of its names unknown" in done.out


def test_of_what_a_base_elsewhere_may_use_nothing_is_claimed(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A remap that fits nothing of a class itself may fit what its base makes; without such a base it is told."""
    monkeypatch.chdir(tmp_path)
    program = """
        import enum
        import rospy
        from house.nodes import HouseNode
        from std_msgs.msg import Bool
        class Mode(enum.Enum):
            ON = 1
        class Guard(HouseNode):
            def __init__(self):
                super().__init__("guard")
                rospy.Publisher("~safety", Bool, queue_size=1)
                rospy.Subscriber("~stop", Bool, print)
        Guard()
    """
    remap = '<remap from="~safty" to="/safety"/>'
    launch = f'<launch><node pkg="my_guard" type="guard.py" name="guard">{remap}</node></launch>'
    cmake = "project(my_guard)\ncatkin_install_python(PROGRAMS scripts/guard.py DESTINATION bin)\n"
    files = {"launch/guard.launch": launch, "scripts/guard.py": program, "CMakeLists.txt": cmake}
    for folder, text in (("open", program), ("closed", program.replace("(HouseNode)", ""))):
        files["scripts/guard.py"] = text
        write_workspace(Path(folder), {f"my_guard/{name}": each for name, each in files.items()}, "catkin")
        assert run("import", "workspace", folder, "-o", f"{folder}_robot").status == 0
        slice_file = Path(f"{folder}_robot/robot.yaml")
        is_open = folder == "open"
        assert (
            "its base `house.nodes.HouseNode` lies elsewhere, and may use more" in slice_file.read_text()
        ) == is_open
        assert ("unused-remap" in run("check", f"{folder}_robot").out) != is_open
        plant_in = Path(folder) / "my_guard/scripts/guard.py"
        plant_in.write_text(plant_in.read_text().replace('rospy.Subscriber("~stop", Bool, print)', "pass"))
        told = run("conform", f"{folder}_robot", "--against", folder).out
        assert ("error[not-running]: `/guard` does not subscribe to `/guard/stop`" in told) != is_open
        assert ("1 cannot be told" in told) == is_open


@pytest.mark.usefixtures("robot")
def test_launch_files_are_given_what_starts_them(run: Run) -> None:
    done = run("conform", "robot", "--against", "src", "--env", "MY_SCAN=/other")
    assert "`/slam` subscribes to `/other` in src, and `/scan` in the design" in done.out
    done = run("conform", "robot", "--against", "src", "--argument", "rviz:=true")
    assert done.status == 0
    assert "no launch argument" not in done.out
    assert (
        "`rviz` is no argument: write `--argument NAME:=VALUE`"
        in run("conform", "robot", "--against", "src", "--argument", "rviz").err
    )


def test_what_is_no_workspace_is_left_to_others(tmp_path: Path) -> None:
    assert observe_workspace(tmp_path, ObservationOptions()) is None
    assert observe_workspace(tmp_path / "x", ObservationOptions()) is None


UNLAUNCHED = {
    "src/drv/package.xml": "<package><name>drv</name><version>1.0.0</version><export><build_type>ament_python</build_type></export></package>",
    "src/drv/setup.py": 'from setuptools import setup\nsetup(entry_points={"console_scripts": ["driver = drv.driver:main"]})',
    "src/drv/drv/driver.py": """
import rclpy
from rclpy.node import Node
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("rate", 10)
        self.odom = self.create_publisher(Odometry, "odom", 10)
        self.server = self.create_service(Trigger, "~/reset", self.reset)

def main():
    rclpy.init()
    rclpy.spin(Driver())
""",
    "robot/archgen.yaml": """
archgen: 1
project: {id: rover, title: Rover}
ros: {distro: jazzy}
component_types:
  drive: {outputs: {odom: nav_msgs/msg/Odometry, reset: std_srvs/srv/Trigger}}
groups:
  base: {components: {one: {is: drive}, other: {is: drive}}}
nodes:
  left:
    {implements: base.one, package: drv, executable: driver, name: left_driver, namespace: /left, parameters: {rate: 20},
     remaps: {odom: /left/odometry}, publishes: {odom: odom}, serves: {reset: ~/reset}}
  right:
    {implements: base.other, package: drv, executable: driver, namespace: /right,
     publishes: {odom: {topic: /o, own_name: odom}}, serves: {reset: {name: /clear, own_name: ~/reset}}}
""",
}
"""A program that the design starts twice, with remaps that it writes in both ways."""


@pytest.fixture
def unlaunched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in UNLAUNCHED.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.usefixtures("unlaunched")
def test_without_launch_files_the_design_starts_the_programs(run: Run) -> None:
    result = run("conform", "robot", "--against", "src", "--launch", "none")
    assert "src (workspace): 2 of 2 nodes, 4 of 4 endpoints seen" in result.out
    assert "names, remaps and parameters as the design starts them" in result.out
    assert (result.status, "no differences" in result.out) == (0, True)
    plant("drv/drv/driver.py", '"odom"', '"odometry"')
    assert (
        "`/right/right` publishes `/right/odometry` in src, and `/o` in the design"
        in run("conform", "robot", "--against", "src", "--launch", "none").out
    )


def test_without_launch_files_a_program_may_be_missing(unlaunched: Path, run: Run) -> None:
    design = unlaunched / "robot" / "archgen.yaml"
    design.write_text(
        design.read_text().replace("executable: driver, namespace: /right", "executable: dirver, namespace: /right")
    )
    result = run("conform", "robot", "--against", "src", "--launch", "none")
    assert "there is no program of `/right/right` in src" in result.out
    assert "launch file" not in result.out
