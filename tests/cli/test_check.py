"""`archgen check` with what was known before: a baseline, a git revision; and which findings make it fail."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from lxml import etree

from tests.cli.conftest import Run
from tests.findings import judges
from tests.repositories import commit, repository
from tests.repositories import git as run_git

_HEAD = "archgen: 1\nproject: {id: robot}\nrules: {missing-detail: off}\n"
_CAMERA = """\
groups:
  sensing:
    components:
      camera:
        outputs:
          image: sensor_msgs/msg/Image
          depth: sensor_msgs/msg/Image
      screen: {inputs: {image: camera.image}}
nodes:
  camera: {implements: camera}
  screen: {implements: screen}
"""
_DEPTH = "nobody reads `depth` of `sensing.camera`"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Give a project of two files in which nobody reads an output, in a repository."""
    return repository(tmp_path / "robot", {"archgen.yaml": _HEAD, "sensing.yaml": _CAMERA})


def _said(out: str) -> list[str]:
    return [line for line in out.splitlines() if line and line[0] != " "]


def _rules(run: Run, *words: object) -> list[str]:
    return [d["rule"] for d in json.loads(run("check", "--format", "json", *words).out)["diagnostics"]]


def test_a_baseline_keeps_what_it_knows_quiet_in_all_formats(run: Run, robot: Path) -> None:
    ran = run("check", "--update-baseline", robot)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.endswith("archgen-baseline.yaml (1 known: 1 added, 0 cured)\n")
    baseline = robot / "archgen-baseline.yaml"
    ran = run("check", robot, "--baseline", baseline)
    assert (ran.status, ran.out) == (0, "no new findings\n")
    assert ran.err == f"not shown: 1 warning that {baseline} knows\n"
    assert run("check", "--strict", robot, "--baseline", baseline).status == 0
    assert _rules(run, robot, "--baseline", baseline) == []
    assert run("check", robot, "--format", "github", "--baseline", baseline).out == ""
    assert json.loads(run("check", robot, "--format", "sarif", "--baseline", baseline).out)["runs"][0]["results"] == []
    junit = run("check", robot, "--format", "junit", "--baseline", baseline).out
    assert {case.get("name") for case in etree.fromstring(junit.encode()).iter("testcase")} == {"no findings"}


def test_a_baseline_is_no_part_of_the_architecture(run: Run, robot: Path) -> None:
    run("check", "--update-baseline", robot)
    assert _rules(run, robot) == ["unread-output"]
    (robot / "archgen.yaml").write_text(f'{_HEAD}sources: ["*.yaml"]\n', encoding="utf-8")
    assert _rules(run, robot) == ["unread-output"]


def test_what_moved_stays_known_and_what_is_new_fails(run: Run, robot: Path) -> None:
    run("check", "--update-baseline", robot)
    baseline = robot / "archgen-baseline.yaml"
    (robot / "sensing.yaml").rename(robot / "a.yaml")
    (robot / "a.yaml").write_text(f"# moved\n\n{_CAMERA}", encoding="utf-8")
    assert _rules(run, robot, "--baseline", baseline) == []
    (robot / "a.yaml").write_text(_CAMERA.replace("depth", "range"), encoding="utf-8")
    ran = run("check", "--strict", robot, "--baseline", baseline)
    assert (ran.status, _said(ran.out)) == (
        1,
        ["warning[unread-output]: nobody reads `range` of `sensing.camera`", "1 warning"],
    )


def test_a_cured_finding_is_said_and_fails_only_with_strict(run: Run, robot: Path) -> None:
    run("check", "--update-baseline", robot)
    baseline = robot / "archgen-baseline.yaml"
    (robot / "sensing.yaml").write_text(
        _CAMERA.replace("          depth: sensor_msgs/msg/Image\n", ""), encoding="utf-8"
    )
    ran = run("check", robot, "--baseline", baseline)
    assert (ran.status, ran.out) == (0, "no findings\n")
    assert ran.err == (
        f"1 finding of the baseline is cured: run `archgen check --update-baseline --baseline {baseline}`\n"
        f"  unread-output: {_DEPTH}\n"
    )
    assert run("check", "--strict", robot, "--baseline", baseline).status == 1
    assert run("check", robot, "--baseline", baseline, "--update-baseline").out.endswith(
        "(0 known: 0 added, 1 cured)\n"
    )
    assert run("check", "--strict", robot, "--baseline", baseline).status == 0


