"""The view `plan`: steps by computer, what is seen of other computers, jobs for systemd and compose."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.bringup.start_plan import make_start_plan
from archgen.pipeline import check_project
from archgen.plugins.start_scripts.start_plan_view import (
    UNPLACED,
    find_unread_hints,
    list_jobs,
    list_phase_needs,
    list_seen_signs,
    make_view,
    read_hint,
    record_step,
)
from archgen.views.generation.generation_context import GenerationContext

PROJECT = """\
groups:
  g:
    components:
      camera: {owner: lab, outputs: {image: sensor_msgs/msg/Image}}
      finder: {owner: works, inputs: {image: camera.image}, outputs: {pose: geometry_msgs/msg/Pose}}
      arm: {owner: works, inputs: {pose: finder.pose}}
partners: {lab: Lab, works: Works}
ros: {distro: jazzy}
nodes:
  world:
    kind: program
    command: [stage]
    host: desk
    start: {phase: simulators, ready: {port: 6665, file: /run/stage, within: 1500 ms}, respawn: true, respawn_delay: 500 ms}
  camera: {implements: camera, package: cam, executable: cam, host: desk, start: {environment: {A: b}, user: root}}
  finder: {implements: finder, package: find, plugin: "find::Finder", kind: composable, container: box}
  arm:
    implements: arm
    package: arm
    executable: arm
    kind: lifecycle
    host: robot
    parameter_commands: {robot_description: [xacro, arm.xacro]}
    hints: {start: {image: "arm:1"}}
    start: {state: active, ready: {topic: joints}}
  strange: {kind: program, host: robot, start: {ready: {service: /strange}}}
containers: {box: {host: robot}}
hosts:
  desk: {address: 10.0.0.2}
  robot: {hints: {start: {image: "robot:2"}}}
