"""The day against which last days are held: of the commit that is read, else of HEAD; none outside of a repository."""

from __future__ import annotations

from pathlib import Path

from archgen.checking.linked_project import find_newest_day
from archgen.pipeline import check_at_revision, check_project
from tests.repositories import commit, repository

ROBOT = """\
archgen: 1
groups:
  g:
    components:
      a: {outputs: {x: {type: std_msgs/msg/Bool, deprecated: {until: 2024-05-01, use: y}}, y: std_msgs/msg/Bool}}
      b: {inputs: {x: a.x, y: a.y}}
nodes: {a: a, b: b}
"""


def _said(path: Path, revision: str = "", rules: str = "-use") -> list[str]:
    checked = check_at_revision(path, revision) if revision else check_project(path)
    return [f"{d.severity}[{d.rule}]" for d in checked.findings if d.rule.endswith(rules)]


def test_a_last_day_has_passed_when_the_newest_commit_is_later(tmp_path: Path) -> None:
    folder = repository(tmp_path / "robot", {"archgen.yaml": ROBOT}, day="2024-04-30")
    assert _said(folder) == ["warning[deprecated-use]"]
    commit(folder, {"README.md": "On the last day it may be used."}, day="2024-05-01")
    assert _said(folder) == ["warning[deprecated-use]"]
    commit(folder, {"README.md": "One day later."}, day="2024-05-02")
    assert _said(folder) == ["error[expired-use]"]
    assert _said(folder, "HEAD~1") == ["warning[deprecated-use]"]
    assert _said(folder, "HEAD") == ["error[expired-use]"]
    # What nobody committed yet has no day of its own.
    (folder / "archgen.yaml").write_text(f"{ROBOT}hosts: {{pc: }}\n", encoding="utf-8")
    assert _said(folder) == ["error[expired-use]"]


def test_without_commits_and_outside_of_a_repository_no_day_has_passed(tmp_path: Path) -> None:
    folder = repository(tmp_path / "robot")
    (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    assert _said(folder) == ["warning[deprecated-use]"]
    (tmp_path / "alone.yaml").write_text(ROBOT, encoding="utf-8")
    assert _said(tmp_path / "alone.yaml") == ["warning[deprecated-use]"]


def test_what_two_branches_make_together_has_the_day_of_head(tmp_path: Path) -> None:
    folder = repository(tmp_path / "robot", {"archgen.yaml": ROBOT}, day="2024-06-01")
    assert _said(folder, "HEAD^{tree}") == ["error[expired-use]"]


def test_git_is_not_asked_where_nothing_ends_on_a_day(tmp_path: Path) -> None:
    folder = repository(tmp_path / "robot", {"archgen.yaml": ROBOT}, day="2024-06-01")
    checked = check_project(folder)
    assert checked.architecture.commit_day == "2024-06-01"
    plain = ROBOT.replace("until: 2024-05-01, ", "")
    (folder / "archgen.yaml").write_text(plain, encoding="utf-8")
    checked = check_project(folder)
    assert find_newest_day(checked.loaded_project.files, checked.architecture) is None
    assert checked.architecture.commit_day is None


def test_a_milestone_is_missed_when_its_day_is_over_and_what_it_needs_is_planned(tmp_path: Path) -> None:
    text = """\
archgen: 1
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {inputs: {x: a.x}}}}}
nodes: {a: {implements: a, status: planned}, b: b}
milestones: {m: {date: 2024-05-01, needs: NEEDS}, open: {needs: g}, later: {date: 2024-06-01, needs: g}}
"""
    folder = repository(tmp_path / "robot", {"archgen.yaml": text.replace("NEEDS", "a")}, day="2024-05-01")
    assert _said(folder, "", "-milestone") == []
    commit(folder, {"README.md": "One day later."}, day="2024-05-02")
    assert _said(folder, "", "-milestone") == ["warning[missed-milestone]"]
    assert [d.element for d in check_project(folder).findings if d.rule == "missed-milestone"] == ["m"]
    for changed in (text.replace("NEEDS", "b"), text.replace("NEEDS", "a").replace(", status: planned", "")):
        (folder / "archgen.yaml").write_text(changed, encoding="utf-8")
        assert _said(folder, "", "-milestone") == []
