"""The recorder that runs on the robot: what it prints is read again, with stand-ins for ROS and with real nodes of Jazzy."""

from __future__ import annotations

import itertools
import subprocess
import sys
import time
from pathlib import Path
from textwrap import dedent
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from archgen.importers.robot_observation import ObservationOptions
from archgen.plugins.ros.running_graph import graph_recorder
from archgen.plugins.ros.running_graph.graph_observation import observe_graph
from tests.cli.conftest import Run
from tests.ros_environment import NEWEST_PYTHON, interrupt_node, make_ros_python, ros_environment


def _refuse_one(name: str, _namespace: str) -> list[Any]:
    if name == "base":
        msg = "it ended"
        raise RuntimeError(msg)
    return []


def make_stand_in() -> Any:  # noqa: ANN401 - as a node of rclpy, that sees two nodes, one of them twice, and itself
    """Return what stands in for a node of rclpy."""
    endless = SimpleNamespace(nanoseconds=9223372036854775807)
    qos = SimpleNamespace(
        reliability=SimpleNamespace(name="BEST_EFFORT"),
        durability=SimpleNamespace(name="VOLATILE"),
        liveliness=SimpleNamespace(name="AUTOMATIC"),
        lifespan=endless,
        deadline=SimpleNamespace(nanoseconds=100_000_000),
        liveliness_lease_duration=endless,
    )
    end = {"node_namespace": "/front", "topic_type": "sensor_msgs/msg/LaserScan", "qos_profile": qos}
    topics = [("/scan", ["sensor_msgs/msg/LaserScan"])]
    services = [("/front/lidar/reset", ["std_srvs/srv/Trigger"])]
    return SimpleNamespace(
        get_node_names_and_namespaces=lambda: [
            ("lidar", "/front"), ("base", "/"), ("base", "/"), (graph_recorder.NAME, "/")
        ],
        get_topic_names_and_types=lambda: topics,
        get_service_names_and_types=lambda: services,
        get_publisher_names_and_types_by_node=lambda name, _: topics if name == "lidar" else [],
        get_subscriber_names_and_types_by_node=_refuse_one,
        get_service_names_and_types_by_node=lambda name, _: services if name == "lidar" else [],
        get_client_names_and_types_by_node=lambda *_: [],
        get_publishers_info_by_topic=lambda _: [
            SimpleNamespace(node_name=name, **end) for name in ("lidar", graph_recorder.NAME)
        ],
        get_subscriptions_info_by_topic=lambda _: [],
    )  # fmt: skip


