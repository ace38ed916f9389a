"""Two partners change different components, and git merges their branches: only YAML may conflict, and a run mends the rest."""

from __future__ import annotations

import random
import subprocess
from itertools import combinations
from pathlib import Path

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.property_sizes import DRAWS_ANEW
from tests.repositories import git, repository

EDITS = 21
"""So many edits of one component each: every two of them are a pair."""
PAIRS = 120 if DRAWS_ANEW else 40
"""`make properties` tries more of the pairs."""
BACKENDS = ("ros2_python", "ros2_launch")
_GROUPS = ("eyes", "mind", "base", "arms", "voice")


def make_robot() -> dict[str, object]:
    """Return a project with five components in each group, each of which reads the one before."""
    names = [f"{group}.c{number}" for group in _GROUPS for number in range(5)]
    parts = {
        name: {
            "functionality": f"Does {name}.",
            "inputs": {"before": f"{names[place - 1]}.out"} if place else {},
            "outputs": {"out": "std_msgs/msg/Float32"},
            "parameters": {"gain": 1.0},
            "timing": {"rate": "10 Hz"},
        }
        for place, name in enumerate(names)
    }
    return {
        group: {"components": {name.partition(".")[2]: parts[name] for name in names if name.startswith(f"{group}.")}}
        for group in _GROUPS
    }


def edit(robot: dict[str, object], group: str, component: str, draw: random.Random) -> None:
    """Change one component in a way that people do: each way leads into other generated files."""
    body = robot[group]["components"][component]  # type: ignore[index]
    way = draw.randrange(7)
    word = f"{component}_{draw.randrange(1000)}"
    if way == 0:
        body["outputs"][word] = "std_msgs/msg/Bool"
    elif way == 1:
        body["inputs"][word] = f"{draw.choice(_GROUPS)}.c{draw.randrange(5)}.out"
    elif way == 2:
        body["parameters"][word] = draw.randrange(100)
    elif way == 3:
        body["timing"]["rate"] = f"{draw.randrange(11, 50)} Hz"
    elif way == 4:
        body["outputs"]["out"] = {"type": "std_msgs/msg/Float32", "description": f"What {word} says."}
    elif way == 5:
        body["functionality"] = f"Does {word}, and better."
    else:
        body["outputs"][word] = "std_srvs/srv/Trigger"


def write_files(folder: Path, robot: dict[str, object]) -> dict[str, str]:
    """Write a project with a file for each group; return its files."""
    files = {"archgen.yaml": "archgen: 1\nproject: {id: bot}\nros: {distro: jazzy}\n"}
    for group, body in robot.items():
        files[f"{group}.yaml"] = yaml.safe_dump({"groups": {group: body}}, sort_keys=False)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return files


def generate(folder: Path) -> list[str]:
    """Generate all of it; return the files that somebody else seems to have changed."""
    checked = check_project(folder)
    assert not checked.has_errors, [each.message for each in checked.findings][:5]
    said: list[str] = []
    for backend in BACKENDS:
        result = write_workspace(checked, OutputOptions(), backend, folder / "ws", WorkspaceRequest())
        assert result.plan is not None
        said += [f"{step.verb} {step.path}" for step in result.plan.conflicts]
    return said


def save(folder: Path, branch: str) -> None:
    git(folder, "checkout", "-q", "-b", branch)
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", branch)


@pytest.mark.slow
@pytest.mark.hypothesis
def test_only_yaml_conflicts_and_a_run_mends_the_rest(tmp_path: Path) -> None:
    draw = random.Random(7)  # noqa: S311 - the same edits each time
    folder = repository(tmp_path / "bot", {"readme": "x\n"})
    write_files(folder, make_robot())
    assert generate(folder) == []
    save(folder, "start")
    edited = draw.sample([(group, f"c{number}") for group in _GROUPS for number in range(5)], EDITS)
    for number, (group, component) in enumerate(edited):
        git(folder, "checkout", "-q", "start")
        robot = make_robot()
        edit(robot, group, component, draw)
        write_files(folder, robot)
        assert generate(folder) == []
        save(folder, f"edit{number}")
    pairs = draw.sample(list(combinations(range(EDITS), 2)), PAIRS)
    merged = 0
    for first, second in pairs:
        git(folder, "checkout", "-q", "-f", f"edit{first}")
        try:
            git(folder, "merge", "-q", "--no-edit", f"edit{second}")
        except subprocess.CalledProcessError:
            conflicts = git(folder, "diff", "--name-only", "--diff-filter=U").splitlines()
            assert all(each.endswith(".yaml") and "/" not in each for each in conflicts), (first, second, conflicts)
            git(folder, "reset", "-q", "--hard")
            continue
        merged += 1
        assert generate(folder) == [], (first, second)
        git(folder, "reset", "-q", "--hard")
        git(folder, "clean", "-q", "-f", "-d")
    assert merged > 0.75 * PAIRS
