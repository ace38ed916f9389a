"""A small project that has something for each output, as a repository, and everything that archgen makes of it in a process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.repositories import commit, git, repository
from tests.running import ROOT, contents, made_once

_PROGRAM = ROOT / "tests" / "every_output.py"
_SECOND_PARTNER = """\
groups:
  watching:
    owner: q
    components:
      watcher:
        inputs: {way: navigation.way}
        outputs: {alarm: Alarm}
        requirements: [R-1, R-2]
        node: {package: watching, executable: watcher}
        timing: {wcet: 3 ms}
      lamp: {inputs: {alarm: watcher.alarm}, timing: {wcet: 1 ms}}
types: {Alarm: std_msgs/msg/Bool}
requirements: {R-1: {title: Says where it is}, R-2: {title: Says so in time, parent: R-1}}
use_cases: {clean: {title: It cleans}}
"""


def make_project(folder: Path) -> Path:
    """Make the project in a folder; its two commits are the same ones everywhere."""
    text = (ROOT / "examples/cleaning_robot/archgen.yaml").read_text("utf-8")
    text = text.replace("  cleaning:\n", "  cleaning:\n    owner: p\n") + "partners: {p: Cleaners, q: Wächter}\n"
    repository(folder, {"archgen.yaml": text.replace("600 ms", "900 ms")}, day="2026-02-01")
    commit(folder, {"archgen.yaml": text, "watching.yaml": _SECOND_PARTNER}, "2026-02-02")
    git(folder, "config", "user.name", "Clerk")
    git(folder, "config", "user.email", "clerk@x.org")
    return folder


def make_every_output_once(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> dict[str, bytes]:
    """Make every output by the Python of the tests, with no settings, once for all of pytest's workers; return the files."""
    base = tmp_path_factory.getbasetemp()
    place = (base if worker_id == "master" else base.parent) / "every output"

    def make(folder: Path) -> None:
        run_every_output(sys.executable, make_project(folder / "robot"), folder / "out", {"PYTHONPATH": str(ROOT)})

    return contents(made_once(place, make) / "out")


def run_every_output(
    python: str | Path, project: Path, out: Path, environment: Mapping[str, str], processors: int = 2
) -> dict[str, bytes]:
    """Make every output by a Python with settings of its own; return the files."""
    words = (python, "-c", f"import runpy; runpy.run_path({str(_PROGRAM)!r}, run_name='__main__')", project, out)
    done = subprocess.run(  # noqa: S603 - our own program
        [*map(str, words), str(processors)],
        cwd=project,
        # A width that somebody set (a CI does) would be one of the settings.
        env={**os.environ, "COLUMNS": "", **environment},
        capture_output=True,
        check=False,
        timeout=1800,
    )
    assert done.returncode == 0, done.stderr.decode("utf-8", "replace")[-3000:]
    return contents(out)