"""


def view(tmp_path: Path, **context: Any) -> dict[str, Any]:  # noqa: ANN401 - of the context
    path = tmp_path / "p.yaml"
    path.write_text(f"archgen: 1\nproject: {{id: bot, title: Bot}}\n{PROJECT}", encoding="utf-8")
    made = make_view(GenerationContext(check_project(path).architecture, **context))
    assert made.findings == ()
    return dict(made.data)


def steps_of(data: dict[str, Any], host: str) -> dict[str, Any]:
    (found,) = [each for each in data["hosts"] if each["name"] == host]
    return {step["name"]: step for step in found["steps"]}


def test_a_step_says_all_that_starts_it(tmp_path: Path) -> None:
    steps = {step["name"]: step for step in view(tmp_path)["steps"]}
    assert [steps[name]["runs"] for name in ("world", "camera", "finder", "arm", "strange")] == [
        "program",
        "program",
        "loaded",
        "program",
        "nobody",
    ]
    world = steps["world"]
    assert (world["number"], world["phase"], world["within"], world["respawn"], world["address"]) == (
        1,
        "simulators",
        "1.5",
        "0.5",
        "10.0.0.2",
    )
    assert [(each["kind"], each["target"]) for each in world["signs"]] == [("port", "6665"), ("file", "/run/stage")]
    assert steps["camera"]["environment"] == [{"name": "A", "value": "b"}]
    assert (steps["camera"]["user"], steps["camera"]["needs_rights"]) == ("root", ["to run as the user root"])
    assert (steps["finder"]["container"], steps["finder"]["within"]) == ("/box", "60")
    arm = steps["arm"]
    assert arm["lifecycle"] == {"node": "/arm", "state": "active", "transitions": ["configure", "activate"]}
    assert arm["values"] == [{"name": "robot_description", "words": ["xacro", "arm.xacro"]}]
    assert [(each["name"], each["until"], each["reasons"]) for each in arm["awaited"]] == [
        ("finder", "ready", ["reads g.finder.pose"])
    ]
    assert [steps[name]["image"] for name in ("world", "finder", "arm", "box")] == ["", "robot:2", "arm:1", "robot:2"]
    assert arm["place"].startswith("p.yaml:")


def test_a_computer_sees_of_others_what_it_waits_for(tmp_path: Path) -> None:
    data = view(tmp_path)
    assert [(each["name"], each["phases"]) for each in data["hosts"]] == [
        ("desk", ["simulators", "components"]),
        ("robot", ["simulators", "components"]),
    ]
    robot = steps_of(data, "robot")
    assert [name for name, step in robot.items() if not step["is_own"]] == ["world", "camera"]
    assert [sign["kind"] for sign in robot["world"]["seen_signs"]] == ["port"]
    assert robot["camera"]["seen_signs"] == []
    assert [sign["kind"] for sign in steps_of(data, "desk")["world"]["seen_signs"]] == ["port", "file"]
    (host,) = [each for each in data["hosts"] if each["name"] == "robot"]
    assert host["others"] == [{"name": "desk", "address": "10.0.0.2"}]


def test_a_part_starts_its_own_and_watches_the_rest(tmp_path: Path) -> None:
    data = view(tmp_path, host="robot")
    assert (data["is_whole"], [each["name"] for each in data["hosts"]]) == (False, ["robot"])
    assert {name for name, step in steps_of(data, "robot").items() if step["is_by_others"]} == {"world", "camera"}
    works = view(tmp_path, components=frozenset({"g.finder", "g.arm"}), nodes=frozenset({"finder", "arm"}))
    robot = steps_of(works, "robot")
    assert [name for name, step in robot.items() if step["is_own"]] == ["box", "finder", "arm"]
    assert robot["world"]["is_by_others"]


def test_options_say_folder_and_image(tmp_path: Path) -> None:
    data = view(tmp_path)
    assert (data["folder"], data["image"]) == ("/opt/bot", "")
    data = view(tmp_path, options={"folder": "/srv/bot/", "image": "bot:3"})
    assert (data["folder"], data["image"]) == ("/srv/bot", "bot:3")


def test_jobs_wait_for_what_shows_that_something_is_up(tmp_path: Path) -> None:
    data = view(tmp_path)
    jobs = {(job["host"], job["name"]): job for job in data["jobs"]}
    assert list(jobs) == [
        ("desk", "world"),
        ("desk", "world-up"),
        ("desk", "camera"),
        ("robot", "world-up"),
        ("robot", "box"),
        ("robot", "finder"),
        ("robot", "arm"),
        ("robot", "arm-up"),
        ("robot", "strange-up"),
    ]
    assert jobs["desk", "world-up"]["is_health"]
    assert not jobs["robot", "world-up"]["is_health"]
    assert jobs["desk", "camera"]["phase_before"] == "simulators"
    assert jobs["desk", "camera"]["depends_on"] == [{"job": "world-up", "step": "world", "how": "healthy"}]
    assert jobs["robot", "box"]["depends_on"] == [{"job": "world-up", "step": "world", "how": "completed"}]
    assert jobs["robot", "arm"]["needs"] == [{"job": "finder", "step": "finder", "how": "completed"}]
    assert jobs["robot", "arm-up"]["needs"] == [{"job": "arm", "step": "arm", "how": "started"}]
    (robot,) = [each for each in data["hosts"] if each["name"] == "robot"]
    assert list_jobs(robot) == robot["jobs"]
    assert [need["job"] for need in list_phase_needs(robot)["components"]] == ["box", "finder", "arm-up", "strange-up"]
    assert list_seen_signs(robot["steps"][0]) == robot["steps"][0]["seen_signs"]


@pytest.mark.parametrize(
    ("hints", "found"),
    [
        ("{start: 3}", "the hints of `a` for `start` are no mapping"),
        ("{start: {image: [x]}}", "the hint `image` of `a` for `start` is no text"),
        ("{start: {imgae: x}}", "nobody reads the hint `imgae` of `a` for `start`"),
        ("{other: {image: x}}", ""),
    ],
)
def test_hints_of_another_kind_say_nothing(tmp_path: Path, hints: str, found: str) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(
        f"archgen: 1\nproject: {{id: bot, title: Bot}}\nhosts: {{a: {{hints: {hints}}}}}\n", encoding="utf-8"
    )
    architecture = check_project(path).architecture
    assert read_hint(architecture.hosts["a"].annotations, "image") == ""
    findings = list(find_unread_hints(architecture))
    assert "".join(each.message for each in findings) == found
    assert [(each.span.line, each.help) for each in findings] in (
        [],
        [(3, "did you mean `image`?")],
        [(3, "what is known here is `image`, each a text")],
    )


def test_a_project_without_nodes_starts_nothing(tmp_path: Path) -> None:
    path = tmp_path / "p.yaml"
    path.write_text("archgen: 1\nproject: {id: bot, title: Bot}\n", encoding="utf-8")
    data = make_view(GenerationContext(check_project(path).architecture)).data
    assert (data["hosts"], data["steps"], data["jobs"], data["targets"]) == ([], [], [], [])


def test_what_has_no_host_stands_on_a_computer_without_a_name(tmp_path: Path) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(
        "archgen: 1\nproject: {id: bot, title: Bot}\nnodes: {a: {kind: program, command: [x]}}\n", encoding="utf-8"
    )
    architecture = check_project(path).architecture
    (step,) = make_start_plan(architecture).steps
    record = record_step(step, 1, {step.id: step.file_name}, architecture, 2)
    assert (record["host"], record["address"], record["within"], record["is_watched"]) == (
        UNPLACED,
        "localhost",
        None,
        False,
    )
    assert [each["name"] for each in make_view(GenerationContext(architecture)).data["hosts"]] == [UNPLACED]
