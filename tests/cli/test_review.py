"""`archgen review`: why a job is red, what is shown of old findings, which state is judged, what cannot be judged."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests import repositories
from tests.cli.conftest import Run

ROBOT = """\
archgen: 1
project: {id: mini}
partners: {north: North, south: South}
review: {breaking: error}
groups:
  sensing:
    owner: north
    components:
      camera:
        functionality: Sees.
        outputs: {image: sensor_msgs/msg/Image}
  display:
    owner: south
    components:
      screen: {functionality: Shows., inputs: {image: camera.image}}
nodes:
  camera: {implements: camera}
  screen: {implements: screen}
"""
BROKEN = ROBOT.replace("msg/Image", "msg/CompressedImage")
MESSAGE = (
    "breaks South (wire): `sensing.camera.image` now carries `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image`; "
    "it is read by `display.screen.image`; this gives "
    "`sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image` as `sensing.camera.image`; `display.screen.image` of South reads it"
)
ACCEPTED = "review: {accepted: {sensing.camera.image: {key: type, was: a8601b, reason: THE REASON}}}"
HELP = f"mend it, or South says why it is right, in `review/south.yaml`: `{ACCEPTED}`"
UNUSED = "types: {Old: {message: std_msgs/msg/Empty}}\n"
"""Makes an `unused-type`."""


@pytest.fixture(autouse=True)
def _no_job(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("GITHUB_ACTIONS", "GITHUB_REF", "GITHUB_SHA", "GITHUB_BASE_REF", "GITHUB_EVENT_NAME"):
        monkeypatch.delenv(name, raising=False)
    for name in ("GITHUB_STEP_SUMMARY", "CI_MERGE_REQUEST_IID"):
        monkeypatch.delenv(name, raising=False)


def branch(folder: Path, before: str, after: str, path: str = "archgen.yaml") -> Path:
    """Make a repository with a version on main and one on a branch, which is checked out."""
    repositories.repository(folder, {path: before, ".gitignore": "archgen-out/\n"})
    repositories.git(folder, "checkout", "-q", "-b", "work")
    repositories.commit(folder, {path: after})
    return folder


def comment(folder: Path) -> str:
    """Return the comment that a review of a project made."""
    return (folder / "archgen-out/review/comment.md").read_text(encoding="utf-8")


def test_a_break_is_printed_with_whom_why_and_place(run: Run, tmp_path: Path) -> None:
    ran = run("review", branch(tmp_path, ROBOT, BROKEN), "--base", "main", "--no-build")
    assert ran.status == 1
    assert (
        ran.out.split("\n\n", 1)[0]
        == f"""\