@pytest.fixture
def actions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a stand-in for rclpy.action there."""
    package, module = ModuleType("rclpy"), ModuleType("rclpy.action")
    module.get_action_server_names_and_types_by_node = lambda _node, name, _space: (  # type: ignore[attr-defined]
        [("/drive", ["nav2_msgs/action/Spin"])] if name == "base" else []
    )
    module.get_action_client_names_and_types_by_node = lambda *_of: []  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "rclpy", package)
    monkeypatch.setitem(sys.modules, "rclpy.action", module)
    package.action = module  # type: ignore[attr-defined]


@pytest.mark.usefixtures("actions")
def test_a_node_that_uses_nothing_yet_is_waited_for() -> None:
    """Its name arrives before what it uses: until then the graph is not complete, for as long as the whole may take."""
    node = make_stand_in()
    ticks, spun = itertools.count(0, 0.25), list[None]()
    node.get_node_names_and_namespaces = lambda: [("lidar", "/front"), ("late", "/")]
    graph_recorder.wait_for_nodes(node, lambda: next(ticks), lambda: spun.append(None))
    assert len(spun) >= graph_recorder.MOST_SECONDS
    spun.clear()
    node.get_node_names_and_namespaces = list
    assert graph_recorder.wait_for_nodes(node, lambda: next(ticks), lambda: spun.append(None)) == []
    assert len(spun) >= graph_recorder.MOST_SECONDS


@pytest.mark.usefixtures("actions")
def test_a_graph_of_ros_2_is_written_and_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A node that ends while it is asked is told on the error stream, and the others are written."""
    node, lines = make_stand_in(), list[str]()
    ticks = itertools.count(0, 0.25)
    spun = list[None]()
    names = graph_recorder.wait_for_nodes(node, lambda: next(ticks), lambda: spun.append(None))
    assert 1 < len(spun) < 10
    assert names == ["/base", "/base", "/front/lidar"]
    graph_recorder.write_graph(node, names, lines.append)
    values = {"rate": 12.5, "on": True, "filter.low": [1, 2], "far": float("inf"), "none": None, "urdf": "x" * 20_000}
    graph_recorder.write_parameters("/front/lidar", values, lines.append)
    process = tmp_path / "12"
    process.mkdir()
    command = ["lidar", "--ros-args", "-r", "__node:=lidar", "-r", "__ns:=/front", "-r", "scan:=/scan", ""]
    (process / "cmdline").write_bytes("\0".join(command).encode())
    (tmp_path / "13").mkdir()
    graph_recorder.write_state("/front/lidar", SimpleNamespace(label="inactive", id=2), lines.append)
    graph_recorder.write_host("arm-pc", names, graph_recorder.list_commands(tmp_path), lines.append)
    assert capsys.readouterr().err == "/base: it ended\n"
    file = tmp_path / "graph.txt"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    robot = observe_graph(file, ObservationOptions())
    assert robot is not None
    assert {each.full_name: each.count for each in robot.nodes} == {"/base": 2, "/front/lidar": 1}
    lidar = next(each for each in robot.nodes if each.full_name == "/front/lidar")
    assert lidar.parameters == {"rate": 12.5, "on": True, "filter.low": [1, 2], "far": float("inf")}
    assert {each.full_name: (each.state, each.host) for each in robot.nodes} == {
        "/base": (None, None),
        "/front/lidar": ("inactive", "arm-pc"),
    }
    scan = next(each for each in robot.endpoints if each.name == "/scan")
    assert (scan.use, scan.message, scan.qos["reliability"], str(scan.qos["deadline"])) == (
        "publishes",
        "sensor_msgs/msg/LaserScan",
        "best_effort",
        "100 ms",
    )
    assert {(each.node, each.flow, each.name) for each in robot.endpoints} >= {("/base", "action", "/drive")}
    assert robot.unread == ()


def test_a_graph_of_ros_1_is_written_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    state = [[["/scan", ["/lidar"]]], [["/scan", ["/mapper"]]], [["/lidar/reset", ["/lidar"]]]]
    master = SimpleNamespace(
        getSystemState=lambda: state,
        getTopicTypes=lambda: [["/scan", "sensor_msgs/LaserScan"]],
        getParam=lambda _name: {"lidar": {"frame": "laser"}, "robot_description": "x" * 20_000},
    )
    modules: dict[str, dict[str, Any]] = {
        "rosgraph": {"Master": lambda _name: master},
        "rosservice": {"get_service_type": lambda _name: "std_srvs/Empty"},
    }
    for name, contents in modules.items():
        module = ModuleType(name)
        module.__dict__.update(contents)
        monkeypatch.setitem(sys.modules, name, module)
    lines = list[str]()
    assert graph_recorder.record_ros_1(lines.append) == 0
    file = tmp_path / "graph.txt"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    robot = observe_graph(file, ObservationOptions())
    assert robot is not None
    assert robot.unseen_uses == {"calls"}
    assert {(each.node, each.use, each.name, each.message) for each in robot.endpoints} == {
        ("/lidar", "publishes", "/scan", "sensor_msgs/msg/LaserScan"),
        ("/mapper", "subscribes", "/scan", "sensor_msgs/msg/LaserScan"),
        ("/lidar", "serves", "/lidar/reset", "std_srvs/srv/Empty"),
    }
    assert next(each for each in robot.nodes if each.full_name == "/lidar").parameters == {"frame": "laser"}


@pytest.mark.parametrize(
    ("kind", "field", "value", "read"),
    [(0, "", None, None), (1, "bool", True, True), (3, "double", 1.5, 1.5), (4, "string", "a", "a"), (5, "byte_array", [b"\x07"], [7]), (9, "string_array", ("a", "b"), ["a", "b"])],
)  # fmt: skip
def test_values_of_parameters(kind: int, field: str, value: object, read: object) -> None:
    assert graph_recorder.read_value(SimpleNamespace(**{"type": kind, f"{field}_value": value})) == read


def test_without_ros_the_recorder_says_what_to_do(tmp_path: Path, run: Run) -> None:
    """What is printed is a whole program: it needs nothing of archgen."""
    program = tmp_path / "recorder.py"
    program.write_text(run("conform", "--recorder").out, encoding="utf-8")
    assert "archgen." not in program.read_text(encoding="utf-8").partition('"""\n')[2]
    done = subprocess.run([sys.executable, "-I", program], capture_output=True, text=True, check=False)  # noqa: S603
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "neither rclpy nor rosgraph is there: source the setup.bash of the robot's ROS first\n"


