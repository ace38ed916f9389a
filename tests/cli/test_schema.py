"""`archgen schema`, and `archgen check`, which renews what it wrote: on a terminal, and never in a workflow."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.repositories import git

SCHEMA = ".vscode/archgen.schema.json"


def add_host(folder: Path) -> None:
    with (folder / "archgen.yaml").open("a", encoding="utf-8") as file:
        file.write("\nhosts:\n  new_pc: New\n")


def test_it_is_written_and_said_where(run: Run, tmp_path: Path) -> None:
    assert run("init", tmp_path / "r").status == 0
    (tmp_path / "r" / SCHEMA).unlink()
    ran = run("schema", tmp_path / "r")
    assert (ran.status, ran.out, ran.err) == (0, f"wrote {tmp_path}/r/{SCHEMA}\n", "")
    assert run("schema", tmp_path / "r").out == f"{tmp_path}/r/{SCHEMA} is up to date\n"


def test_it_goes_where_it_is_asked_to(run: Run, first: Path) -> None:
    run("schema", first, "-o", first / "a.json")
    assert run("schema", first, "-o", "-").out == (first / "a.json").read_text(encoding="utf-8")
    assert "devices.lidar.scan" in json.loads((first / "a.json").read_bytes())["$defs"]["offered_sources"]["enum"]


def test_a_file_of_the_project_is_not_replaced(run: Run, first: Path) -> None:
    ran = run("schema", first, "-o", first / "archgen.yaml")
    assert ran.status == 2
    assert "is no schema that archgen wrote" in ran.err


def test_what_cannot_be_read_is_said(run: Run, broken: Path) -> None:
    with (broken / "archgen.yaml").open("a", encoding="utf-8") as file:
        file.write("  x: [\n")
    ran = run("schema", broken)
    assert ran.status == 0
    assert "warning: names of what cannot be read are missing: `archgen check` says what to mend\n" in ran.err


def test_without_a_project_it_is_wrong_usage(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("schema").status == 2


@pytest.mark.parametrize(
    ("on_terminal", "variable", "is_renewed"), [(True, "", True), (True, "true", False), (False, "", False)]
)
def test_check_renews_it_for_people_only(  # noqa: PLR0913, PLR0917 - three of them are fixtures
    on_terminal: bool,  # noqa: FBT001 - a parameter of the test
    variable: str,
    is_renewed: bool,  # noqa: FBT001 - the same
    run: Run,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert run("init", tmp_path / "r").status == 0
    git(tmp_path / "r", "init", "-q")
    before = (tmp_path / "r" / SCHEMA).read_bytes()
    add_host(tmp_path / "r")
    monkeypatch.setenv("CI", variable)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: on_terminal)
    ran = run("check", tmp_path / "r")
    assert "schema" not in ran.out + ran.err
    assert ((tmp_path / "r" / SCHEMA).read_bytes() != before) == is_renewed


def test_a_gitignore_that_is_kept_is_to_list_it(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".gitignore").write_text("*.o\n", encoding="utf-8")
    ran = run("init", tmp_path)
    assert f"Let .gitignore list {SCHEMA}, unless it does: `archgen schema` makes it again at any time.\n" in ran.out
