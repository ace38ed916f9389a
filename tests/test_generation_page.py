"""The generator of docs/own_generators.md works as the page says."""

from __future__ import annotations

import ast
import json
import re
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import Run, run
from tests.running import ROOT

__all__ = ["run"]
PROJECT = """\
archgen: 1
project: {id: robot}
types:
  Grip: {comment: "How \\"wide\\"\\nit is", fields: {width: {type: float64, unit: m}, pose: geometry_msgs/Pose}}
groups: {g: {components: {a: {functionality: Grips., outputs: {grip: Grip}}, b: {functionality: Looks., inputs: {grip: a.grip}}}}}
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Make a project with the generator of the page."""
    page = (ROOT / "docs" / "own_generators.md").read_text("utf-8")
    for text in re.findall(r"```(?:yaml|jinja)\n(.*?)```", page, re.DOTALL):
        path = tmp_path / text.splitlines()[0].strip("#{} ")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.partition("\n")[2], "utf-8")
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    return tmp_path


@pytest.mark.parametrize(
    "view", ["interfaces", "programs", "components", "plan", "structure", "ros2_launch", "middleware"]
)
def test_a_template_shows_all_of_a_view(run: Run, robot: Path, view: str) -> None:
    """As the page says of those whose keys it does not list."""
    folder = robot / "backends" / "all_of_it"
    (folder / "templates").mkdir(parents=True)
    manifest = f"id: all_of_it\ntitle: All\nmakes: workspace\nemitter: text\nview: {view}\nfiles: [{{template: a.j2, path: a.json}}]\n"
    (folder / "backend.yaml").write_text(manifest)
    (folder / "templates" / "a.j2").write_text(f"{{{{ {view}|tojson(2) }}}}\n")
    assert run("generate", "all_of_it", "-C", robot, "-o", robot / "ws").status == 0
    assert json.loads((robot / "ws/a.json").read_text())


def test_the_generator_of_the_page(run: Run, robot: Path) -> None:
    workspace = robot / "ws"
    ran = run("generate", "message_stubs", "-C", robot, "-o", workspace)
    assert (ran.status, ran.err) == (0, "")
    stub = (workspace / "stubs" / "stub_grip.py").read_text()
    assert stub == (
        "# Made by archgen from Grip.\n"
        "class Grip:\n"
        "    comment = 'How \"wide\"\\nit is'\n\n"
        "    def __init__(self):\n"
        "        self.width = None  # float64\n"
        "        self.pose = None  # geometry_msgs/Pose\n"
    )
    ast.parse(stub)
    done = subprocess.run([workspace / "run_all.sh"], capture_output=True, check=True)  # noqa: S603 - just made
    assert done.stdout == b"Grip\n"


def test_what_a_later_run_does(run: Run, robot: Path) -> None:
    workspace = robot / "ws"
    run("generate", "message_stubs", "-C", robot, "-o", workspace)
    (robot / "archgen.yaml").write_text(PROJECT.replace("  Grip:", "  Mode: {values: [IDLE, RUN]}\n  Grip:"))
    (workspace / "run_all.sh").write_text("#!/bin/sh\n# mine\n")
    (workspace / "own" / "convert.py").write_text("def read_grip(message):\n    return message.width\n")
    (workspace / "stubs" / "stub_mode.py").write_text("mine")
    ran = run("generate", "message_stubs", "-C", robot, "-o", workspace)
    assert ran.status == 1
    assert ran.err.splitlines() == [
        "error: own/convert.py:1:1: it lacks `read_mode`",
        (
            "error: run_all.sh was changed by hand since archgen wrote it, and stays as it is; `--overwrite run_all.sh` takes the "
            "new one, `--keep run_all.sh` keeps yours for good"
        ),
        (
            "error: stubs/stub_mode.py is a file of yours, since `.archgen` records nothing of it, and stays as it is; move it away "
            "for the new one, keep it for good with `--keep stubs/stub_mode.py`, or bring a record back that was lost"
        ),
    ]
    ran = run(
        "generate",
        "message_stubs",
        "-C",
        robot,
        "-o",
        workspace,
        "--overwrite",
        workspace / "run_all.sh",
        "--keep",
        "stubs",
        "--dry-run",
    )
    assert (ran.status, ran.out.splitlines()) == (
        1,
        [
            "yours    own/convert.py",
            "changed  run_all.sh",
            "yours    stubs/stub_grip.py",
            "yours    stubs/stub_mode.py",
        ],
    )
    assert (workspace / "run_all.sh").read_text() == "#!/bin/sh\n# mine\n"
