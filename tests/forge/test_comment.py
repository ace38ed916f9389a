"""One comment on a pull request: made, changed, left alone; against a server that plays the forge."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from archgen.cli import main
from archgen.forge import ForgeError, post_comment
from archgen.forge.forge_api import ForgeApi, run_within
from tests.forge.conftest import Forge, github, gitlab


def test_a_comment_of_github_is_made_once_and_then_kept_current(forge: Forge, tmp_path: Path) -> None:
    job = github(forge, tmp_path)
    assert post_comment("first", "diff", job) == "created"
    assert post_comment("second\n\n", "diff", job) == "updated"
    assert post_comment("second", "diff", job) == "unchanged"
    assert [one["body"] for one in forge.comments] == ["<!-- archgen: diff -->\nsecond\n"]
    assert ("POST", "/repos/robots/rover/issues/7/comments") in forge.asked
    assert ("PATCH", "/repos/robots/rover/issues/comments/1") in forge.asked
    assert forge.tokens == {"Bearer secret"}


def test_a_note_of_gitlab_is_made_once_and_then_kept_current(forge: Forge) -> None:
    forge.user = {"id": 5}
    job = gitlab(forge)
    assert post_comment("first", "diff", job) == "created"
    assert post_comment("second", "diff", job) == "updated"
    assert [one["body"] for one in forge.comments] == ["<!-- archgen: diff -->\nsecond\n"]
    assert ("PUT", "/projects/12/merge_requests/3/notes/1") in forge.asked


def test_two_keys_are_two_comments(forge: Forge, tmp_path: Path) -> None:
    job = github(forge, tmp_path)
    post_comment("arm", "robots/arm", job)
    post_comment("leg", "robots/leg", job)
    assert post_comment("leg now", "robots/leg", job) == "updated"
    assert [one["body"].split("\n")[1] for one in forge.comments] == ["arm", "leg now"]


def test_a_copied_mark_in_a_strangers_comment_is_left_alone(forge: Forge, tmp_path: Path) -> None:
    strange = "<!-- archgen: diff -->\nmine"
    forge.comments.append({"id": 1, "user": {"login": "mallory"}, "body": strange})
    assert post_comment("text", "diff", github(forge, tmp_path)) == "created"
    assert forge.comments[0]["body"] == strange


def test_ours_is_found_on_a_later_page_also_with_windows_line_ends(forge: Forge, tmp_path: Path) -> None:
    ours = {"login": "rover-bot"}
    forge.user = ours
    forge.comments = [{"id": number, "user": None, "body": "hello"} for number in range(250)]
    forge.comments.append({"id": 999, "user": ours, "body": "<!-- archgen: diff -->\r\ntext\r\n"})
    assert post_comment("text", "diff", github(forge, tmp_path)) == "unchanged"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"GITHUB_ACTIONS": ""}, "this is no job of GitHub Actions or GitLab CI"),
        ({"GITHUB_TOKEN": ""}, "GITHUB_TOKEN is not set"),
        ({"GITHUB_REPOSITORY": "a/b/../c"}, "GITHUB_REPOSITORY names no repository"),
        ({"GITHUB_API_URL": "http://example.org"}, "does not begin with https://"),
        ({"GITHUB_API_URL": "file:///etc/passwd"}, "does not begin with https://"),
        ({"GITHUB_EVENT_PATH": "/nowhere"}, "the event that started this job is no pull request"),
    ],
)
def test_a_job_that_cannot_comment_says_why(forge: Forge, tmp_path: Path, change: dict[str, str], said: str) -> None:
    with pytest.raises(ForgeError, match=said):
        post_comment("text", "diff", github(forge, tmp_path) | change)
    assert not forge.comments


RUN = {"head_repository": {"owner": {"login": "kite"}}, "head_branch": "arm", "head_sha": "c2", "pull_requests": []}


@pytest.mark.parametrize(
    ("pulls", "commented"),
    [
        ([{"number": 7, "head": {"label": "kite:arm", "sha": "c2"}}], "/repos/robots/rover/issues/7/comments"),
        (
            [
                {"number": 8, "head": {"label": "kite:arm", "sha": "c1"}},
                {"number": 9, "head": {"label": "kite:arm", "sha": "c2"}},
            ],
            "/repos/robots/rover/issues/9/comments",
        ),
        # The branch moved on, or another fork has a commit of that hash.
        ([{"number": 7, "head": {"label": "kite:arm", "sha": "c3"}}], None),
        ([{"number": 7, "head": {"label": "mallory:arm", "sha": "c2"}}], None),
        ([], None),
    ],
)
def test_a_job_after_the_review_finds_the_pull_request_of_a_fork(
    forge: Forge, tmp_path: Path, pulls: list[dict[str, Any]], commented: str | None
) -> None:
    forge.pulls = pulls
    job = github(forge, tmp_path, {"workflow_run": RUN})
    if commented:
        assert post_comment("text", "diff", job) == "created"
        assert ("POST", commented) in forge.asked
    else:
        with pytest.raises(ForgeError, match="no open pull request ends with the commit that was reviewed"):
            post_comment("text", "diff", job)
        assert not forge.comments


@pytest.mark.parametrize("event", [{"workflow_run": None}, {"workflow_run": {}}, {"workflow_run": 7}, 7])
def test_an_odd_event_names_no_pull_request(forge: Forge, tmp_path: Path, event: object) -> None:
    with pytest.raises(ForgeError, match="no pull request"):
        post_comment("text", "diff", github(forge, tmp_path, event))


def test_a_merge_request_of_a_fork_belongs_to_the_project_that_it_is_merged_into(forge: Forge) -> None:
    forge.user = {"id": 5}
    assert post_comment("text", "diff", {**gitlab(forge), "CI_MERGE_REQUEST_PROJECT_ID": "1"}) == "created"
    assert ("POST", "/projects/1/merge_requests/3/notes") in forge.asked


def test_a_push_has_no_pull_request(forge: Forge, tmp_path: Path) -> None:
    with pytest.raises(ForgeError, match="no pull request"):
        post_comment("text", "diff", github(forge, tmp_path, {"ref": "refs/heads/main"}))


@pytest.mark.parametrize("change", [{"ARCHGEN_TOKEN": ""}, {"CI_MERGE_REQUEST_IID": ""}, {"CI_PROJECT_ID": "../1"}])
def test_a_gitlab_job_that_cannot_comment_says_why(forge: Forge, change: dict[str, str]) -> None:
    with pytest.raises(ForgeError, match=r"ARCHGEN_TOKEN is not set|no merge request"):
        post_comment("text", "diff", gitlab(forge) | change)
    assert not forge.asked


def test_too_long_a_text_and_a_key_that_would_break_out_of_the_mark_are_refused(forge: Forge, tmp_path: Path) -> None:
    job = github(forge, tmp_path)
    with pytest.raises(ForgeError, match="the text has 65,561 characters, a comment takes 65,536"):
        post_comment("x" * 65_537, "diff", job)
    with pytest.raises(ForgeError, match="the key"):
        post_comment("text", "a --> b", job)


def test_a_token_is_not_carried_to_another_address(forge: Forge) -> None:
    forge.refuse = 302
    with pytest.raises(ForgeError, match="302"):
        ForgeApi(forge.url, {}).send_request("POST", "/x", {})


def test_where_a_fork_may_not_comment_the_text_goes_to_the_summary(forge: Forge, tmp_path: Path) -> None:
    forge.refuse = 403
    text, summary = tmp_path / "diff.md", tmp_path / "summary.md"
    text.write_text("what changed\n")
    job = {**github(forge, tmp_path), "GITHUB_STEP_SUMMARY": str(summary), "GITLAB_CI": ""}
    done = CliRunner().invoke(main, ["comment", str(text)], env=job)
    assert done.exit_code == 0
    assert "was answered with 403" in done.stderr
    assert "the text is in the job's summary instead" in done.stderr
    assert summary.read_text() == "what changed\n"


def test_the_verb_says_what_it_did(forge: Forge, tmp_path: Path) -> None:
    text = tmp_path / "diff.md"
    text.write_text("what changed\n")
    job = {**github(forge, tmp_path), "GITLAB_CI": ""}
    assert CliRunner().invoke(main, ["comment", str(text)], env=job).output == "comment created\n"
    assert CliRunner().invoke(main, ["comment", str(text)], env=job).output == "comment unchanged\n"
    done = CliRunner().invoke(main, ["comment", str(text)], env={**job, "GITHUB_TOKEN": ""})
    assert (done.exit_code, done.stderr.startswith("Error: GITHUB_TOKEN is not set")) == (1, True)


@pytest.mark.parametrize(
    "strange",
    [
        {"user": "x", "body": "b"},
        {"user": {"login": "github-actions[bot]"}, "body": "<!-- archgen: diff -->\n"},
        7,
        None,
    ],
)
def test_odd_comments_are_not_taken_for_ours(forge: Forge, tmp_path: Path, strange: Any) -> None:  # noqa: ANN401 - JSON
    forge.comments.append(strange)
    assert post_comment("text", "diff", github(forge, tmp_path)) == "created"


def test_a_list_without_an_end_is_given_up(forge: Forge, tmp_path: Path) -> None:
    class Endless(list[dict[str, Any]]):
        def __getitem__(self, part: Any) -> Any:  # noqa: ANN401 - an index or a slice
            return [{"id": 1, "user": {"login": "mallory"}, "body": ""}] * 100

    forge.comments = Endless()
    with pytest.raises(ForgeError, match="more than 5,000 comments"):
        post_comment("text", "diff", github(forge, tmp_path))


def test_all_requests_together_have_a_time_limit() -> None:
    blocked = threading.Event()
    with pytest.raises(ForgeError, match=r"no answer within 0\.05 s"):
        run_within(0.05, blocked.wait)
    blocked.set()


def test_an_address_that_is_none_is_refused() -> None:
    with pytest.raises(ForgeError, match="is no address"):
        ForgeApi("http://[::1", {})
