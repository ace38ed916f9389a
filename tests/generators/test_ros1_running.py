"""The cleaning robot on a real ROS 1: its generated nodes run under a real master, and the graph is the model's."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.model.parameter_values import find_effective_parameters
from tests.ros_1_environment import (
    SYSTEM_PYTHON,
    build_messages,
    find_free_port,
    require_ros_1,
    ros_1_environment,
    run_programs,
)
from tests.running import ROOT, archgen

pytestmark = pytest.mark.ros


def write_project(folder: Path, text: str) -> Architecture:
    folder.mkdir(parents=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(folder).architecture


def generate_workspace(project: Path, workspace: Path, *words: str) -> None:
    for backend in ("ros_interfaces", "ros1_python", "ros1_launch"):
        archgen("generate", backend, "-o", workspace, *words, cwd=project, status=0)


def judge_graph(environment: dict[str, str], architecture: Architecture) -> dict[str, Any]:
    """Return what another process sees of the graph when all nodes are there."""
    names = [each.full_name for each in architecture.nodes.values()]
    judge = [SYSTEM_PYTHON, str(ROOT / "tests" / "generators" / "ros_1_judge.py"), *names]
    done = subprocess.run(judge, env=environment, capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr
    observed: dict[str, Any] = json.loads(done.stdout)
    return observed


def list_modelled(architecture: Architecture) -> tuple[set[tuple[str, str, str]], dict[str, str]]:
    """Return what the model says: which node does what with which name, and the types of topics and services."""
    uses: set[tuple[str, str, str]] = set()
    types: dict[str, str] = {}
    for endpoint in architecture.endpoints:
        if endpoint.medium != "ros":
            continue
        node = architecture.nodes[endpoint.node].full_name
        package, _, name = (endpoint.message or "//").split("/")
        if endpoint.flow == "action":
            told, asked = (
                [f"{endpoint.name}/{each}" for each in ("status", "feedback", "result")],
                [f"{endpoint.name}/{each}" for each in ("goal", "cancel")],
            )
            is_server = endpoint.use == "serves"
            uses |= {(node, "publishes", each) for each in (told if is_server else asked)}
            uses |= {(node, "subscribes", each) for each in (asked if is_server else told)}
            types |= {
                f"{endpoint.name}/{each.lower()}": f"{package}/{name}Action{each}"
                for each in ("Goal", "Feedback", "Result")
            }
            types |= {
                f"{endpoint.name}/cancel": "actionlib_msgs/GoalID",
                f"{endpoint.name}/status": "actionlib_msgs/GoalStatusArray",
            }
        elif endpoint.use != "calls":
            # Who calls a service is in no graph of ROS 1.
            uses.add((node, endpoint.use, endpoint.name))
            types[endpoint.name] = f"{package}/{name}"
    return uses, types


def list_observed(observed: dict[str, Any]) -> set[tuple[str, str, str]]:
    """Return the same of a graph, without what ROS 1 gives to every node, and its own node."""
    return {
        (node, use, name)
        for node, entries in observed["graph"].items()
        for use, names in entries.items()
        for name in names
        if node != "/rosout" and name != "/rosout" and name not in {f"{node}/get_loggers", f"{node}/set_logger_level"}
    }


ROS_OWN_NAMES = {"/rosout", "/rosout_agg"}
ROS_OWN_PARAMETERS = {"/rosdistro", "/roslaunch", "/rosversion", "/run_id"}


def assert_same_graph(observed: dict[str, Any], architecture: Architecture) -> None:
    uses, types = list_modelled(architecture)
    assert list_observed(observed) == uses
    observed_types = {
        name: each for name, each in observed["types"].items() if each is not None and name not in ROS_OWN_NAMES
    }
    assert observed_types == types
    parameters = {
        f"{node.full_name}/{name.replace('.', '/')}": parameter.value
        for node in architecture.nodes.values()
        for name, parameter in find_effective_parameters(architecture, node).items()
        if parameter.is_known
    }
    assert {
        name: value
        for name, value in observed["parameters"].items()
        if "/" + name.split("/")[1] not in ROS_OWN_PARAMETERS
    } == parameters


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    require_ros_1()
    return tmp_path


def test_the_cleaning_robot_runs_as_its_model_says(folder: Path) -> None:
    text = (ROOT / "examples" / "cleaning_robot" / "archgen.yaml").read_text(encoding="utf-8")
    architecture = write_project(folder / "p", text.replace("distro: jazzy", "distro: noetic"))
    workspace = folder / "w"
    generate_workspace(folder / "p", workspace)
    build_messages(workspace, folder)
    port = find_free_port()
    environment = ros_1_environment(workspace, folder, port)
    commands = [
        ["/usr/bin/roscore", "-p", str(port)],
        ["/usr/bin/roslaunch", "--wait", "cleaning_robot_bringup", "cleaning_robot.launch"],
    ]
    with run_programs(commands, environment, folder / "log"):
        observed = judge_graph(environment, architecture)
    assert len(observed["graph"]) == 15
    assert_same_graph(observed, architecture)
