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
EXPECTED = {
    "/brain/planner": {
        "publishes": {"/drive/planner/left", "/drive/planner/right"},
        "subscribes": {"/drive/left_motor/state"},
    },
    "/left_motor": {"publishes": {"/drive/left_motor/state"}, "subscribes": {"/drive/planner/left"}},
    "/right/arm/right_motor": {"publishes": {"/drive/right_motor/state"}, "subscribes": {"/drive/planner/right"}},
}


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux" or find_python_library() is None:
        pytest.skip("play_launch is for Linux, and wants the library of Python 3.10")
    make_ros_python()
    (tmp_path / "p").mkdir()
    (tmp_path / "p" / "archgen.yaml").write_text(ROBOT)
    for backend in ("ros2_python", "ros2_launch"):
        result = write_workspace(check_project(tmp_path / "p"), OutputOptions(), backend, tmp_path / "w")
        assert result.is_complete
    install_packages(tmp_path / "w" / "src", tmp_path / "install")
    return tmp_path


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
def test_what_it_starts_is_what_the_model_says(workspace: Path) -> None:
    program, environment, launch_file = play_settings(workspace, 67)
    log = workspace / "launch.log"
    with log.open("w") as stream:
        running = subprocess.Popen(  # noqa: S603
            [*program, "launch", "--disable-all", launch_file],
            env=environment,
            cwd=workspace,
            stdout=stream,
            stderr=stream,
        )
    python = str(make_ros_python())
    judge_environment = {key: value for key, value in environment.items() if key != "LD_LIBRARY_PATH"}
    judge = [python, str(ROOT / "tests" / "plugins" / "ros_code" / "graph_judge.py"), *EXPECTED]
    try:
        done = run_judge(*judge, env=judge_environment)
        graph = json.loads(done.stdout.splitlines()[-1])["graph"]
    finally:
        running.send_signal(signal.SIGINT)
        status = running.wait(60)
    assert graph is not None, log.read_text()
    own_topics = {"/rosout", "/parameter_events"}
    assert {
        name: {use: {topic for topic, _ in uses[use]} - own_topics for use in ("publishes", "subscribes")}
        for name, uses in graph.items()
    } == EXPECTED
    assert status == 0, log.read_text()
