"""`archgen sign`: what it writes, what it says next, what is wrong usage."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.cli.test_signed_agreements import ROBOT
from tests.repositories import git, repository

BOTH = ("--by", "a", "Ada", "--by", "b", "Ben")


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    root = repository(tmp_path, {"archgen.yaml": ROBOT})
    git(root, "config", "user.name", "Clerk")
    git(root, "config", "user.email", "clerk@x.org")
    return root


def test_it_writes_the_document_the_file_and_the_tag(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(robot)
    ran = run("sign", "a", "b", *BOTH, "--date", "2026-03-01", "-o", "signed.md")
    assert (ran.status, ran.out) == (0, "wrote signed.md\nwrote agreements/a-b.yaml\n")
    assert ran.err.splitlines()[-1] == (
        "made the tag signed/a-b/2026-03-01: commit agreements/a-b.yaml, and `git push origin signed/a-b/2026-03-01`"
    )
    document = (robot / "signed.md").read_text(encoding="utf-8")
    assert "| Alpha | Ada | 2026\\-03-01 |" in document.replace("2026-03-01", "2026\\-03-01")
    assert "this document of 2026" in document
    said = run("interfaces", robot, "--between", "a", "b").out
    assert "as signed at signed/a" in said.replace("\\", "")


def test_one_alone_is_told_that_it_binds_nobody(run: Run, robot: Path) -> None:
    ran = run("sign", "b", "a", "--by", "b", "Ben", "-C", robot)
    assert ran.status == 0
    assert "it binds nobody before `a` has signed, too" in ran.err
    assert (robot / "agreements" / "b-a.yaml").is_file()
    assert (robot / "archgen-out" / "interfaces" / "b-a.docx").is_file()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("a", "b"), "Missing option '--by'"),
        (("a", "x", *BOTH), "there is no partner `x`"),
        (("a", "c", "--by", "a", "Ada"), "nothing flows between `a` and `c`"),
        (("a", "b", "--by", "c", "Cleo"), "`c` is none of the two partners"),
        (("a", "b", "--by", "a", "Ada\nand Bob"), "'Ada\\nand Bob' is no name that can stand in a line"),
        (("a", "b", "--by", "a", " "), "' ' is no name"),
        (("a", "b", *BOTH, "--date", "tomorrow"), "`tomorrow` is no date"),
    ],
)
def test_wrong_usage(run: Run, robot: Path, words: tuple[str, ...], told: str) -> None:
    ran = run("sign", *words, "-C", robot)
    assert ran.status == 2
    assert told in ran.err
    assert git(robot, "tag") == ""


def test_outside_of_a_repository_nothing_is_signed(run: Run, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    ran = run("sign", "a", "b", *BOTH, "-C", tmp_path)
    assert ran.status == 2
    assert "is not in a git repository: run `git init` first" in ran.err
