"""The verbs of partners: interfaces and owners. Formats, where they go, and what wrong usage is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.agreeing import DUO, written
from tests.cli.conftest import Run
from tests.repositories import repository


@pytest.fixture
def duo(tmp_path: Path) -> Path:
    return written(tmp_path / "duo")


def test_markdown_goes_to_the_terminal(run: Run, duo: Path) -> None:
    ran = run("interfaces", duo, "--between", "north", "south")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("# North Robotics and South Vision\n\nInterface agreement\n")
    assert [path.name for path in duo.iterdir()] == ["archgen.yaml"]


@pytest.mark.parametrize(
    ("words", "name", "start"),
    [
        (("-o", "a.docx"), "a.docx", b"PK"),
        (("-o", "a.HTM"), "a.HTM", b"<!DOCTYPE html>"),
        (("-o", "a.txt", "--format", "markdown"), "a.txt", b"# North"),
        (("--format", "html"), "duo/archgen-out/interfaces/north-south.html", b"<!DOCTYPE html>"),
    ],
)
def test_the_ending_says_the_format(  # noqa: PLR0913, PLR0917 - the fixtures and the cases
    run: Run, duo: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], name: str, start: bytes
) -> None:
    monkeypatch.chdir(duo.parent)
    ran = run("interfaces", duo, "--between", "north", "south", *words)
    assert (ran.status, ran.out) == (0, f"wrote {name} (3 interfaces)\n")
    assert (duo.parent / name).read_bytes().startswith(start)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--between", "north", "sout"), "there is no partner `sout`; did you mean `south`?"),
        (("--between", "north", "north"), "an agreement is between two partners, and `north` was given twice"),
        (("--between", "west", "south"), "nothing flows between `west` and `south`; `west` has interfaces with north"),
        (("--between", "north", "south", "-o", "a.pdf"), "the ending of `a.pdf` names no format"),
        (("--between", "north", "south", "--since", "v9"), "--since: "),
        (("--between", "north"), "Option '--between' requires 2 arguments"),
        ((), "Missing option '--between'"),
    ],
)
def test_wrong_usage(run: Run, duo: Path, words: tuple[str, ...], said: str) -> None:
    ran = run("interfaces", duo, *words)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err
    assert [path.name for path in duo.iterdir()] == ["archgen.yaml"]


def test_since_an_unknown_revision_of_a_repository(run: Run, tmp_path: Path) -> None:
    folder = repository(tmp_path / "duo", {"archgen.yaml": DUO})
    ran = run("interfaces", folder, "--between", "north", "south", "--since", "v9")
    assert ran.status == 2
    assert "--since: there is no revision `v9`" in ran.err
    same = run("interfaces", folder, "--between", "north", "south", "--since", "HEAD")
    assert "> Nothing between the two has changed since HEAD (" in same.out


def test_errors_stop_it_unless_asked_otherwise(run: Run, tmp_path: Path) -> None:
    folder = written(tmp_path / "duo", DUO.replace("camera.image, planner", "camra.image, planner"))
    ran = run("interfaces", folder, "--between", "north", "south")
    assert (ran.status, ran.out) == (1, "")
    assert ran.err.endswith("Nothing was written. With --keep-going outputs are made of what is sound.\n")
    going = run("interfaces", folder, "--between", "north", "south", "--keep-going")
    assert going.status == 1
    assert "> The architecture has errors (1 error, " in going.out


def test_owners(run: Run, duo: Path) -> None:
    ran = run("owners", duo)
    assert (ran.status, ran.err) == (0, "")
    lines = ran.out.splitlines()
    assert lines[0].split() == ["Partner", "groups", "components", "nodes", "files", "reviewers"]
    assert lines[1].split() == ["North", "Robotics", "(north)", "1", "4", "1", "1", "@duo/north"]
    assert "  components: seeing.camera, seeing.finder, moving.calibration, moving.watch" in lines


def test_codeowners(run: Run, duo: Path) -> None:
    ran = run("owners", duo, "--format", "codeowners", "-o", duo / ".github" / "CODEOWNERS")
    assert ran.status == 0
    assert ran.err == (
        'warning: `west` owns files and has no reviewers: write `reviewers: "@organisation/team"` below `partners: west`\n'
    )
    assert (duo / ".github" / "CODEOWNERS").read_text(encoding="utf-8").splitlines()[3:] == [
        "",
        "# /archgen.yaml: west without reviewers",
        "/archgen.yaml @duo/north @duo/south lee@south.example",
    ]


def test_codeowners_of_a_broken_project_are_not_written(run: Run, broken: Path) -> None:
    ran = run("owners", broken, "--format", "codeowners")
    assert (ran.status, ran.out) == (1, "")
    assert "Nothing was written." in ran.err


def test_who_owns_what_stays_text(run: Run, tmp_path: Path) -> None:
    folder = written(
        tmp_path / "a", 'archgen: 1\npartners: {p: {title: "\\e[31m::error::x"}}\ngroups: {a: {title: A, owner: p}}\n'
    )
    ran = run("owners", folder)
    assert "\x1b" not in ran.out
    assert "␛[31m::error::x (p)" in ran.out
