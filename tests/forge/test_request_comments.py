"""Open requests held against each other: from the forge's list to a comment on each, against a server that plays the forge."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import CliRunner

from archgen.cli import main
from archgen.forge import ForgeError
from archgen.forge.pull_request import OpenRequest, find_target_branch, list_open_requests
from archgen.forge.request_comments import (
    RequestComment,
    format_request_comments,
    post_request_comments,
    read_request_comments,
)
from tests import repositories
from tests.forge.conftest import Forge, github, gitlab
from tests.running import ROOT

ROBOT = """\
archgen: 1
project: {id: hull}
partners: {norsk: {title: Norsk}, aegir: {title: "Aegir @all"}}
review: {breaking: error}
types: {Profile: {fields: {ranges: {type: "float32[]", comment: Ranges in m}}}}
groups:
  sense: {owner: norsk, components: {sonar: {functionality: Sees., outputs: {profile: {type: Profile}}}}}
  safe:
    owner: aegir
    components:
      guard: {functionality: Guards., outputs: {stop: Stop}}
"""
READER = "inputs: {profile: sonar.profile}, outputs: {stop: Stop}"
HOSTILE = "Read it](https://evil.example) @team #99 <img src=x> `\u202e"


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """Make a clone of a repository whose forge keeps four requests, two of them of strangers."""
    work = repositories.repository(tmp_path / "work", {"archgen.yaml": ROBOT})
    edits = {
        10: ("outputs: {stop: Stop}", READER),
        12: ("Ranges in m}", "Ranges in mm}"),
        13: ("Sees.", "Sees far."),
    }
    for number, (old, new) in edits.items():
        repositories.git(work, "checkout", "-q", "-b", f"b{number}", "main")
        assert old in ROBOT
        repositories.commit(work, {"archgen.yaml": ROBOT.replace(old, new)})
    repositories.git(work, "checkout", "-q", "--orphan", "b14")
    repositories.commit(work, {"archgen.yaml": ROBOT, "README.md": "a stranger's\n"})
    repositories.git(work, "checkout", "-q", "main")
    remote = tmp_path / "remote.git"
    repositories.git(tmp_path, "clone", "-q", "--bare", str(work), str(remote))
    for number in (*edits, 14):
        repositories.git(remote, "update-ref", f"refs/pull/{number}/head", f"refs/heads/b{number}")
        repositories.git(remote, "update-ref", f"refs/merge-requests/{number}/head", f"refs/heads/b{number}")
        repositories.git(remote, "update-ref", "-d", f"refs/heads/b{number}")
    repositories.git(tmp_path, "clone", "-q", str(remote), "clone")
    return tmp_path / "clone"


def nightly(forge: Forge, tmp_path: Path) -> dict[str, str]:
    return {**github(forge, tmp_path, {}), "GITHUB_REF_NAME": "main", "GITLAB_CI": ""}


def open_pulls(forge: Forge, *numbers: int) -> None:
    forge.pulls = [
        {"number": number, "iid": number, "title": HOSTILE if number == 10 else "Units"} for number in numbers
    ]


def test_the_open_requests_are_listed_page_after_page(forge: Forge, tmp_path: Path) -> None:
    forge.pulls = [{"number": number, "title": "t"} for number in range(230, 0, -1)]
    requests = list_open_requests(nightly(forge, tmp_path))
    assert [request.number for request in requests] == [*range(1, 231)]
    assert requests[6].refspec == "+refs/pull/7/head:refs/archgen/requests/7"
    assert ("GET", "/repos/robots/rover/pulls") in forge.asked
    other_branch = {**nightly(forge, tmp_path), "GITHUB_REF_NAME": "next"}
    assert list_open_requests(other_branch) == ()


def test_gitlab_lists_merge_requests(forge: Forge) -> None:
    open_pulls(forge, 3)
    job = {**gitlab(forge), "CI_COMMIT_BRANCH": "main"}
    assert list_open_requests(job) == (OpenRequest(3, "Units", "refs/merge-requests/3/head"),)
    assert ("GET", "/projects/12/merge_requests") in forge.asked
    with pytest.raises(ForgeError, match="names no project"):
        list_open_requests({**job, "CI_PROJECT_ID": "../1"})


@pytest.mark.parametrize(
    "strange", [7, None, {}, {"number": True}, {"number": -1}, {"number": "1 --upload-pack=evil"}, {"number": 1.5}]
)
def test_odd_requests_are_passed_over(forge: Forge, tmp_path: Path, strange: Any) -> None:  # noqa: ANN401 - JSON
    forge.pulls = [strange, {"number": 4, "title": None}]
    assert [request.number for request in list_open_requests(nightly(forge, tmp_path))] == [4]


def test_a_job_without_a_branch_says_so() -> None:
    with pytest.raises(ForgeError, match="which branch this job runs for"):
        find_target_branch({})


def install_program(folder: Path) -> Path:
    """Put an archgen where a job has one."""
    programs = folder / "archgen/bin"
    if not programs.exists():
        programs.mkdir(parents=True)
        program = programs / "archgen"
        program.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m archgen "$@"\n')
        program.chmod(0o755)
    return programs


def run_action(forge: Forge, clone: Path, tmp_path: Path) -> dict[str, Any]:
    """Run the action's step as a runner does, with a token that git must not show."""
    install_program(tmp_path)
    action = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
    (step,) = (step for step in action["runs"]["steps"] if step.get("id") == "requests")
    environment = {
        "RUNNER_TEMP": str(tmp_path),
        "PROJECT": ".",
        "OUTPUT": "out",
        "GITHUB_SERVER_URL": "https://github.com",
    }
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],  # noqa: S607 - as a runner starts it
        cwd=clone,
        env={**os.environ, **nightly(forge, tmp_path), **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "secret" not in done.stdout + done.stderr + (clone / ".git/config").read_text()
    document: dict[str, Any] = json.loads((clone / "out/requests.json").read_text(encoding="utf-8"))
    return document


def test_each_request_is_told_what_it_breaks_together_with_another_one(
    forge: Forge, clone: Path, tmp_path: Path
) -> None:
    open_pulls(forge, 14, 13, 12, 10)
    document = run_action(forge, clone, tmp_path)
    texts = {entry["number"]: entry["text"] for entry in document["requests"]}
    assert {entry["number"]: entry["has_news"] for entry in document["requests"]} == {
        10: True,
        12: True,
        13: False,
        14: True,
    }
    assert (
        "**Together with #12 (Units) this breaks Aegir @&#8203;all.** First #12, then this one, whose author has to look."
        in texts[10]
    )
    lead = next(line for line in texts[12].splitlines() if line.startswith("**Together"))
    assert lead.startswith(
        "**Together with #10 (Read it\\](https:&#8203;//evil&#8203;.example) @&#8203;team #&#8203;99 "
    )
    assert lead.endswith("First this one, then #10, whose author has to look.")
    assert "<img" not in texts[12].replace("\\<img", "")
    assert "\u202e" not in texts[12]
    assert "`breaking-change`: breaks Aegir" in texts[12]
    assert "goes with `main` and with 3 other open requests." in texts[13]
    assert "refusing to merge unrelated histories" in texts[14]
    assert repositories.git(clone, "status", "--porcelain", "--untracked-files=no") == ""


def test_comments_are_renewed_in_place_and_not_begun_without_news(
    forge: Forge, clone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(clone)
    open_pulls(forge, 10, 12, 13)
    run_action(forge, clone, tmp_path)
    words = ["comment", "out/requests.json", "--key", "requests"]
    done = CliRunner().invoke(main, words, env=nightly(forge, tmp_path))
    assert done.output == "#10: comment created\n#12: comment created\n#13: comment unchanged\n"
    assert [comment["at"] for comment in forge.comments] == [
        "/repos/robots/rover/issues/10/comments",
        "/repos/robots/rover/issues/12/comments",
    ]
    run_action(forge, clone, tmp_path)
    done = CliRunner().invoke(main, words, env=nightly(forge, tmp_path))
    assert "created" not in done.output
    assert "updated" not in done.output
    # The other one was closed: what was said is taken back.
    open_pulls(forge, 10, 13)
    run_action(forge, clone, tmp_path)
    done = CliRunner().invoke(main, words, env=nightly(forge, tmp_path))
    assert done.output == "#10: comment updated\n#13: comment unchanged\n"
    assert "goes with `main` and with 1 other open request." in forge.comments[0]["body"]


@pytest.mark.slow
def test_a_schedule_of_gitlab_does_the_same(forge: Forge, clone: Path, tmp_path: Path) -> None:
    forge.user = {"id": 5}
    open_pulls(forge, 10, 12)
    template = yaml.safe_load((ROOT / "ci/gitlab.yml").read_text(encoding="utf-8"))
    job = {**gitlab(forge), "CI_COMMIT_BRANCH": "main", "GITHUB_ACTIONS": ""}
    del job["CI_MERGE_REQUEST_IID"]
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "-eo", "pipefail", "-c", "\n".join(template["archgen_requests"]["script"])],  # noqa: S607 - as GitLab starts it
        cwd=clone,
        env={
            **os.environ,
            **{key: str(value) for key, value in template["variables"].items()},
            **job,
            "PATH": f"{install_program(tmp_path)}:{os.environ['PATH']}",
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert [comment["at"] for comment in forge.comments] == [
        "/projects/12/merge_requests/10/notes",
        "/projects/12/merge_requests/12/notes",
    ]
    assert forge.comments[0]["body"].startswith("<!-- archgen: requests/diff -->\n")


def test_nothing_open_is_no_failure(forge: Forge, clone: Path, tmp_path: Path) -> None:
    assert run_action(forge, clone, tmp_path) == {"version": 1, "requests": []}


def test_a_request_that_was_not_fetched_is_said_and_stops_no_other(
    forge: Forge, clone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    open_pulls(forge, 10, 77)
    repositories.git(clone, "fetch", "-q", "origin", "+refs/pull/10/head:refs/archgen/requests/10")
    monkeypatch.chdir(clone)
    done = CliRunner().invoke(main, ["check-requests"], env=nightly(forge, tmp_path))
    assert done.exit_code == 0
    assert (done.stdout, done.stderr) == (
        "main + #10: merges\n",
        "warning: #77 was not fetched, and is left out\n",
    )


def test_on_gitlab_notes_are_put_on_merge_requests(forge: Forge) -> None:
    forge.user = {"id": 5}
    comments = [RequestComment(3, "text", has_news=True), RequestComment(4, "text", has_news=False)]
    outcomes = [outcome for _, outcome in post_request_comments(comments, "requests", gitlab(forge))]
    assert outcomes == ["created", "unchanged"]
    assert [comment["at"] for comment in forge.comments] == ["/projects/12/merge_requests/3/notes"]


def test_a_comment_that_is_refused_stops_no_other_and_fails_at_the_end(
    forge: Forge, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    forge.refuse = 403
    comments = [RequestComment(number, "text", has_news=number < 3) for number in (1, 2, 3)]
    (tmp_path / "requests.json").write_text(format_request_comments(comments))
    done = CliRunner().invoke(main, ["comment", "requests.json"], env=nightly(forge, tmp_path))
    assert done.exit_code == 1
    assert done.output.count("was answered with 403") == 2
    assert "#3: comment unchanged" in done.output
    assert "2 of 3 comments could not be put" in done.output


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"requests": [{"number": "1/../2", "text": "x", "has_news": true}]}', '{"requests": 7}']
)
def test_other_documents_are_refused(text: str) -> None:
    with pytest.raises(ForgeError, match="no comments"):
        read_request_comments(text)


def test_what_was_written_is_read_again() -> None:
    comments = (RequestComment(1, "a", has_news=True), RequestComment(2, "b\n", has_news=False))
    assert read_request_comments(format_request_comments(comments)) == comments
