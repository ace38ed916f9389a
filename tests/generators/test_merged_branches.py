"""Two partners change different components of the case study on two branches: git merges what is generated, and nobody's hand is seen."""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

from tests.running import ROOT, archgen_here

SETTINGS = (
    "\ngenerate:\n  into: ../ws\n  backends: {ros_interfaces: , ros2_python: , ros2_cpp: , ros2_launch: , start: }\n"
)
COMPONENT = re.compile(r"    (?:  )?([a-z][a-z0-9_]*):$")


def git(folder: Path, *words: str, check: bool = True) -> str:
    command = ("git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false", *words)
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=check).stdout  # noqa: S603


def generate(folder: Path, *words: str, status: int = 0) -> str:
    done = archgen_here("generate", *words, "-C", "robot", cwd=folder, status=status)
    return (done.stdout + done.stderr).decode()


def list_components(robot: Path) -> list[tuple[str, str]]:
    """Return the components that have outputs: file and id."""
    return [
        (file.name, component)
        for file in sorted((robot / "groups").glob("*.yaml"))
        for group in (yaml.safe_load(file.read_bytes()).get("groups") or {}).values()
        for component, body in group["components"].items()
        if isinstance(body, dict) and isinstance(body.get("outputs"), dict)
    ]


def edit(robot: Path, file: str, component: str, name: str, draw: random.Random) -> None:
    """Give a component an output or a parameter, or put a comment there, which moves all lines below."""
    path = robot / "groups" / file
    lines = path.read_text(encoding="utf-8").splitlines()
    start = next(i for i, line in enumerate(lines) if (found := COMPONENT.match(line)) and found[1] == component)
    pad = " " * (len(lines[start]) - len(lines[start].lstrip()) + 2)
    end = next(
        (i for i in range(start + 1, len(lines)) if lines[i].strip() and not lines[i].startswith(pad)), len(lines)
    )
    kind = draw.choice(["output", "parameter", "comment"])
    outputs = next((i for i in range(start, end) if lines[i] == f"{pad}outputs:"), None)
    if kind == "output" and outputs is not None:
        lines.insert(outputs + 1, f"{pad}  {name}: std_msgs/Float64")
    elif kind == "parameter" and not any(lines[i].startswith(f"{pad}parameters:") for i in range(start, end)):
        lines.insert(start + 1, f"{pad}parameters: {{{name}: 1}}")
    else:
        lines[start + 1 : start + 1] = [f"{pad}# What {name} says", f"{pad}# of it."]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


@pytest.mark.slow
def test_branches_of_different_components_merge(tmp_path: Path) -> None:
    robot = tmp_path / "robot"
    shutil.copytree(ROOT / "example_ramcip", robot, ignore=shutil.ignore_patterns("archgen-out", ".archgen*"))
    with (robot / "archgen.yaml").open("a", encoding="utf-8") as stream:
        stream.write(SETTINGS)
    git(tmp_path, "init", "-q", "-b", "main")
    generate(tmp_path)
    git(tmp_path, "add", "-A")
    git(tmp_path, "commit", "-qm", "first")
    components = list_components(robot)
    for seed in range(4):
        draw = random.Random(seed)  # noqa: S311 - a draw, no secret
        for branch, (file, component) in zip("ab", draw.sample(components, 2), strict=True):
            git(tmp_path, "checkout", "-qf", "-B", branch, "main")
            edit(robot, file, component, f"extra_{branch}", draw)
            generate(tmp_path)
            git(tmp_path, "add", "-A")
            git(tmp_path, "commit", "-qm", branch)
        git(tmp_path, "merge", "-q", "a", check=False)
        assert [
            path for path in git(tmp_path, "diff", "--name-only", "--diff-filter=U").split() if path.startswith("ws/")
        ] == []
        said = generate(tmp_path)
        assert "by hand" not in said
        assert "is a file of yours" not in said
        assert generate(tmp_path, "--check") == ""