error[breaking-change]: {MESSAGE}
  --> archgen.yaml:11:26
   11 |         outputs: {{image: sensor_msgs/msg/CompressedImage}}
      |                          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
   = help: {HELP}"""
    )


def test_a_break_is_an_annotation_at_the_changed_line(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    ran = run("review", branch(tmp_path, ROBOT, BROKEN), "--base", "main", "--no-build")
    assert ran.out.splitlines()[0] == (
        f"::error file=archgen.yaml,line=11,endLine=11,col=26,endColumn=57,title=breaking-change::{MESSAGE}%0Ahelp: {HELP}"
    )


@pytest.mark.parametrize(("policy", "status"), [("error", 1), ("warning", 0), ("note", 0)])
def test_sarif_and_junit_hold_a_break_with_the_severity_of_the_policy(
    run: Run, tmp_path: Path, policy: str, status: int
) -> None:
    texts = [text.replace("breaking: error", f"breaking: {policy}") for text in (ROBOT, BROKEN)]
    folder = branch(tmp_path, *texts)
    assert run("review", folder, "--base", "main", "--no-build").status == status
    (scan,) = json.loads((folder / "archgen-out/review/findings.sarif").read_text(encoding="utf-8"))["runs"]
    (result,) = [result for result in scan["results"] if result["ruleId"] == "breaking-change"]
    rule = scan["tool"]["driver"]["rules"][result["ruleIndex"]]
    assert (result["level"], rule["id"]) == (policy, "breaking-change")
    assert rule["help"]["text"]
    region = result["locations"][0]["physicalLocation"]["region"]
    assert (region["startLine"], region["startColumn"]) == (11, 26)
    tree = ET.parse(folder / "archgen-out/review/findings.xml")  # noqa: S314 - archgen wrote it
    assert len(tree.findall(".//failure")) == (1 if policy == "error" else 0)
    assert next(case.get("name", "")[:37] for case in tree.iter("testcase")) == "breaking-change: breaks South (wire):"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (ROBOT, ROBOT.replace("Sees.", "Sees well.")),
        (ROBOT.replace("breaking: error", "breaking: off"), BROKEN.replace("breaking: error", "breaking: off")),
    ],
)
def test_what_is_accepted_or_breaks_nobody_is_no_finding(run: Run, tmp_path: Path, before: str, after: str) -> None:
    ran = run("review", branch(tmp_path, before, after), "--base", "main", "--no-build")
    assert (ran.status, ran.out.splitlines()[0]) == (0, "no new findings")


def test_what_the_partner_accepts_in_its_own_file_is_no_finding(run: Run, tmp_path: Path) -> None:
    sources = "sources: ['review/*.yaml']\n"
    folder = branch(tmp_path, ROBOT + sources, BROKEN + sources)
    repositories.commit(folder, {"review/south.yaml": ACCEPTED + "\n"})
    ran = run("review", folder, "--base", "main", "--no-build")
    assert (ran.status, ran.out.splitlines()[0]) == (0, "no new findings")


def test_old_findings_stay_out_of_the_log_and_in_the_files(run: Run, tmp_path: Path) -> None:
    folder = branch(tmp_path, ROBOT + UNUSED, ROBOT + UNUSED.replace("}}", "}, New: {message: std_msgs/msg/Empty}}"))
    ran = run("review", folder, "--base", "main", "--no-build")
    assert "`New`" in ran.out
    assert "`Old`" not in ran.out
    assert ran.err == "not shown, since they were there before: 3 notes; `--all-findings` shows all\n"
    assert "`Old`" in (folder / "archgen-out/review/findings.sarif").read_text(encoding="utf-8")
    assert "`Old`" in run("review", folder, "--base", "main", "--no-build", "--all-findings").out
    assert "`Old`" in run("review", folder, "--no-build").out


def test_an_old_finding_that_makes_the_job_red_is_shown_behind_the_new_ones(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = (f"{ROBOT}types: {{{types}}}\nrules: {{unused-type: error}}\n" for types in ("B: {}", "B: {}, C: {}"))
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    ran = run("review", branch(tmp_path, old, new), "--base", "main", "--no-build")
    assert ran.status == 1
    assert [line.split("`")[1] for line in ran.out.splitlines() if line.startswith("::error")] == ["C", "B"]


def test_uncommitted_changes_are_in_the_comment_and_the_title_says_so(run: Run, tmp_path: Path) -> None:
    folder = branch(tmp_path, ROBOT, ROBOT)
    run("review", folder, "--base", "main", "--no-build")
    main, head = (repositories.git(folder, "rev-parse", name)[:7] for name in ("main", "HEAD"))
    assert comment(folder).startswith(f"### No change of the architecture\n\n`main ({main})` → `HEAD ({head})`")
    (folder / "archgen.yaml").write_text(BROKEN, encoding="utf-8")
    assert run("review", folder, "--base", "main", "--no-build").status == 1
    assert f"`main ({main})` → `the working tree, with changes that are not committed`" in comment(folder)
    assert "breaks South" in comment(folder).splitlines()[0]


def test_a_file_that_is_not_committed_yet_is_a_change_of_the_working_tree(run: Run, tmp_path: Path) -> None:
    folder = branch(tmp_path, ROBOT, ROBOT)
    (folder / "more.yaml").write_text("requirements: {R-1: It works}\n", encoding="utf-8")
    run("review", folder, "--base", "main", "--no-build")
    assert "→ `the working tree, with changes" in comment(folder)
    (folder / "more.yaml").unlink()
    (folder / "notes.txt").write_text("no part of the project", encoding="utf-8")
    run("review", folder, "--base", "main", "--no-build")
    assert "→ `HEAD (" in comment(folder)


def test_a_main_line_that_moved_on_is_compared_where_the_branch_left_it(run: Run, tmp_path: Path) -> None:
    folder = branch(tmp_path, ROBOT, ROBOT)
    repositories.git(folder, "checkout", "-q", "main")
    repositories.commit(folder, {"archgen.yaml": BROKEN})
    repositories.git(folder, "checkout", "-q", "work")
    assert run("review", folder, "--base", "main", "--no-build").status == 0
    assert "`where HEAD left main (" in comment(folder)


@pytest.mark.parametrize(
    ("base", "reason"),
    [
        ("nowhere", "there is no revision `nowhere`: branches, tags and hashes are revisions"),
        ("other", "`other` and `HEAD` have no commit in common: name the revision to compare with"),
    ],
)
def test_what_cannot_be_judged_has_a_comment_and_the_files_of_later_steps(
    run: Run, tmp_path: Path, base: str, reason: str
) -> None:
    folder = branch(tmp_path, ROBOT, ROBOT + UNUSED)
    repositories.git(folder, "checkout", "-q", "--orphan", "other")
    repositories.commit(folder, {})
    repositories.git(folder, "checkout", "-q", "work")
    run("review", folder, "--base", "main", "--no-build")
    ran = run("review", folder, "--base", base, "--no-build")
    assert ran.status == 2
    assert reason in ran.err
    assert comment(folder).startswith("### Cannot be judged\n\n")
    assert reason.replace("`", "") in comment(folder).replace("`", "")
    assert "unused-type" in ran.out
    assert (folder / "archgen-out/review/findings.sarif").exists()
    # The next run may compare again.
    assert run("review", folder, "--base", "main", "--no-build").status == 0


@pytest.mark.parametrize(("policy", "status"), [("error", 1), ("warning", 0)])
def test_a_project_that_is_gone_or_new_has_a_comment(run: Run, tmp_path: Path, policy: str, status: int) -> None:
    folder = branch(tmp_path, "groups: {}\n", ROBOT, "robot/archgen.yaml")
    repositories.git(folder, "checkout", "-q", "main")
    repositories.git(folder, "rm", "-q", "-r", "robot")
    repositories.commit(folder, {"README.md": "x"})
    repositories.git(folder, "checkout", "-q", "-B", "work")
    repositories.commit(folder, {"robot/archgen.yaml": ROBOT.replace("breaking: error", f"breaking: {policy}")})
    ran = run("review", folder / "robot", "--base", "main", "--no-build")
    assert ran.status == status
    assert "there is nothing to compare with" in comment(folder / "robot")
    ran = run("review", folder / "gone", "--base", "main", "--no-build", "-o", tmp_path / "out")
    assert ran.status == 2
    assert (tmp_path / "out/comment.md").read_text(encoding="utf-8").startswith("### Cannot be judged\n")


def test_a_pull_request_is_named_in_the_title_and_the_command_can_be_repeated(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    components = "".join(f"      part{number}: {{functionality: {'Works. ' * 40}}}\n" for number in range(3))
    folder = branch(
        tmp_path, ROBOT, ROBOT.replace("      camera:\n", f"{components}      camera:\n"), "robot/archgen.yaml"
    )
    base, head = (repositories.git(folder, "rev-parse", name) for name in ("main", "work"))
    repositories.git(folder, "checkout", "-q", "main")
    repositories.commit(folder, {"robot/archgen.yaml": ROBOT + "# moved on\n"})
    tip = repositories.git(folder, "rev-parse", "main")
    repositories.git(folder, "checkout", "-q", "--detach")
    repositories.git(folder, "merge", "-q", "--no-ff", "-m", "x", "work")
    event = tmp_path / "event.json"
    event.write_text(json.dumps({"pull_request": {"number": 7, "head": {"sha": head}}}), encoding="utf-8")
    for name, value in (
        ("GITHUB_REF", "refs/pull/7/merge"),
        ("GITHUB_SHA", repositories.git(folder, "rev-parse", "HEAD")),
        ("GITHUB_BASE_REF", "main"),
        ("GITHUB_EVENT_PATH", str(event)),
    ):
        monkeypatch.setenv(name, value)
    assert run("review", folder / "robot", "--base", base, "--no-build").status == 0
    text = comment(folder / "robot")
    assert f"\n`main ({tip[:7]})` → `this pull request ({head[:7]})`" in text
    ran = run("diff", f"{tip[:7]}...{head[:7]}", "-C", folder / "robot")
    assert "part0" in ran.out
    # A job that checked out the branch itself has no merge: HEAD^1 would be the branch's own last commit but one.
    repositories.git(folder, "checkout", "-q", "work")
    assert run("review", folder / "robot", "--base", base, "--no-build").status == 0
    assert f"\n`main ({base[:7]})` → `this pull request ({head[:7]})`" in comment(folder / "robot")


def test_diff_writes_annotations_too(run: Run, tmp_path: Path) -> None:
    folder = branch(tmp_path, ROBOT, BROKEN + UNUSED)
    ran = run("diff", "main", "-C", folder, "--format", "github", "--breaking")
    assert (ran.status, ran.out.count("\n")) == (1, 1)
    assert ran.out.startswith("::error file=archgen.yaml,line=11,")
    out = run("diff", "main", "-C", folder, "--format", "github").out
    assert [line.split("title=")[1].split("::")[0] for line in out.splitlines()] == ["breaking-change", "unused-type"]


def test_with_strict_a_breaking_change_that_is_a_warning_fails_as_every_warning_does(run: Run, tmp_path: Path) -> None:
    texts = [text.replace("breaking: error", "breaking: warning") for text in (ROBOT, BROKEN)]
    folder = branch(tmp_path, *texts)
    assert run("review", folder, "--base", "main", "--no-build").status == 0
    assert run("review", folder, "--base", "main", "--no-build", "--strict").status == 1


@pytest.mark.parametrize("evil", [r'"\e[2J::error::x"', r'"x\u202e\n::warning::y"'])
def test_what_a_stranger_wrote_makes_no_command_of_its_own(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, evil: str
) -> None:
    folder = branch(tmp_path, ROBOT, BROKEN.replace("sensor_msgs/msg/CompressedImage", evil))
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    ran = run("review", folder, "--base", "main", "--no-build")
    commands = [line for line in ran.out.splitlines() if line.startswith("::")]
    assert commands
    assert all(line.startswith(("::error file=", "::warning file=", "::notice file=")) for line in commands)
    assert "\x1b" not in ran.out
