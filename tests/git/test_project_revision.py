"""The revision of a project's files, from git's objects alone."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from archgen.git.project_revision import find_revision


def _git(folder: Path, *words: str) -> str:
    environment = {
        **os.environ,
        "GIT_CONFIG_GLOBAL": os.devnull,
        "GIT_AUTHOR_NAME": "A",
        "GIT_AUTHOR_EMAIL": "a@example.org",
        "GIT_COMMITTER_NAME": "A",
        "GIT_COMMITTER_EMAIL": "a@example.org",
    }
    done = subprocess.run(["git", *words], cwd=folder, env=environment, capture_output=True, text=True, check=True)  # noqa: S603, S607
    return done.stdout.strip()


def _repository(folder: Path) -> Path:
    _git(folder, "init", "-q")
    (folder / "robot").mkdir()
    (folder / "robot" / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    (folder / "other.txt").write_text("x", encoding="utf-8")
    _git(folder, "add", ".")
    _git(folder, "commit", "-qm", "first")
    return folder / "robot"


def test_last_commit_that_touched_the_files(tmp_path: Path) -> None:
    project = _repository(tmp_path)
    first = _git(tmp_path, "rev-parse", "--short", "HEAD")
    (tmp_path / "other.txt").write_text("y", encoding="utf-8")
    _git(tmp_path, "commit", "-qam", "elsewhere")
    assert find_revision(project, ["archgen.yaml"]) == first


def test_a_changed_or_new_file_adds_a_plus(tmp_path: Path) -> None:
    project = _repository(tmp_path)
    first = _git(tmp_path, "rev-parse", "--short", "HEAD")
    (project / "new.yaml").write_text("groups: {}\n", encoding="utf-8")
    assert find_revision(project, ["archgen.yaml", "new.yaml"]) == f"{first}+"
    (project / "archgen.yaml").write_text("archgen: 1 # changed\n", encoding="utf-8")
    assert find_revision(project, ["archgen.yaml"]) == f"{first}+"


def test_line_ends_that_git_converts_are_no_change(tmp_path: Path) -> None:
    project = _repository(tmp_path)
    (project / "archgen.yaml").write_bytes(b"archgen: 1\r\n")
    assert not find_revision(project, ["archgen.yaml"]).endswith("+")


def test_outside_of_git_there_is_none(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    assert find_revision(tmp_path, ["archgen.yaml"]) == ""
    assert find_revision(tmp_path, []) == ""


def test_before_the_first_commit_there_is_none(tmp_path: Path) -> None:
    _git(tmp_path, "init", "-q")
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    assert find_revision(tmp_path, ["archgen.yaml"]) == ""


def test_the_repository_runs_no_program(tmp_path: Path) -> None:
    project = _repository(tmp_path)
    trap = tmp_path / "ran"
    script = tmp_path / "trap.sh"
    script.write_text(f"#!/bin/sh\ntouch {trap}\ncat\n", encoding="utf-8")
    script.chmod(0o755)
    for key in ("core.fsmonitor", "filter.x.clean", "filter.x.smudge", "core.pager", "gpg.program", "diff.external"):
        _git(tmp_path, "config", key, str(script))
    _git(tmp_path, "config", "log.showSignature", "true")
    (tmp_path / ".gitattributes").write_text("* filter=x diff=x\n", encoding="utf-8")
    (project / "archgen.yaml").write_text("archgen: 1 # changed\n", encoding="utf-8")
    assert find_revision(project, ["archgen.yaml"]).endswith("+")
    assert not trap.exists()
