"""The page on growing a project: each step is a project in which nothing is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import CheckedProject, check_project
from tests.repositories import repository
from tests.running import ROOT

PAGE = (ROOT / "docs" / "growing.md").read_text(encoding="utf-8")
STEPS = {
    heading: re.findall(r"^```yaml\n# ([\w/]+\.yaml)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    for heading, text in re.findall(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
}
"""The files that each step shows, by its heading."""


def test_every_example_is_a_file_of_a_step() -> None:
    assert sum(len(files) for files in STEPS.values()) == PAGE.count("```yaml")
    assert all(STEPS.values())


def check_step(top: Path, last_heading: str, project: str = "porter") -> CheckedProject:
    """Check a project as it stands after a step: a file shown again replaces the one before. Names with a folder begin
    at the top of the repository, others in the porter's folder.
    """
    repository(top)
    for heading, files in STEPS.items():
        for name, text in files:
            file = top / (name if "/" in name else f"porter/{name}")
            file.parent.mkdir(exist_ok=True)
            file.write_text(text, encoding="utf-8")
        if heading == last_heading:
            break
    return check_project(top / project)


@pytest.mark.parametrize(("heading", "project"), [*((step, "porter") for step in STEPS), (list(STEPS)[-1], "tug")])
def test_nothing_is_wrong_after_a_step(heading: str, project: str, tmp_path: Path) -> None:
    findings = check_step(tmp_path, heading, project).findings
    assert [f"{d.span} {d.rule}: {d.message}" for d in findings if d.effective_severity > Severity.NOTE] == []


def test_a_file_for_each_group_changes_nothing_but_the_place(tmp_path: Path) -> None:
    (one_file, files), folders = list(STEPS)[:2], (tmp_path / "one", tmp_path / "more")
    for folder in folders:
        folder.mkdir()
    first, second = check_step(folders[0], one_file).architecture, check_step(folders[1], files).architecture
    assert (first.components, first.nodes) == (second.components, second.nodes)
    assert set(first.edges) == set(second.edges)


def test_components_grow_from_three_to_five(tmp_path: Path) -> None:
    counts = [len(check_step(tmp_path, heading).architecture.components) for heading in STEPS]
    assert counts == [3, 3, 4, 5, 5]
