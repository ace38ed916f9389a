"""Repositories that are damaged, or set up to mislead: each is said in words, and none is waited for without end."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen import git
from archgen.git import git_call, object_reader
from tests import repositories
from tests.cli.conftest import Run, run  # noqa: F401 - a fixture

PROJECT = "archgen: 1\nproject: {id: x}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    folder = repositories.repository(tmp_path / "top", {"robot/archgen.yaml": PROJECT})
    repositories.commit(folder, {"robot/archgen.yaml": PROJECT + "# more\n"})
    return folder / "robot"


def _find_object_file(robot: Path, name: str) -> Path:
    object_id = repositories.git(robot, "rev-parse", name)
    return robot.parent / ".git" / "objects" / object_id[:2] / object_id[2:]


@pytest.mark.parametrize("name", ["HEAD^{tree}", "HEAD:robot", "HEAD^^{tree}"])
@pytest.mark.parametrize(
    "words", [("stats", "--history"), ("diff", "HEAD"), ("diff", "HEAD^"), ("build", "--only", "site")]
)
def test_a_damaged_folder_is_no_missing_project(run: Run, robot: Path, name: str, words: tuple[str, ...]) -> None:  # noqa: F811
    file = _find_object_file(robot, name)
    file.chmod(0o644)
    file.write_bytes(b"damaged")
    ran = run(*words, *(("-C",) if words[0] == "diff" else ()), robot)
    assert "mistake in archgen" not in ran.err
    assert "does not exist in" not in ran.err
    if words[0] == "stats" or (words == ("diff", "HEAD") and name != "HEAD^^{tree}"):
        assert ran.status == 2
        assert "the repository is damaged (`git fsck` says where)" in ran.err


def test_a_work_tree_elsewhere_is_said(run: Run, robot: Path) -> None:  # noqa: F811
    repositories.git(robot, "config", "core.worktree", "/")
    ran = run("diff", "HEAD^", "-C", robot)
    assert ran.status == 2
    assert "has its files elsewhere (`core.worktree`)" in ran.err
    assert run("check", robot).status == 0


@pytest.mark.parametrize("name", ["HEAD:robot", "HEAD:robot/archgen.yaml"])
def test_git_that_does_not_answer_is_not_waited_for(
    run: Run,  # noqa: F811
    robot: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
) -> None:
    file = _find_object_file(robot, name)
    file.unlink()
    os.mkfifo(file)
    monkeypatch.setattr(git_call, "ANSWER_SECONDS", 1)
    monkeypatch.setattr(object_reader, "ANSWER_SECONDS", 1)
    ran = run("diff", "HEAD", "-C", robot)
    assert ran.status == 2
    assert "mistake in archgen" not in ran.err


def test_a_tree_that_is_asked_for_as_a_file_does_not_shift_the_answers(robot: Path) -> None:
    objects = git.GitObjects(git.find_repository(robot))
    tree, blob = (repositories.git(robot, "rev-parse", name) for name in ("HEAD:robot", "HEAD:robot/archgen.yaml"))
    assert objects.read_blob(tree) is None
    assert objects.read_blob(blob) == (PROJECT + "# more\n").encode()
