"""A CODEOWNERS file that archgen wrote and that is out of date: found on disk and in commits, for each project of a repository."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.checking.code_ownership import make_codeowners
from archgen.checking.codeowners_age import add_codeowners_age
from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import CheckedProject, check_at_revision, check_project
from tests.repositories import commit, repository

TEXT = 'archgen: 1\npartners: {p: {title: P, reviewers: "@p"}}\n'


def list_stale(checked_project: CheckedProject) -> list[str]:
    """Give place and message of what is found."""
    return [f"{each.span.file}: {each.message}" for each in checked_project.findings if each.rule == "stale-codeowners"]


@pytest.mark.parametrize("folder", ["", "robots/one"])
@pytest.mark.parametrize("name", [".github/CODEOWNERS", "CODEOWNERS", "docs/CODEOWNERS", ".gitlab/CODEOWNERS"])
def test_it_is_told_until_it_is_made_anew(tmp_path: Path, name: str, folder: str) -> None:
    project, lead = tmp_path / folder, f"{folder}/" if folder else ""
    repository(tmp_path, {f"{lead}archgen.yaml": TEXT})
    text = make_codeowners(check_project(project)).text
    commit(tmp_path, {name: text})
    assert list_stale(check_project(project)) == []
    commit(tmp_path, {f"{lead}more.yaml": "hosts: {pc: PC}\n"})
    message = f"CODEOWNERS is out of date: it lacks `/{lead}more.yaml @p`"
    place = f"{'../' * len(Path(folder).parts)}{name}"
    assert (
        list_stale(check_project(project)) == list_stale(check_at_revision(project, "HEAD")) == [f"{place}: {message}"]
    )
    assert list_stale(check_at_revision(project, "HEAD~1")) == []
    commit(tmp_path, {name: make_codeowners(check_project(project)).text + "/docs/ @writers\n"})
    assert list_stale(check_project(project)) == []


def test_a_file_of_ones_own_is_not_judged(tmp_path: Path) -> None:
    repository(tmp_path, {"archgen.yaml": TEXT, "CODEOWNERS": "* @somebody\n"})
    assert list_stale(check_project(tmp_path)) == []


@pytest.mark.parametrize("linked", [".github", ".github/CODEOWNERS"])
def test_a_file_behind_a_link_is_not_read(tmp_path: Path, linked: str) -> None:
    top, outside = tmp_path / "top", tmp_path / "outside" / linked
    repository(top, {"archgen.yaml": TEXT})
    stale_text = make_codeowners(check_project(top)).text.partition("* @p")[0]
    target = outside / "CODEOWNERS" if linked == ".github" else outside
    target.parent.mkdir(parents=True)
    target.write_text(stale_text, encoding="utf-8")
    link = top / linked
    link.parent.mkdir(exist_ok=True)
    link.symlink_to(outside)
    assert list_stale(check_project(top)) == []
    link.unlink()
    outside.rename(link)
    assert len(list_stale(check_project(top))) == 1


@pytest.mark.parametrize("setting", ["off", "error"])
def test_the_project_sets_its_severity(tmp_path: Path, setting: str) -> None:
    files = {"archgen.yaml": TEXT, "CODEOWNERS": ""}
    repository(tmp_path, files)
    header = make_codeowners(check_project(tmp_path)).text.partition("\n")[0]
    settings = f'{TEXT}rules: {{stale-codeowners: "{setting}"}}\n'
    commit(tmp_path, {"CODEOWNERS": header, "archgen.yaml": settings})
    found = [each.severity for each in check_project(tmp_path).findings if each.rule == "stale-codeowners"]
    assert found == ([Severity.ERROR] if setting == "error" else [])


def test_what_cannot_be_read_is_no_file_of_archgens(tmp_path: Path) -> None:
    repository(tmp_path, {"archgen.yaml": TEXT})
    (tmp_path / "CODEOWNERS").mkdir()
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "CODEOWNERS").symlink_to("nowhere")
    assert add_codeowners_age(check_project(tmp_path)).findings == check_project(tmp_path).findings


def test_many_missing_lines_are_counted(tmp_path: Path) -> None:
    repository(tmp_path, {"archgen.yaml": TEXT})
    commit(tmp_path, {"CODEOWNERS": make_codeowners(check_project(tmp_path)).text.partition("\n")[0]})
    (message,) = list_stale(check_project(tmp_path))
    assert message.endswith("lacks `* @p`, `/archgen.yaml @p`, `/review/p.yaml @p` and 5 more")
