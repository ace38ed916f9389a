"""Which findings a check reports: new to a baseline, and new since a revision."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.file_tree import OutputError
from archgen.pipeline import CheckedProject, check_project
from archgen.products import check_findings
from tests.repositories import commit, git, repository

TEXT = """\
archgen: 1
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
"""
WORSE = TEXT + "      radar: {outputs: {echo: sensor_msgs/msg/Range}}\n"


def _check(folder: Path, text: str) -> CheckedProject:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text)
    return check_project(folder)


def _elements(findings: tuple[object, ...]) -> set[str]:
    return {str(getattr(finding, "element", None)) for finding in findings}


def test_without_anything_to_compare_with_all_is_reported(tmp_path: Path) -> None:
    checked = _check(tmp_path, TEXT)
    reported = check_findings.report_findings(checked)
    assert reported.findings == checked.findings
    assert not reported.was_compared


def test_what_the_baseline_lists_is_known_and_what_it_lists_in_vain_is_cured(tmp_path: Path) -> None:
    baseline = tmp_path / "baseline.yaml"
    update = check_findings.update_baseline(_check(tmp_path / "robot", WORSE), baseline)
    assert (update.known_count, update.cured_count) == (update.added_count, 0)
    reported = check_findings.report_findings(_check(tmp_path / "robot", TEXT), baseline)
    assert reported.findings == ()
    assert (
        len(reported.known_findings) + sum(entry.occurrences for entry in reported.cured_entries) == update.known_count
    )
    assert {entry.element for entry in reported.cured_entries} == {"sensing.radar"}


def test_behind_an_error_of_reading_nobody_can_say_what_is_cured(tmp_path: Path) -> None:
    baseline = tmp_path / "baseline.yaml"
    check_findings.update_baseline(_check(tmp_path / "robot", WORSE), baseline)
    broken = _check(tmp_path / "robot", f"{TEXT}      screen: {{inputs: {{image: camera.imgae}}}}\n")
    assert check_findings.find_reading_error(broken.findings) is not None
    assert check_findings.report_findings(broken, baseline).cured_entries == ()


def test_only_what_a_change_caused_is_reported(tmp_path: Path) -> None:
    before, after = _check(tmp_path / "a", TEXT), _check(tmp_path / "b", WORSE)
    reported = check_findings.report_findings(after, earlier_project=before)
    assert _elements(reported.findings) == {"sensing.radar"}
    assert _elements(reported.earlier_findings) == {"sensing.camera", "sensing.lidar"}
    _, gone = check_findings.compare_findings(before, after)
    assert _elements(gone) == {"sensing.radar"}


def test_a_renamed_element_keeps_its_findings(tmp_path: Path) -> None:
    before = _check(tmp_path / "a", TEXT.replace("{outputs", "{title: Colour camera, functionality: Sees., outputs"))
    after = _check(
        tmp_path / "b",
        TEXT.replace("camera: {outputs", "eye: {title: Colour camera, functionality: Sees., outputs"),
    )
    assert check_findings.compare_findings(after, before) == ((), ())


def test_a_finding_that_became_graver_is_new(tmp_path: Path) -> None:
    before = _check(tmp_path / "a", TEXT)
    after = _check(tmp_path / "b", f"{TEXT}rules: {{unread-output: error}}\n")
    new, gone = check_findings.compare_findings(after, before)
    assert [finding.rule for finding in new] == ["unread-output", "unread-output"]
    assert gone == ()


@pytest.mark.parametrize("content", ["groups: {}\n", "", "[", "archgen: 1\n"])
def test_a_file_that_is_no_baseline_is_never_replaced(tmp_path: Path, content: str) -> None:
    baseline = tmp_path / "baseline.yaml"
    baseline.write_text(content)
    with pytest.raises(OutputError, match="stays as it is"):
        check_findings.update_baseline(_check(tmp_path / "robot", TEXT), baseline)
    assert baseline.read_text() == content


def test_the_earlier_project_is_that_of_a_revision_or_of_where_the_branch_left(tmp_path: Path) -> None:
    repository(tmp_path, {"archgen.yaml": TEXT})
    git(tmp_path, "checkout", "-q", "-b", "arm")
    commit(tmp_path, {"archgen.yaml": WORSE})
    git(tmp_path, "checkout", "-q", "main")
    commit(tmp_path, {"archgen.yaml": TEXT.replace("camera", "sonar")})
    git(tmp_path, "checkout", "-q", "arm")
    for revision, components in (
        ("main", {"sensing.sonar", "sensing.lidar"}),
        ("main...", {"sensing.camera", "sensing.lidar"}),
    ):
        earlier = check_findings.check_earlier(tmp_path, revision)
        assert set(earlier.architecture.components) == components
