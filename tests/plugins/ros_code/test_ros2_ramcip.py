"""RAMCIP's planned nodes run: all of them, generated, imported, and seen by another process as the model says."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from archgen.views.generation.generation_context import GenerationContext
from tests.judged_projects import judge_ramcip
from tests.outside_tools import run_judge
from tests.plugins.ros_code.test_ros2_python import is_ros_own, list_expected
from tests.ros_environment import NEWEST_PYTHON, make_ros_python, ros_environment
from tests.running import ROOT

WITHOUT_WHEELS = {
    "hri_msgs",
    "moveit_msgs",
    "nav2_msgs",
    "object_recognition_msgs",
    "ramcip_msgs",
    "vision_msgs",
}
"""The packages of messages that are not on PyPI: their messages would have to be compiled, each into code of several kinds."""
STAND_INS = {"msg": "std_msgs/msg/String", "srv": "std_srvs/srv/Trigger", "action": "test_msgs/action/Fibonacci"}
"""What stands in for their messages, by kind: a node with it is started, and has its names and settings."""


def stand_in(message: str) -> str:
    package, kind, _ = message.split("/")
    return STAND_INS[kind] if package in WITHOUT_WHEELS else message


def write_stand_ins(folder: Path, programs: list[dict[str, Any]]) -> None:
    """Write modules from which the missing messages can be imported."""
    lines: dict[Path, set[str]] = {}
    for message in list_messages(programs):
        package, kind, name = message.split("/")
        if package in WITHOUT_WHEELS:
            other_package, _, other_name = STAND_INS[kind].split("/")
            module = folder / package / kind / "__init__.py"
            lines.setdefault(module, set()).add(f"from {other_package}.{kind} import {other_name} as {name}\n")
    for module, imports in lines.items():
        module.parent.mkdir(parents=True)
        module.write_text("".join(sorted(imports)))


def list_messages(programs: list[dict[str, Any]]) -> set[str]:
    sections = ("publishers", "subscriptions", "services", "clients", "action_servers", "action_clients")
    return {port["message"] for program in programs for section in sections for port in program[section]}


def with_stand_ins(program: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: [{**each, "message": stand_in(each["message"])} if "message" in each else each for each in value]
        if isinstance(value, list) and value and isinstance(value[0], dict)
        else value
        for name, value in program.items()
    }


@pytest.mark.ros
def test_all_planned_nodes_run_as_the_model_says(tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    python = str(make_ros_python())
    project = check_project(ROOT / "example_ramcip")
    write_workspace(project, OutputOptions(), "ros2_launch", tmp_path / "w")
    result = write_workspace(project, OutputOptions(), "ros2_python", tmp_path / "w")
    assert result.findings == ()
    programs: list[dict[str, Any]] = make_view(GenerationContext(project.architecture)).data["programs"]
    # What a container loads is a library of C++.
    planned_nodes = {
        each.full_name
        for each in project.architecture.nodes.values()
        if each.status in {None, "planned"} and "composable" not in each.kinds
    }
    assert {node["full_name"] for program in programs for node in program["nodes"]} == planned_nodes
    write_stand_ins(tmp_path / "stand_ins", programs)
    expected = {
        node["full_name"]: list_expected(with_stand_ins(program), node["id"])
        for program in programs
        for node in program["nodes"]
    }
    packages = sorted((tmp_path / "w" / "src").iterdir())
    environment = ros_environment(65, tmp_path) | {
        "PYTHONPATH": ":".join(str(each) for each in (*packages, tmp_path / "stand_ins"))
    }
    script = str(ROOT / "tests" / "plugins" / "ros_code" / "node_runner.py")
    with subprocess.Popen(  # noqa: S603 - our own program
        [python, script], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as running:
        assert running.stdin is not None
        assert running.stdout is not None
        running.stdin.write(json.dumps(list(list_starts(programs, tmp_path / "w" / "src"))) + "\n")
        running.stdin.flush()
        assert running.stdout.readline() == "ready\n"
        judge = [python, str(ROOT / "tests" / "plugins" / "ros_code" / "graph_judge.py"), *expected]
        done = run_judge(*judge, env=environment)
        running.stdin.close()
    assert running.returncode == 0
    graph = json.loads(done.stdout.splitlines()[-1])["graph"]
    observed = {
        name: {use: {tuple(each) for each in topics if not is_ros_own(each[0], name)} for use, topics in uses.items()}
        for name, uses in graph.items()
    }
    assert observed == expected


def list_starts(programs: list[dict[str, Any]], source: Path) -> list[dict[str, Any]]:
    """Return what each node is started with: names, remaps, and the values of its parameters."""
    starts = []
    for program in programs:
        for node in program["nodes"]:
            values = source / "ramcip_bringup" / "config" / f"{node['id']}.yaml"
            words = ["-r", f"__node:={node['name']}", "-r", f"__ns:={node['namespace']}"]
            for remap in node["remaps"]:
                words += ["-r", f"{remap['own_name']}:={remap['name']}"]
            if values.exists():
                words += ["--params-file", str(values)]
            module = f"{program['package']}.{program['module']}_node"
            starts.append({"module": module, "class": f"{program['class_name']}Node", "words": words})
    return starts


def test_what_has_no_wheel_is_known_by_name() -> None:
    """A package that is stood in for here is one of those that RAMCIP uses."""
    programs = make_view(GenerationContext(judge_ramcip().architecture)).data["programs"]
    used_packages = {message.partition("/")[0] for message in list_messages(programs)}
    assert used_packages >= WITHOUT_WHEELS
