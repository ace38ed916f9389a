"""`archgen start`: the plan as text and as JSON, of all hosts and of one."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest
from click.testing import CliRunner

from archgen import resources
from archgen.cli import main
from tests.running import ROOT

EXAMPLE = str(ROOT / "examples" / "bringup")
WRONG_USAGE = 2
SCHEMA = json.loads(resources.resource_path("schemas", "start.schema.json").read_text(encoding="utf-8"))


def run(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(main, ["start", *words])
    return result.exit_code, result.stdout if result.exit_code != WRONG_USAGE else result.output


def test_the_plan_of_one_host_keeps_the_numbers_of_the_whole() -> None:
    status, text = run(EXAMPLE, "--host", "sim_pc")
    assert status == 0
    assert (
        text
        == """\
Start-up of Courier in Simulation: 2 of 12 steps

Phase simulators
   2  stage, program on sim_pc
      run: stage worlds/office.world
      in /opt/courier
      with DISPLAY=:0
      up when the port 6665 accepts connections and its output holds “physics running”, within 20 s

Phase components
  12  display, node on sim_pc
      run: ros2 run rviz2 rviz2 --ros-args -r __node:=display
      with DISPLAY=:0
      waits for navigation_manager (as written; activates what it reads: navigation.planner.path)
      waits for amcl (reads navigation.localisation.pose)
      waits for map_server (reads navigation.map_server.map)
      waits for planner_server (reads navigation.planner.path)
      waits for lifecycle_manager (activates what it reads: navigation.map_server.map)

Given up, so that nothing waits for itself:
  stage does not wait for controller_server (may read navigation.follower.velocity): its phase simulators is over before components begins
  stage does not wait for navigation_manager (activates what it reads: navigation.follower.velocity): its phase simulators is over before components begins
"""
    )


def test_the_whole_plan_tells_rights_ends_and_states() -> None:
    _, text = run(EXAMPLE)
    for line in (
        "      needs rights to run as the user root",
        "      up when it has ended, within 30 s",
        "      waits for map_server until it is started (manages it)",
        "      run: ros2 lifecycle set /dispatcher activate",
        "      state: active (configure, activate)",
        "      started again after 2 s",
        "   8  planner_server, loaded node in navigation on robot_pc",
        "  planner_server does not wait for controller_server (may read navigation.follower.progress): controller_server waits for planner_server",
    ):
        assert line in text.splitlines(), line
    assert "sudo" not in text


@pytest.mark.parametrize("project", [EXAMPLE, str(ROOT / "example_ramcip"), str(ROOT / "examples" / "first_robot")])
def test_the_json_follows_its_schema(project: str) -> None:
    _, text = run(project, "--format", "json")
    data = json.loads(text)
    assert [error.message for error in jsonschema_rs.Draft202012Validator(SCHEMA).iter_errors(data)] == []
    numbers = {step["id"]: step["number"] for step in data["steps"]}
    assert list(numbers.values()) == list(range(1, len(numbers) + 1))
    for step in data["steps"]:
        assert all(numbers[wait["for"]] < step["number"] for wait in step.get("waits", ()))


def test_the_json_has_all_that_starts_a_step() -> None:
    data = json.loads(run(EXAMPLE, "--format", "json")[1])
    steps = {step["id"]: step for step in data["steps"]}
    assert steps["stage"] == {
        "number": 2,
        "id": "stage",
        "title": "Simulator",
        "kind": "program",
        "phase": "simulators",
        "host": "sim_pc",
        "command": ["stage", "worlds/office.world"],
        "log_file": "stage.log",
        "seconds_at_most": "20",
        "ready": {
            "port": 6665,
            "log": "physics running",
            "within": {"text": "20 s", "value": 20_000_000_000, "unit": "ns"},
        },
        "environment": {"DISPLAY": ":0"},
        "directory": "/opt/courier",
    }
    assert steps["parcel_registry"]["respawn_delay"]["value"] == 2_000_000_000
    assert steps["lifecycle_manager"]["waits"] == [
        {"for": "map_server", "until": "started", "because": [{"reason": "manages"}]}
    ]
    assert (steps["map_server"]["managers"], steps["map_server"]["ready"]["topic"]) == (["lifecycle_manager"], "/map")
    assert {(each["step"], each["awaited"], *each.get("circle", ())) for each in data["given_up"]} >= {
        ("stage", "controller_server"),
        ("planner_server", "controller_server", "planner_server", "controller_server"),
    }


def test_a_host_that_is_none_is_wrong_usage(tmp_path: Path) -> None:
    status, text = run(EXAMPLE, "--host", "simpc")
    assert (status, "there is no host 'simpc'; did you mean `sim_pc`?" in text) == (WRONG_USAGE, True)
    file = tmp_path / "robot.yaml"
    file.write_text(
        "groups: {g: {components: {a: A}}}\nnodes: {a: {implements: a, start: {after: a}}}\n", encoding="utf-8"
    )
    assert "the project has no hosts" in run(str(file), "--host", "x")[1]


def test_contradictions_are_told_and_end_with_1(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(
        "groups: {g: {components: {a: A, b: B, c: C}}}\n"
        "nodes:\n"
        "  a: {implements: a, status: existing, start: {after: b}}\n"
        "  b: {implements: b, start: {after: a}}\n"
        '  c: {implements: c, start: {phase: core, after: [a, c]}, command: ["a b", "$(x)", "\\e[31m"]}\n',
        encoding="utf-8",
    )
    status, text = run(str(file))
    assert status == 1
    assert text.split("Contradictions, which no plan can keep:\n")[1].splitlines() == [
        "  c cannot start after a: core is over before components begins",
        "  c cannot start after itself",
        "  a cannot start after b after a",
    ]
    assert "run: 'a b' '$(x)' '␛[31m'" in text
    assert "nothing says how it is started" in text


def test_the_plan_of_a_variant() -> None:
    status, text = run(EXAMPLE, "--variant", "hardware")
    assert status == 0
    assert "   2  stage, program on robot_pc\n      run: robot-base --port 6665\n" in text
    assert run(EXAMPLE, "--variant", "hardwear")[0] == WRONG_USAGE