def test_a_finding_that_is_cured_in_part_is_no_new_one(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(_HEAD.replace("off", "error"), encoding="utf-8")
    run("check", "--update-baseline", robot)
    better = _CAMERA.replace("screen: {", "screen: {functionality: Shows., ", 1)
    (robot / "sensing.yaml").write_text(better, encoding="utf-8")
    assert "functionality" not in run("check", robot).out.split("sensing.screen")[1].splitlines()[0]
    assert run("check", robot, "--baseline", robot / "archgen-baseline.yaml").status == 0


def test_errors_of_reading_are_shown_and_hide_no_cure(run: Run, robot: Path) -> None:
    run("check", "--update-baseline", robot)
    before = (robot / "archgen-baseline.yaml").read_bytes()
    (robot / "sensing.yaml").write_text("groups: [\n", encoding="utf-8")
    ran = run("check", robot, "--baseline", robot / "archgen-baseline.yaml")
    assert (ran.status, ran.err) == (1, "")
    assert _said(ran.out)[0].startswith("error[syntax-error]")
    ran = run("check", robot, "--update-baseline")
    assert ran.status == 1
    assert ran.err.endswith("nobody knows what is behind errors of reading. Mend them first.\n")
    assert (robot / "archgen-baseline.yaml").read_bytes() == before


def test_a_broken_baseline_is_diagnosed_and_hides_nothing(run: Run, robot: Path) -> None:
    (robot / "b.yaml").write_text("archgen_baseline: 1\nfindings:\n  - {rule: unread-outputs, message: x}\n", "utf-8")
    ran = run("check", robot, "--baseline", robot / "b.yaml")
    assert _said(ran.out) == [
        "warning[unknown-rule]: there is no rule `unread-outputs`",
        f"warning[unread-output]: {_DEPTH}",
        "2 warnings",
    ]
    assert "  --> b.yaml:3:12\n   3 |   - {rule: unread-outputs, message: x}\n" in ran.out
    (robot / "b.yaml").write_text("<<<<<<< a\narchgen_baseline: 1\n=======\n>>>>>>> b\n", encoding="utf-8")
    assert _rules(run, robot, "--baseline", robot / "b.yaml") == ["merge-conflict", "unread-output"]
    assert run("check", robot, "--baseline", robot / "b.yaml", "--update-baseline").status == 0
    assert _rules(run, robot, "--baseline", robot / "b.yaml") == []


def test_a_baseline_outside_of_the_project_is_annotated_nowhere(run: Run, robot: Path, tmp_path: Path) -> None:
    (tmp_path / "b.yaml").write_text("archgen_baseline: 2\n", encoding="utf-8")
    ran = run("check", robot, "--baseline", tmp_path / "b.yaml", "--format", "github")
    assert ran.out.splitlines()[0].startswith("::error title=wrong-value::this is no baseline")
    assert "--> ../b.yaml:1:19" in run("check", robot, "--baseline", tmp_path / "b.yaml").out


@pytest.mark.parametrize("text", ["archgen: 1\n", "", "\0", "- a\n"])
def test_what_is_no_baseline_is_never_replaced(text: str, run: Run, robot: Path) -> None:
    (robot / "mine.yaml").write_text(text, encoding="utf-8")
    ran = run("check", robot, "--baseline", robot / "mine.yaml", "--update-baseline")
    assert (ran.status, "mine.yaml stays as it is" in ran.err) == (2, True)
    assert (robot / "mine.yaml").read_text(encoding="utf-8") == text


def test_wrong_usage(run: Run, robot: Path) -> None:
    ran = run("check", robot, "--baseline", robot / "none.yaml")
    assert (ran.status, ran.out) == (2, "")
    assert "there is no baseline" in ran.err
    assert run("check", robot, "--update-baseline", "--format", "sarif").status == 2
    assert run("check", robot, "--update-baseline", "--changed-since", "main").status == 2
    ran = run("check", robot, "--changed-since", "nowhere")
    assert (ran.status, ran.out) == (2, "")
    assert "there is no revision `nowhere`" in ran.err


def test_changed_since_shows_what_a_change_caused(run: Run, robot: Path) -> None:
    moved = f"# one\n# two\n{_CAMERA}".replace(
        "          depth", "          range: sensor_msgs/msg/Image\n          depth"
    )
    (robot / "sensing.yaml").unlink()
    (robot / "other.yaml").write_text(moved, encoding="utf-8")
    ran = run("check", robot, "--changed-since", "main")
    assert (ran.status, _said(ran.out)) == (
        0,
        ["warning[unread-output]: nobody reads `range` of `sensing.camera`", "1 warning"],
    )
    assert ran.err == "not shown: 1 warning that main had already\n"
    (robot / "other.yaml").unlink()
    ran = run("check", robot, "--changed-since", "HEAD")
    assert ran.err == f"1 finding of HEAD is cured\n  unread-output: {_DEPTH}\n"


def test_three_dots_are_where_the_branch_left(run: Run, robot: Path) -> None:
    run_git(robot, "checkout", "-q", "-b", "mine")
    commit(robot, {"hosts.yaml": "hosts: {pc: }\n"})
    run_git(robot, "checkout", "-q", "main")
    mended = _CAMERA.replace("          depth: sensor_msgs/msg/Image\n", "")
    commit(robot, {"sensing.yaml": mended})
    run_git(robot, "checkout", "-q", "mine")
    assert "unread-output" in _rules(run, robot, "--changed-since", "main")
    assert "unread-output" not in _rules(run, robot, "--changed-since", "main...")


def test_of_findings_that_are_alike_the_new_one_is_shown(run: Run, robot: Path) -> None:
    silent = "  # archgen: ignore"
    commit(robot, {"sensing.yaml": _CAMERA.replace("camera}", f"camera}}{silent}", 1)})
    both = (robot / "sensing.yaml").read_text("utf-8").replace("groups:\n", f"groups:{silent}\n", 1)
    (robot / "sensing.yaml").write_text(both, encoding="utf-8")
    found = json.loads(run("check", "--format", "json", robot, "--changed-since", "HEAD").out)["diagnostics"]
    assert [(d["rule"], d["span"]["start"]["line"]) for d in found] == [("unused-ignore", 1)]


def test_where_the_revision_does_not_load_everything_is_shown(run: Run, robot: Path) -> None:
    commit(robot, {"sensing.yaml": "groups: [\n"})
    (robot / "sensing.yaml").write_text(_CAMERA, encoding="utf-8")
    ran = run("check", robot, "--changed-since", "HEAD")
    assert f"warning[unread-output]: {_DEPTH}" in ran.out
    assert ran.err.startswith("warning: at `HEAD` the project could not be read whole (sensing.yaml:")
    assert ran.err.endswith("): all findings are shown\n")


def test_where_the_project_is_new_everything_is_shown(run: Run, tmp_path: Path) -> None:
    root = repository(tmp_path / "new", {"README.md": "x"})
    (root / "archgen.yaml").write_text(_HEAD + _CAMERA, encoding="utf-8")
    ran = run("check", root, "--changed-since", "HEAD")
    assert f"warning[unread-output]: {_DEPTH}" in ran.out
    assert ran.err == "warning: the project `archgen.yaml` does not exist in `HEAD`: all findings are shown\n"


def test_both_at_once(run: Run, robot: Path) -> None:
    run("check", "--update-baseline", robot)
    (robot / "sensing.yaml").write_text(_CAMERA.replace("depth", "range"), encoding="utf-8")
    ran = run("check", robot, "--strict", "--changed-since", "main", "--baseline", robot / "archgen-baseline.yaml")
    assert ran.status == 1
    assert _said(ran.out)[0] == "warning[unread-output]: nobody reads `range` of `sensing.camera`"


def test_quiet_shows_what_fails_and_nothing_else(run: Run, robot: Path) -> None:
    assert run("check", "-q", robot) == run("check", "-q", robot, "--changed-since", "main")
    ran = run("check", "-q", robot)
    assert (ran.status, ran.out, ran.err) == (0, "", "")
    ran = run("check", "-q", "--strict", robot)
    assert (ran.status, _said(ran.out)) == (1, [f"warning[unread-output]: {_DEPTH}", "1 warning"])
    assert _rules(run, "-q", robot) == []


@pytest.mark.parametrize("form", ["sarif", "junit"])
def test_documents_for_servers(form: str, run: Run, robot: Path, tmp_path: Path) -> None:
    ran = run("check", "--format", form, robot)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out == run("check", "--format", form, robot).out
    assert (judges.sarif(ran.out, tmp_path) if form == "sarif" else judges.junit(ran.out)) == []


def test_files_are_named_from_the_repositorys_root(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    commit(robot, {"arm/archgen.yaml": _HEAD + _CAMERA})
    monkeypatch.chdir(robot / "arm")
    (result,) = json.loads(run("check", "--format", "sarif").out)["runs"][0]["results"]
    assert result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "arm/archgen.yaml"
    assert run("check", "--format", "github").out.startswith("::warning file=arm/archgen.yaml,")


def test_what_was_renamed_keeps_its_findings(run: Run, robot: Path) -> None:
    (robot / "sensing.yaml").write_text(_CAMERA.replace("camera", "eye"), encoding="utf-8")
    ran = run("check", robot, "--changed-since", "main")
    assert (ran.status, ran.out) == (0, "no new findings\n")
    assert ran.err == "not shown: 1 warning that main had already\n"


def test_what_a_setting_makes_graver_is_shown(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(_HEAD.replace("off}\n", "off, unread-output: error}\n"), encoding="utf-8")
    ran = run("check", robot, "--changed-since", "main")
    assert (ran.status, _said(ran.out), ran.err) == (1, [f"error[unread-output]: {_DEPTH}", "1 error"], "")
    commit(robot, {})
    (robot / "archgen.yaml").write_text(_HEAD, encoding="utf-8")
    assert _rules(run, robot, "--changed-since", "main") == []


def test_a_baseline_that_promises_the_moon_costs_nothing(run: Run, robot: Path) -> None:
    entries = "".join(f"  - {{rule: unread-output, element: e{n}, message: m, count: 1000000}}\n" for n in range(500))
    (robot / "b.yaml").write_text(f"archgen_baseline: 1\nfindings:\n{entries}", encoding="utf-8")
    lines = run("check", robot, "--baseline", robot / "b.yaml").err.splitlines()
    assert lines[0].startswith("500000000 findings of the baseline are cured: run `archgen check --update-baseline")
    assert lines[1] == "  unread-output: m (1000000 times)"
    assert (len(lines), lines[-1]) == (22, "  and 480 more")


_ARM = """\
groups:
  arm:
    owner: tud
    components:
      gripper: {inputs: {image: camera.imge}}
"""


def test_files_of_a_project_show_what_lies_in_them(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (robot / "arm.yaml").write_text(_ARM.replace("    owner: tud\n", ""), encoding="utf-8")
    monkeypatch.chdir(robot)
    ran = run("check", "arm.yaml")
    assert (ran.status, _said(ran.out)[0]) == (
        1,
        "error[unknown-reference]: no component or output named `camera.imge`",
    )
    ran = run("check", "sensing.yaml", "archgen.yaml")
    assert (ran.status, ran.out, ran.err) == (0, "no findings there\n", "not shown: 1 error\n")
    assert json.loads(run("check", "sensing.yaml", "--format", "json").out)["diagnostics"] == []
    (robot / "alone.txt").write_text("hosts: {pc: {}}\n", encoding="utf-8")
    ran = run("check", "alone.txt", "-q")
    assert ran.err.splitlines()[0] == "warning: alone.txt is no part of the project in .: it is checked by itself"
    assert run("check", "alone.txt", robot / "arm.yaml", "-q").status == 1
    assert run("check", "arm.yaml", "--update-baseline").status == 2


def test_a_partner_asks_for_his_own_findings(run: Run, robot: Path) -> None:
    head = f"{_HEAD}partners: {{tud: Delft, wur: Wageningen}}\nhosts: {{pc: {{cores: 1}}}}\n"
    (robot / "archgen.yaml").write_text(head, encoding="utf-8")
    (robot / "arm.yaml").write_text(_ARM, encoding="utf-8")
    ran = run("check", robot, "--select", "owner:tud")
    assert (ran.status, _said(ran.out)[0]) == (
        1,
        "error[unknown-reference]: no component or output named `camera.imge`",
    )
    ran = run("check", robot, "--select", "sensing")
    assert (ran.status, ran.out, ran.err) == (0, "no findings there\n", "not shown: 1 error\n")
    assert run("check", robot, "--select", "sensin").status == 2
    # What cannot be read may be anybody's.
    (robot / "arm.yaml").write_text(f"{_ARM}a: [\n", encoding="utf-8")
    assert run("check", robot, "--select", "sensing").status == 1


def test_fixes_are_written_and_what_is_left_is_shown(run: Run, robot: Path) -> None:
    text = _CAMERA.replace("outputs:", "Outputs:", 1)
    (robot / "sensing.yaml").write_text(text, encoding="utf-8")
    (diagnostic, *_) = json.loads(run("check", robot, "--format", "json").out)["diagnostics"]
    (edit,) = diagnostic["fixes"][0]["edits"]
    assert (diagnostic["fixes"][0]["certain"], edit["text"]) == (True, "outputs")
    (result, *_) = json.loads(run("check", robot, "--format", "sarif").out)["runs"][0]["results"]
    assert result["fixes"][0]["artifactChanges"][0]["replacements"][0]["insertedContent"] == {"text": "outputs"}
    ran = run("check", robot, "--fix")
    assert ran.out.splitlines()[0].endswith("sensing.yaml (1 fix)")
    assert (robot / "sensing.yaml").read_text(encoding="utf-8") == _CAMERA
    assert _rules(run, robot) == ["unread-output"]
    assert run("check", robot, "--fix", "--format", "json").status == 2
