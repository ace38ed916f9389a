"""Which files a new project gets, and where they go."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen.start import project_plan, start_answers
from archgen.start.start_answers import ForgeName, GroupAnswer, PartnerAnswer, StartAnswers

ANSWERS = replace(
    start_answers.collect_answers("robot"),
    partners=(PartnerAnswer("certh", "CERTH", "@certh"),),
    groups=(GroupAnswer("sensing", "Sensing", "certh"),),
)


def _plan(folder: Path, answers: StartAnswers = ANSWERS) -> project_plan.ProjectPlan:
    files = project_plan.example_files(answers)
    return project_plan.plan_files(folder, answers, files, project_plan.judge_files(files, "robot"))


def _names(plan: project_plan.ProjectPlan) -> set[str]:
    return {path.relative_to(plan.repository_folder).as_posix() for path in plan.files}


_WORKFLOWS = {".github/workflows/architecture.yml", ".github/workflows/open-requests.yml"}


@pytest.mark.parametrize(
    ("forge", "forge_names"), [("github", _WORKFLOWS), ("gitlab", {".gitlab-ci.yml"}), ("none", set())]
)
def test_what_a_forge_reads_stands_at_the_top_of_the_repository(
    tmp_path: Path, forge: ForgeName, forge_names: set[str]
) -> None:
    (tmp_path / ".git").mkdir()
    names = _names(_plan(tmp_path / "robot", replace(ANSWERS, forge=forge)))
    assert {"robot/archgen.yaml", "robot/groups/sensing.yaml", "robot/README.md", "CODEOWNERS"} <= names
    assert {other for other in names if other.startswith(".")} == forge_names


def test_outside_of_a_repository_all_stands_in_the_project(tmp_path: Path) -> None:
    assert _plan(tmp_path / "robot").repository_folder == tmp_path / "robot"


def test_what_exists_stays_even_a_broken_link(tmp_path: Path) -> None:
    (tmp_path / "README.md").symlink_to("gone")
    plan = _plan(tmp_path)
    assert plan.existing_files == (tmp_path / "README.md",)
    assert "README.md" not in _names(plan)


def test_code_owners_are_written_where_they_are_already(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "CODEOWNERS").touch()
    plan = _plan(tmp_path)
    assert plan.existing_files == (tmp_path / "docs" / "CODEOWNERS",)
    assert "CODEOWNERS" not in _names(plan)


@pytest.mark.parametrize(("reviewers", "missing"), [("", True), ("@certh", False)])
def test_partners_without_reviewers_are_noticed(tmp_path: Path, reviewers: str, missing: bool) -> None:  # noqa: FBT001
    plan = _plan(tmp_path, replace(ANSWERS, partners=(PartnerAnswer("certh", "CERTH", reviewers),)))
    assert plan.reviewers_missing is missing
    assert ("CODEOWNERS" in _names(plan)) is not missing
