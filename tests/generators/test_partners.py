"""Partners generate their parts of one computer into one workspace: neither run touches what the other made."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.backend_manifests import find_backends
from archgen.pipeline import CheckedProject, check_project
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import select_elements
from archgen.products.workspace_product import WorkspaceResult, write_workspace
from archgen.views.generation.generation_context import GenerationContext
from tests.outside_tools import run_judge
from tests.property_sizes import try_some
from tests.running import ROOT

PARTS = ("owner:lab", "owner:works")
PROGRAMS = {
    "java": {"java/README.md", "java/generated/robot/ArchitectureTest.java", "java/generated/robot/RobotSystem.java"},
    "python_simulation": {
        "python/README.md",
        "python/robot_simulation/robot_system.py",
        "python/robot_simulation/test_architecture.py",
    },
}
"""What simulates is one program: these files are those of the part that was asked for last, as its page says."""
MODELS = {"aadl", "openrtm", "orocos", "player"}
"""What writes one model, or one deployment, for the whole of a part: each part is given a folder of its own."""
BACKENDS = [
    name for name, each in find_backends(ROOT / "docs")[0].items() if each.makes == "workspace" and name not in MODELS
]
PROJECT = """\
archgen: 1
project: {id: robot, title: Robot}
ros: {distro: DISTRO}
types:
  Scan: std_msgs/msg/String
  Pose: {fields: {x: float64}}
groups:
  sensing:
    owner: lab
    components:
      lidar: {functionality: Measures., outputs: {scan: {type: Scan}}, timing: {rate: 10 Hz}, parameters: {range: 3.5}}
      camera: {functionality: Sees., outputs: {seen: {type: Scan}}, parameters: {gain: 2}}
  moving:
    owner: works
    components:
      planner: {functionality: Plans., inputs: {scan: {from: lidar.scan}}, outputs: {pose: {type: Pose}}, parameters: {speed: 1.0}}
      driver: {functionality: Drives., inputs: {pose: {from: planner.pose}}}
nodes:
  lidar: {implements: lidar, host: pc, package: lab_nodes, executable: lidar}
  camera: {implements: camera, host: pc, package: lab_nodes, executable: camera, language: LANGUAGE}
  planner: {implements: planner, host: pc, package: works_nodes, executable: planner, start: {after: [lidar]}}
  driver: {implements: driver, host: board, package: works_nodes, executable: driver, kind: KIND, language: LANGUAGE}
hosts: {pc: {title: Computer}, board: {title: Board}}
partners: {lab: {title: Lab}, works: {title: Works}}
"""


def _check(folder: Path, distro: str) -> CheckedProject:
    folder.mkdir(exist_ok=True)
    kind, language = ("node", "python") if distro == "noetic" else ("lifecycle", "cpp")
    text = PROJECT.replace("DISTRO", distro).replace("KIND", kind).replace("LANGUAGE", language)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder)
    assert [each.message for each in checked.findings if str(each.severity) == "error"] == []
    return checked


def _generate(checked: CheckedProject, backend: str, selector: str, workspace: Path) -> WorkspaceResult:
    selection = select_elements(checked, selector)[0] if selector else None
    result = write_workspace(checked, OutputOptions(selection, selector), backend, workspace)
    assert result.plan is not None
    return result


def _read(workspace: Path) -> dict[str, bytes]:
    return {
        path.relative_to(workspace).as_posix(): path.read_bytes()
        for path in sorted(workspace.rglob("*"))
        if path.is_file() and ".archgen" not in path.parts
    }


def _without(files: dict[str, bytes], left_out: set[str]) -> dict[str, bytes]:
    return {path: data for path, data in files.items() if path not in left_out}


@pytest.mark.parametrize("backend", try_some(BACKENDS, 3))
def test_runs_of_two_partners_touch_nothing_of_one_another(backend: str, tmp_path: Path) -> None:
    checked = _check(tmp_path / "project", "noetic" if backend.startswith("ros1") else "jazzy")
    made: list[dict[str, bytes]] = []
    programs = PROGRAMS.get(backend, set())
    for name, parts in (("one", PARTS), ("other", PARTS[::-1])):
        workspace = tmp_path / name
        _generate(checked, backend, parts[0], workspace)
        before = _without(_read(workspace), programs)
        plan = _generate(checked, backend, parts[1], workspace).plan
        assert plan is not None
        verbs = {step.path: step.verb for step in plan.steps}
        assert {path for path, verb in verbs.items() if verb not in {"new", "same", "yours"}} == programs
        after = _read(workspace)
        assert {path: after.get(path) for path in before} == before
        made.append(after)
        again = _generate(checked, backend, parts[0], workspace).plan
        assert again is not None
        assert {step.path for step in again.steps if step.verb not in {"same", "yours"}} == programs
    assert _without(made[0], programs) == _without(made[1], programs)
    assert made[0]


def test_a_run_for_everything_takes_the_place_of_all_parts(tmp_path: Path) -> None:
    checked = _check(tmp_path / "project", "jazzy")
    for part in PARTS:
        _generate(checked, "ros2_launch", part, tmp_path / "ws")
    hosts = tmp_path / "ws/src/robot_bringup/launch/hosts"
    assert sorted(path.name for path in hosts.iterdir()) == [
        "board.owner-works.launch.xml",
        "pc.owner-lab.launch.xml",
        "pc.owner-works.launch.xml",
    ]
    assert 'exec="planner"' in (hosts / "pc.owner-works.launch.xml").read_text()
    assert 'exec="planner"' not in (hosts / "pc.owner-lab.launch.xml").read_text()
    _generate(checked, "ros2_launch", "", tmp_path / "ws")
    assert sorted(path.name for path in hosts.iterdir()) == ["board.launch.xml", "pc.launch.xml"]


def test_units_and_projects_of_partners_have_names_of_their_own(tmp_path: Path) -> None:
    checked = _check(tmp_path / "project", "jazzy")
    for part in PARTS:
        _generate(checked, "start", part, tmp_path / "ws")
    start = tmp_path / "ws/start"
    units = {path.name for path in (start / "systemd/pc").iterdir()}
    assert {"robot.owner-lab.target", "robot.owner-works.target", "robot.owner-lab-lidar.service"} <= units
    text = (start / "systemd/pc/robot.owner-works-planner.service").read_text()
    named = {
        word.partition("=")[2] for word in text.splitlines() if word.startswith(("Requires=", "After=", "PartOf="))
    }
    assert named <= units
    names = [
        (start / f"compose/pc.owner-{each}.yaml").read_text().partition("\nname: ")[2].split()[0]
        for each in ("lab", "works")
    ]
    assert names == ['"robot-owner-lab"', '"robot-owner-works"']
    for each in ("lab", "works"):
        script = start / f"hosts/pc.owner-{each}.sh"
        shown = run_judge(script, "--help")
        assert f"pc.owner-{each}" in shown.stdout


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("owner:lab", "owner_lab"),
        ("lab works", "lab_works"),
        ("lab  works", "Lab works"),
        ("tag:a", "owner:a"),
        ("a.b", "a:b"),
    ],
)
def test_different_selectors_name_different_parts(one: str, other: str, tmp_path: Path) -> None:
    architecture = _check(tmp_path, "jazzy").architecture
    names = [GenerationContext(architecture, selector=each).part for each in (one, other, f" {one} ")]
    assert names[0].lower() != names[1].lower()
    assert names[0] == names[2]
    assert all(set(each) <= set("abcdefghijklmnopqrstuvwxyz0123456789_.-") for each in names)
