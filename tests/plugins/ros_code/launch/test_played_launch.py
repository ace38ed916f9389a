"""Launch files of ROS 2 are resolved and started by a program of others: what it starts is what the model says."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from tests.outside_tools import run_judge
from tests.play_launch import find_python_library, install_packages, make_play_launch, play_environment
from tests.ros_environment import NEWEST_PYTHON, make_ros_python
from tests.running import ROOT

ROBOT = """\
archgen: 1
project: {id: rover}
ros: {distro: jazzy}
component_types:
  motor: {functionality: Turns., inputs: {target: std_msgs/String}, outputs: {state: std_msgs/String}, parameters: {joint: left, gain: 0.5}}
groups:
  drive:
    components:
      planner: {functionality: Plans., outputs: {left: std_msgs/String, right: std_msgs/String}, inputs: {state: left_motor.state}}
      left_motor: {is: motor, inputs: {target: planner.left}}
      right_motor: {is: motor, inputs: {target: planner.right}, parameters: {joint: "right <&> \\"side\\""}}
nodes:
  planner: {implements: planner, namespace: /brain}
  left_motor: {implements: left_motor}
  right_motor: {implements: right_motor, namespace: /right/arm}
"""
DEPLOYED = """\
archgen: 1
project: {id: rover}
ros: {distro: jazzy, discovery: peers, environment: {MODE: 'a "b" <c>'}}
groups:
  drive:
    components:
      planner: {outputs: {plan: std_msgs/String}, timing: {rate: 5 Hz, core: 0, priority: 7}}
      eye: {outputs: {picture: std_msgs/String}}
      finder: {inputs: {picture: eye.picture, plan: planner.plan}}
      recorder: {inputs: {plan: planner.plan}}
hosts:
  pc: {address: 10.0.0.1, cores: 2}
  arm: {address: 10.0.0.2}
  zone: {title: Of others, environment: {ROS_AUTOMATIC_DISCOVERY_RANGE: SUBNET}}
links: {cable: [pc, arm]}
containers: {seeing: {host: pc}}
nodes:
  planner: {implements: planner, host: pc}
  eye: {implements: eye, container: seeing}
  finder: {implements: finder, container: seeing}
  recorder: {implements: recorder, host: zone}
