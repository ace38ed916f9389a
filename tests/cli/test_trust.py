"""Own backends in the review of a pull request: they run where the trusted revision names them, and only there."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import repositories
from tests.running import archgen

PROJECT = """\
archgen: 1
groups: {a: {components: {b: {functionality: Waits., inputs: {x: {external: The world}}}}}}
nodes: {b: {implements: b, subscribes: {x: {topic: x, message: std_msgs/msg/Empty}}}}
"""
BACKEND: dict[str, str | bytes] = {
    "backends/mine/backend.yaml": "{id: mine, title: Mine, emitter: text, view: record, "
    "files: [{template: t.txt.j2, path: t.txt}]}",
    "backends/mine/templates/t.txt.j2": "made\n",
}


@pytest.mark.parametrize(("allowed", "runs"), [("", False), ("review: {backends: [other]}\n", False), ("", True)])
def test_a_backend_of_the_branch_runs_only_if_the_main_line_names_it(
    tmp_path: Path, allowed: str, *, runs: bool
) -> None:
    main = "review: {backends: [mine]}\n" if runs else allowed
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT + main})
    repositories.git(folder, "checkout", "-q", "-b", "stranger")
    repositories.commit(folder, {**BACKEND, "archgen.yaml": PROJECT + "review: {backends: [mine]}\n"})
    words = ("build", "-o", tmp_path / "out", "--backend", "mine", "--trust", "main", "--select", "b")
    done = archgen(*words, cwd=folder, status=0 if runs else 2)
    if runs:
        assert (tmp_path / "out/mine/t.txt").read_text() == "made\n"
    else:
        assert b"the project's own backend `mine` is not run here" in done.stderr
        assert not (tmp_path / "out").exists()


def test_a_shipped_backend_needs_no_leave_and_an_unknown_revision_is_wrong_usage(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT})
    archgen("build", "-o", tmp_path / "out", "--backend", "wiki", "--trust", "HEAD", cwd=folder)
    assert list((tmp_path / "out/wiki").iterdir())
    done = archgen("build", "-o", tmp_path / "out", "--backend", "mine", "--trust", "nowhere", cwd=folder, status=2)
    assert b"nowhere" in done.stderr
