"""What a CI job reviews, from the variables that GitHub and GitLab document for each kind of pipeline."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from archgen.forge.reviewed_request import find_request_authors, find_reviewed_request
from archgen.products.reviewed_change import ReviewedRequest

MERGE = {"GITHUB_REF": "refs/pull/7/merge", "GITHUB_BASE_REF": "main", "GITHUB_SHA": "m1"}
MERGE_REQUEST = {"CI_MERGE_REQUEST_IID": "3", "CI_MERGE_REQUEST_TARGET_BRANCH_NAME": "main", "CI_COMMIT_SHA": "c1"}


@pytest.mark.parametrize(
    ("environment", "event", "request_"),
    [
        ({}, None, None),
        ({"GITHUB_REF": "refs/heads/main", "GITHUB_SHA": "c1"}, {"after": "c1"}, None),
        (MERGE, {"pull_request": {"head": {"sha": "h1"}}}, ReviewedRequest("this pull request", "main", "h1", "m1")),
        (MERGE, None, ReviewedRequest("this pull request", "main", "", "m1")),
        (MERGE, ["odd"], ReviewedRequest("this pull request", "main", "", "m1")),
        (
            {**MERGE, "GITHUB_REF": "refs/heads/main"},
            {"pull_request": {"head": {"sha": "h1"}}},
            ReviewedRequest("this pull request", "main", "h1", None),
        ),
        (
            {"GITHUB_EVENT_NAME": "merge_group", "GITHUB_REF": "refs/heads/gh-readonly-queue/main/pr-7-b1"},
            {"merge_group": {"base_ref": "refs/heads/main", "head_sha": "q1", "base_sha": "b1"}},
            ReviewedRequest("the merge queue", "main", "q1", None),
        ),
        (
            {**MERGE_REQUEST, "CI_MERGE_REQUEST_EVENT_TYPE": "detached"},
            None,
            ReviewedRequest("this merge request", "main", "c1", None),
        ),
        (
            {
                **MERGE_REQUEST,
                "CI_MERGE_REQUEST_EVENT_TYPE": "merged_result",
                "CI_MERGE_REQUEST_SOURCE_BRANCH_SHA": "s1",
            },
            None,
            ReviewedRequest("this merge request", "main", "s1", "c1"),
        ),
        (
            {**MERGE_REQUEST, "CI_MERGE_REQUEST_EVENT_TYPE": "merge_train", "CI_MERGE_REQUEST_SOURCE_BRANCH_SHA": "s1"},
            None,
            ReviewedRequest("this merge request", "main", "s1", "c1"),
        ),
    ],
)
def test_a_job_says_which_request_it_reviews(
    tmp_path: Path, environment: dict[str, str], event: object, request_: ReviewedRequest | None
) -> None:
    if event is not None:
        (tmp_path / "event.json").write_text(json.dumps(event), encoding="utf-8")
        environment = {**environment, "GITHUB_EVENT_PATH": str(tmp_path / "event.json")}
    assert find_reviewed_request(environment) == request_


REQUEST = {
    "user": {"login": "Nora"},
    "head": {"repo": {"full_name": "f/hull"}},
    "base": {"repo": {"full_name": "o/hull"}},
}
SAME = {**REQUEST, "head": REQUEST["base"]}
LAB = {"GITLAB_USER_LOGIN": "nora", "GITLAB_USER_EMAIL": "Nora@n.example", "CI_MERGE_REQUEST_PROJECT_ID": "1"}


@pytest.mark.parametrize(
    ("event", "environment", "expected"),
    [
        (None, {}, ((), True, False)),
        (None, {"GITHUB_ACTOR": "alva"}, (("@alva",), False, False)),
        ({"pull_request": REQUEST}, {"GITHUB_ACTOR": "alva"}, (("@nora", "@alva"), False, False)),
        ({"pull_request": SAME}, {"GITHUB_ACTOR": "Nora"}, (("@nora",), True, False)),
        ({"merge_group": {}}, {"GITHUB_ACTOR": "alva", "GITHUB_EVENT_NAME": "merge_group"}, (("@alva",), False, True)),
        ({"pull_request": ["strange"]}, {"GITHUB_ACTOR": "alva"}, (("@alva",), False, False)),
        (None, LAB | {"CI_MERGE_REQUEST_SOURCE_PROJECT_ID": "2"}, (("@nora nora@n.example",), False, False)),
        (None, LAB | {"CI_MERGE_REQUEST_SOURCE_PROJECT_ID": "1"}, (("@nora nora@n.example",), True, False)),
        (None, LAB | {"CI_MERGE_REQUEST_EVENT_TYPE": "merge_train"}, (("@nora nora@n.example",), False, True)),
    ],
)
def test_for_whom_a_job_runs(
    tmp_path: Path, event: object, environment: dict[str, str], expected: tuple[tuple[str, ...], bool, bool]
) -> None:
    (tmp_path / "event.json").write_text(json.dumps(event), encoding="utf-8")
    facts = find_request_authors({"GITHUB_EVENT_PATH": str(tmp_path / "event.json"), **environment})
    requesters = tuple(" ".join(sorted(each)) for each in facts.requesters)
    assert (requesters, facts.trusts_mails, facts.is_decided) == expected