ROBOT = """
    import rclpy
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.qos import QoSProfile, ReliabilityPolicy
    from rclpy.action import ActionServer
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan
    from std_srvs.srv import Trigger
    from test_msgs.action import Fibonacci

    rclpy.init()
    lidar = Node("lidar", namespace="/front", cli_args=["--ros-args", "-r", "scan:=/scan", "-p", "rate:=12.5"])
    lidar.declare_parameter("rate", 10.0)
    lidar.declare_parameter("frame", "laser")
    lidar.create_publisher(LaserScan, "scan", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT))
    lidar.create_service(Trigger, "~/reset", lambda request, response: response)
    planner = Node("planner")
    planner.create_subscription(LaserScan, "SCAN", print, QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT))
    planner.create_client(Trigger, "/front/lidar/reset")
    server = ActionServer(planner, Fibonacci, "drive", lambda goal: Fibonacci.Result())
    base = Node("base")
    base.create_publisher(Odometry, "odom", 10)
    executor = SingleThreadedExecutor()
    for node in (lidar, planner, base):
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""
DESIGN = """\
archgen: 1
project: {id: rover, title: Rover}
ros: {distro: jazzy}
groups:
  robot:
    components:
      lidar:
        outputs: {scan: sensor_msgs/msg/LaserScan, reset: std_srvs/srv/Trigger}
        parameters: {frame: {type: string, value: laser}, rate: {type: float, value: 10}}
      planner: {inputs: {scan: lidar.scan, reset: lidar.reset}, outputs: {drive: test_msgs/action/Fibonacci}}
      base: {outputs: {odom: nav_msgs/msg/Odometry}}
nodes:
  lidar:
    implements: robot.lidar
    namespace: /front
    status: existing
    remaps: {scan: /scan}
    parameters: {rate: 12.5}
    publishes: {scan: {own_name: scan, qos: {reliability: best_effort, depth: 5}}}
    serves: {reset: "~/reset"}
  planner:
    implements: robot.planner
    status: existing
    subscribes: {scan: {topic: /scan, qos: sensor_data}}
    calls: {reset: /front/lidar/reset}
    serves: {drive: drive}
  base: {implements: robot.base, status: existing, publishes: {odom: odom}}
"""


@pytest.mark.ros
@pytest.mark.skipif(sys.version_info >= (*NEWEST_PYTHON, 1), reason="there are no wheels of ROS for it")
@pytest.mark.parametrize("topic", ["/scan", "/scna"])
def test_real_nodes_are_recorded_and_held_against_their_design(tmp_path: Path, run: Run, topic: str) -> None:
    """Three nodes of Jazzy: as designed nothing differs, and a name that is misspelt in a program is found."""
    python, environment = make_ros_python(), ros_environment(83, tmp_path)
    (tmp_path / "robot.py").write_text(dedent(ROBOT).replace("SCAN", topic), encoding="utf-8")
    (tmp_path / "recorder.py").write_text(run("conform", "--recorder").out, encoding="utf-8")
    (tmp_path / "rover").mkdir()
    (tmp_path / "rover/archgen.yaml").write_text(DESIGN, encoding="utf-8")
    robot = subprocess.Popen([python, tmp_path / "robot.py"], env=environment)  # noqa: S603
    try:
        time.sleep(2)
        recorded = subprocess.run(  # noqa: S603
            [python, tmp_path / "recorder.py"], env=environment, capture_output=True, text=True, check=True, timeout=100
        )
    finally:
        interrupt_node(robot)
    (tmp_path / "graph.txt").write_text(recorded.stdout, encoding="utf-8")
    done = run("conform", tmp_path / "rover", "--against", tmp_path / "graph.txt", "--strict")
    assert "3 of 3 nodes" in done.out, recorded.stdout
    if topic == "/scan":
        assert (done.status, "no differences" in done.out) == (0, True), done.out
        assert "6 of 6 endpoints seen; 0 of its names unknown; 2 parameters compared" in done.out
    else:
        assert done.status == 1
        assert "error[other-name]: `/planner` subscribes to `/scna` on the robot, and `/scan` in the design" in done.out
        assert done.out.endswith("\n1 error\n")
