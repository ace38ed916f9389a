"""Own backends in the review of a pull request: they run where the trusted revision names them and holds the same files."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Run
from tests.property_sizes import try_some
from tests.running import archgen_here

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
    folder = repositories.repository(tmp_path / "robot", {**BACKEND, "archgen.yaml": PROJECT + main})
    repositories.git(folder, "checkout", "-q", "-b", "stranger")
    repositories.commit(folder, {**BACKEND, "archgen.yaml": PROJECT + "review: {backends: [mine]}\n"})
    words = ("build", "-o", tmp_path / "out", "--backend", "mine", "--trust", "main", "--select", "b")
    done = archgen_here(*words, cwd=folder, status=0 if runs else 2)
    if runs:
        assert (tmp_path / "out/mine/t.txt").read_text() == "made\n"
    else:
        assert b"the project's own backend `mine` is not run here" in done.stderr
        assert not (tmp_path / "out").exists()


def test_a_shipped_backend_needs_no_leave_and_an_unknown_revision_is_wrong_usage(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT})
    archgen_here("build", "-o", tmp_path / "out", "--backend", "wiki", "--trust", "HEAD", cwd=folder)
    assert list((tmp_path / "out/wiki").iterdir())
    done = archgen_here(
        "build", "-o", tmp_path / "out", "--backend", "mine", "--trust", "nowhere", cwd=folder, status=2
    )
    assert b"nowhere" in done.stderr


ALLOWED = {**BACKEND, "archgen.yaml": PROJECT + "review: {backends: [mine]}\n"}
MINE = Path("backends/mine")


def _make_unreadable_pipe(robot: Path) -> None:
    os.mkfifo(robot / MINE / "pipe")


@pytest.mark.parametrize(
    ("change", "difference"),
    [
        (
            lambda robot: (robot / MINE / "templates/t.txt.j2").write_text("evil\n"),
            "`backends/mine/templates/t.txt.j2`",
        ),
        (
            lambda robot: (robot / MINE / "backend.yaml").write_text(str(ALLOWED["backends/mine/backend.yaml"]) + "\n"),
            "`backends/mine/backend.yaml`",
        ),
        (lambda robot: (robot / MINE / "backend.yaml").write_bytes(b"x" * 65_000), None),
        (lambda robot: (robot / MINE / "templates/more.j2").write_text(""), "`backends/mine/templates/more.j2`"),
        (lambda robot: (robot / MINE / "README").write_text("harmless"), "`backends/mine/README`"),
        (
            lambda robot: (robot / MINE / "templates/t.txt.j2").write_text("made\n\n"),
            "`backends/mine/templates/t.txt.j2`",
        ),
        (_make_unreadable_pipe, "`backends/mine/pipe`"),
        (
            lambda robot: [(robot / MINE / f"{n}").write_text("") for n in range(5)],
            "`backends/mine/0`, `backends/mine/1`, `backends/mine/2` and 2 more",
        ),
        (
            lambda robot: (
                (robot / MINE / "templates/t.txt.j2").rename(robot / "t"),
                (robot / MINE / "templates/t.txt.j2").symlink_to("../../../t"),
            ),
            "`backends/mine/templates/t.txt.j2`",
        ),
    ],
)
def test_a_backend_that_the_branch_changed_does_not_run(
    run: Run, tmp_path: Path, change: Callable[[Path], object], difference: str | None
) -> None:
    folder = repositories.repository(tmp_path / "robot", ALLOWED)
    change(folder)
    # Committed in the branch or not is all the same: what counts is what stands on disk.
    ran = run("build", folder, "-o", tmp_path / "out", "--only", "mine", "--trust", "main")
    assert ran.status == 2
    assert not (tmp_path / "out").exists()
    if difference:
        assert ran.err == (
            "Error: the project's own backend `mine` is not run here: it differs from the one in `main`: "
            f"{difference}; bring its change into `main` first, or this branch up to date with `main`\n"
        )


def test_a_file_that_the_branch_takes_away_counts(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {**ALLOWED, "backends/mine/templates/macros.j2": "x"})
    (folder / MINE / "templates/macros.j2").unlink()
    ran = run("build", folder, "-o", tmp_path / "out", "--only", "mine", "--trust", "main")
    assert "it differs from the one in `main`: `backends/mine/templates/macros.j2`;" in ran.err


def test_a_backend_that_is_new_in_the_branch_does_not_run_under_an_allowed_name(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": ALLOWED["archgen.yaml"]})
    repositories.git(folder, "checkout", "-q", "-b", "stranger")
    repositories.commit(folder, BACKEND)
    ran = run("build", folder, "-o", tmp_path / "out", "--only", "mine", "--trust", "main")
    assert (ran.status, ran.err) == (
        2,
        (
            "Error: the project's own backend `mine` is not run here: `main` has no folder `backends/mine`; "
            "bring the folder into `main` first, in a change of its own\n"
        ),
    )


@pytest.mark.parametrize(
    "change",
    try_some(
        [
            lambda _robot: None,
            lambda robot: (robot / MINE / "templates/t.txt.j2").chmod(0o755),  # never executed
            lambda robot: (robot / MINE / "templates/t.txt.j2").write_bytes(b"made\r\n"),  # git's conversion on Windows
            lambda robot: (robot / MINE / "empty/folders").mkdir(parents=True),  # git knows none
            lambda robot: (robot / "backends/other").mkdir(),
            lambda robot: (robot / "groups.yaml").write_text("groups: {}\n"),
        ],
        2,
    ),
)
def test_a_backend_that_is_the_same_runs(run: Run, tmp_path: Path, change: Callable[[Path], object]) -> None:
    folder = repositories.repository(
        tmp_path / "robot", {**ALLOWED, "backends/mine/assets/logo.bin": b"\x00\r\n\xff", "backends/mine/empty.j2": ""}
    )
    (folder / MINE / "templates/alias.j2").symlink_to("t.txt.j2")
    repositories.commit(folder, {})
    change(folder)
    assert run("build", folder, "-o", tmp_path / "out", "--only", "mine", "--trust", "main").status == 0
    assert (tmp_path / "out/mine/t.txt").read_text() == "made\n"


@pytest.mark.parametrize("is_linked", [False, True])
def test_a_project_in_a_subfolder_has_its_backends_compared_there(run: Run, tmp_path: Path, *, is_linked: bool) -> None:
    top = repositories.repository(tmp_path / "top", {f"robots/one/{name}": text for name, text in ALLOWED.items()})
    # A folder of the same name elsewhere in the repository is another one.
    repositories.commit(top, {"backends/mine/templates/t.txt.j2": "evil\n"})
    folder = top / "robots/one"
    if is_linked:
        folder = tmp_path / "way"
        folder.symlink_to(top / "robots/one")
    assert run("build", folder, "-o", tmp_path / "out", "--only", "mine", "--trust", "main").status == 0
    (folder / MINE / "templates/t.txt.j2").write_text("evil\n")
    assert "it differs from the one in `main`" in run("build", folder, "--only", "mine", "--trust", "main").err


def test_a_review_makes_the_rest_and_says_which_backend_is_missing(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", ALLOWED)
    repositories.git(folder, "checkout", "-q", "-b", "partner")
    repositories.commit(folder, {"backends/mine/templates/t.txt.j2": "better\n"})
    ran = run("review", folder, "--base", "main", "--backend", "mine", "--backend", "wiki", "-o", tmp_path / "out")
    assert ran.status == 0
    assert "warning: the project's own backend `mine` is not run here: it differs from the one in `main`" in ran.err
    assert {path.name for path in (tmp_path / "out/outputs").iterdir()} >= {"site", "report.docx", "wiki"}
    assert not (tmp_path / "out/outputs/mine").exists()


@pytest.mark.parametrize("template", ["{{ '\\ud800' }}", "{{ nobody }}"])
def test_a_mistake_in_a_backend_costs_its_own_output_alone(run: Run, tmp_path: Path, template: str) -> None:
    folder = repositories.repository(tmp_path / "robot", {**ALLOWED, "backends/mine/templates/t.txt.j2": template})
    words = ("--only", "packed", "--backend", "mine", "--backend", "wiki")
    ran = run("build", folder, "-o", tmp_path / "out", *words)
    assert ran.status == 2
    assert ran.err.startswith("Error: backends/mine/templates/t.txt.j2:1:1: the backend `mine` fails: ")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"packed.yaml", "wiki"}