"""
EXPECTED = {
    "/brain/planner": {
        "publishes": {"/drive/planner/left", "/drive/planner/right"},
        "subscribes": {"/drive/left_motor/state"},
    },
    "/left_motor": {"publishes": {"/drive/left_motor/state"}, "subscribes": {"/drive/planner/left"}},
    "/right/arm/right_motor": {"publishes": {"/drive/right_motor/state"}, "subscribes": {"/drive/planner/right"}},
}


def make_workspace(folder: Path, text: str, *backends: str) -> Path:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux" or find_python_library() is None:
        pytest.skip("play_launch is for Linux, and wants the library of Python 3.10")
    make_ros_python()
    (folder / "p").mkdir()
    (folder / "p" / "archgen.yaml").write_text(text)
    for backend in backends:
        result = write_workspace(check_project(folder / "p"), OutputOptions(), backend, folder / "w")
        assert result.is_complete
    install_packages(folder / "w" / "src", folder / "install")
    return folder


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return make_workspace(tmp_path, ROBOT, "ros2_python", "ros2_launch")


def play_settings(workspace: Path, domain: int) -> tuple[list[str], dict[str, str], str]:
    program = make_play_launch()
    python_path = workspace / "python"
    python_path.mkdir()
    (python_path / "rover_drive").symlink_to(workspace / "w" / "src" / "rover_drive" / "rover_drive")
    (launch_file,) = (workspace / "install").glob("share/*/launch/rover.launch.xml")
    return [str(program)], play_environment(domain, workspace, workspace / "install", python_path), str(launch_file)


@pytest.mark.ros
def test_it_resolves_to_the_nodes_of_the_model(workspace: Path) -> None:
    program, environment, launch_file = play_settings(workspace, 66)
    command = [*program, "resolve", launch_file, "-o", "-"]
    done = run_judge(*command, env=environment, cwd=workspace)
    # What it does not know is a warning only.
    assert not re.search(r"\bWARN", done.stderr), done.stderr
    nodes = yaml.safe_load(done.stdout)["structure"]["nodes"]
    assert {name: (node["pkg"], node["exec"]) for name, node in nodes.items()} == {
        "/brain/planner": ("rover_drive", "planner"),
        "/left_motor": ("rover_drive", "motor"),
        "/right/arm/right_motor": ("rover_drive", "motor"),
    }
    right_motor = nodes["/right/arm/right_motor"]
    assert {each["from"]: each["to"] for each in right_motor["remaps"]} == {
        "state": "/drive/right_motor/state",
        "target": "/drive/planner/right",
    }
    (values,) = right_motor["params_files"]
    (parameters,) = (each["ros__parameters"] for each in yaml.safe_load(values).values())
    assert parameters == {"joint": 'right <&> "side"', "gain": 0.5}


@pytest.mark.ros
def test_it_resolves_variables_scheduling_and_shared_memory(tmp_path: Path) -> None:
    workspace = make_workspace(tmp_path, DEPLOYED, "ros2_python", "ros2_launch")
    program, environment, launch_file = play_settings(workspace, 66)
    run_scheduled = workspace / "install" / "lib" / "rover_bringup" / "run_scheduled"
    for words, prefix in (([], f"{run_scheduled} chrt -f 7 taskset -c 0 --"), (["scheduling:=false"], "")):
        done = run_judge(*program, "resolve", launch_file, *words, "-o", "-", env=environment, cwd=workspace)
        # All that its own reader does not know, and tells.
        warnings = [line for line in done.stderr.splitlines() if " WARN " in line]
        assert all("<node launch-prefix=" in each for each in warnings), done.stderr
        structure = yaml.safe_load(done.stdout)["structure"]
        (arguments,) = (each["args"] for name, each in structure["scopes"].items() if name.endswith("/pc.launch.xml"))
        assert [value for name, value in arguments.items() if name.startswith("chrt")] == [prefix]
        nodes = structure["nodes"]
        variables = {each["name"]: each["value"] for each in nodes["/planner"]["env"]}
        assert variables == {
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_STATIC_PEERS": "10.0.0.2",
            "FASTRTPS_DEFAULT_PROFILES_FILE": str(workspace / "install/share/rover_bringup/launch/hosts/pc.dds.xml"),
            "MODE": 'a "b" <c>',
        }
        # What one computer's file sets ends with it.
        assert {each["name"]: each["value"] for each in nodes["/recorder"]["env"]} == {
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
            "MODE": 'a "b" <c>',
        }
        assert nodes["/seeing"]["is_container"]
        for name in ("/eye", "/finder"):
            assert nodes[name]["container"] == "/seeing"
            assert nodes[name]["extra_args"] == {"use_intra_process_comms": "True"}


@pytest.mark.ros
def test_two_robots_in_one_domain_hear_nothing_of_each_other(workspace: Path) -> None:
    """Each is started by its launch file, the second with a prefix: its nodes, topics and values are those of the model behind it."""
    program, environment, launch_file = play_settings(workspace, 67)
    log = workspace / "launch.log"
    with log.open("w") as stream:
        robots = [
            subprocess.Popen(  # noqa: S603
                [*program, "launch", "--disable-all", launch_file, *words],
                env=environment,
                cwd=workspace,
                stdout=stream,
                stderr=stream,
            )
            for words in ([], ["prefix:=/robot2"])
        ]
    expected = EXPECTED | {
        f"/robot2{node}": {use: {f"/robot2{topic}" for topic in topics} for use, topics in uses.items()}
        for node, uses in EXPECTED.items()
    }
    python = str(make_ros_python())
    judge_environment = {key: value for key, value in environment.items() if key != "LD_LIBRARY_PATH"}
    judge = [python, str(ROOT / "tests" / "plugins" / "ros_code" / "graph_judge.py"), *expected]
    try:
        done = run_judge(*judge, env=judge_environment)
        graph = json.loads(done.stdout.splitlines()[-1])["graph"]
        joints = [run_judge(python, "-c", ASK_JOINT, name, env=judge_environment).stdout for name in RIGHT_MOTORS]
    finally:
        for robot in robots:
            robot.send_signal(signal.SIGINT)
        statuses = [robot.wait(60) for robot in robots]
    assert graph is not None, log.read_text()
    own_topics = {"/rosout", "/parameter_events"}
    assert {
        name: {use: {topic for topic, _ in uses[use]} - own_topics for use in ("publishes", "subscribes")}
        for name, uses in graph.items()
    } == expected
    assert joints == ['right <&> "side"\n'] * 2
    assert statuses == [0, 0], log.read_text()


RIGHT_MOTORS = ["/right/arm/right_motor", "/robot2/right/arm/right_motor"]
ASK_JOINT = """\
import sys
import rclpy
from rclpy.node import Node
from rclpy.parameter_client import AsyncParameterClient

rclpy.init()
node = Node('archgen_asker')
client = AsyncParameterClient(node, sys.argv[1])
assert client.wait_for_services(60)
future = client.get_parameters(['joint'])
rclpy.spin_until_future_complete(node, future, timeout_sec=60)
print(future.result().values[0].string_value)
rclpy.try_shutdown()
"""
