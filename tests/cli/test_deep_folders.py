"""Folders that nest deeper than Python calls: git carries them, and a branch may bring them."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Run

PROJECT = 'archgen: 1\nproject: {id: x}\nsources: ["**/*.yaml"]\n'
MANIFEST = "id: mine\ntitle: M\nemitter: text\nview: record\nfiles: [{template: t, path: t}]\n"


def _nest_folders(top: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make 1,500 folders, each in the last, with a file in the innermost."""
    top.mkdir(parents=True, exist_ok=True)
    with monkeypatch.context() as context:
        context.chdir(top)
        for _ in range(1500):
            os.mkdir("a")  # noqa: PTH102 - relative to the current folder
            os.chdir("a")
        Path("deep.yaml").write_text("groups: {g: {}}\n", encoding="utf-8")


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Path]:
    yield repositories.repository(tmp_path / "r", {"archgen.yaml": PROJECT})
    # pytest takes away its old folders itself, three runs later, and calls itself for each folder in a folder.
    subprocess.run(["rm", "-rf", tmp_path / "r"], check=True)  # noqa: S603, S607 - a folder of this test


@pytest.mark.slow
def test_a_deep_file_is_read_from_disk_and_from_a_commit(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _nest_folders(robot, monkeypatch)
    assert "mistake in archgen" not in run("check", robot).err
    assert "`g`" in run("diff", "HEAD", "-C", robot).out
    repositories.commit(robot, {})
    assert run("diff", "HEAD", "-C", robot).out == "no changes\n"


@pytest.mark.slow
@pytest.mark.parametrize("place", ["templates", "assets"])
def test_deep_folders_of_a_backend_are_its_own_mistake(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    (robot / "backends/mine/templates").mkdir(parents=True)
    (robot / "backends/mine/backend.yaml").write_text(MANIFEST, encoding="utf-8")
    (robot / "backends/mine/templates/t").write_text("made", encoding="utf-8")
    (robot / "archgen.yaml").write_text("archgen: 1\nproject: {id: x}\nreview: {backends: [mine]}\n", encoding="utf-8")
    repositories.commit(robot, {})
    _nest_folders(robot / "backends/mine" / place, monkeypatch)
    ran = run("build", robot, "--only", "mine")
    assert ran.status == (2 if place == "assets" else 0)
    assert ("the backend `mine` fails: the path `assets/a/a/" in ran.err) is (place == "assets")
    assert "it differs from the one in `HEAD`" in run("build", robot, "--only", "mine", "--trust", "HEAD").err


@pytest.mark.slow
def test_deep_folders_among_the_outputs_are_no_obstacle(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (robot / "archgen.yaml").write_text("archgen: 1\nproject: {id: x}\n", encoding="utf-8")
    _nest_folders(robot / "archgen-out/wiki", monkeypatch)
    ran = run("build", robot, "--only", "wiki")
    assert ran.status == 2
    assert "holds files that archgen did not write" in ran.err
