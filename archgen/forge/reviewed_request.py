"""The request that a CI job reviews, from the variables that GitHub and GitLab set: what it is called, and what it contains."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.compare.review_facts import ReviewFacts, name_author
from archgen.products.reviewed_change import ReviewedRequest

_MERGE_REF = re.compile(r"refs/pull/\d+/merge")
_MERGING_PIPELINES = {"merged_result", "merge_train"}


def find_reviewed_request(environment: Mapping[str, str] = os.environ) -> ReviewedRequest | None:
    """Return the request that the job runs for; None outside of a job, or where it runs for a branch."""
    if environment.get("CI_MERGE_REQUEST_IID"):
        return _describe_merge_request(environment)
    if environment.get("GITHUB_EVENT_NAME") == "merge_group":
        group = _read_event(environment).get("merge_group") or {}
        branch = str(group.get("base_ref", "")).removeprefix("refs/heads/")
        return ReviewedRequest("the merge queue", branch, str(group.get("head_sha", "")))
    is_merge_ref = _MERGE_REF.fullmatch(environment.get("GITHUB_REF", ""))
    if not is_merge_ref and not environment.get("GITHUB_BASE_REF"):
        return None
    head = (_read_event(environment).get("pull_request") or {}).get("head") or {}
    return ReviewedRequest(
        "this pull request",
        environment.get("GITHUB_BASE_REF", ""),
        str(head.get("sha", "")),
        environment.get("GITHUB_SHA", "") if is_merge_ref else None,
    )


def find_request_authors(environment: Mapping[str, str] = os.environ) -> ReviewFacts:
    """Return for whom a job of a forge runs: who opened the request, and who moved it; nobody outside of a job.

    Only what the forge sets is asked. A queue runs for who put the request there: its author was judged before.
    """
    if login := environment.get("GITLAB_USER_LOGIN"):
        source, target = (environment.get(f"CI_MERGE_REQUEST_{name}PROJECT_ID") for name in ("SOURCE_", ""))
        return ReviewFacts(
            (name_author(login, environment.get("GITLAB_USER_EMAIL", "")),),
            trusts_mails=source is not None and source == target,
            is_decided=environment.get("CI_MERGE_REQUEST_EVENT_TYPE") == "merge_train",
        )
    actor = environment.get("GITHUB_ACTOR")
    if not actor:
        return ReviewFacts()
    request = _read_event(environment).get("pull_request") or {}
    logins = dict.fromkeys(filter(None, (_look_up(request, "user", "login"), actor)))
    source, target = (_look_up(request, side, "repo", "full_name") for side in ("head", "base"))
    return ReviewFacts(
        tuple(name_author(login) for login in logins),
        trusts_mails=bool(source) and source == target,
        is_decided=environment.get("GITHUB_EVENT_NAME") == "merge_group",
    )


def _look_up(data: object, *keys: str) -> str:
    """Return the text at a path in data from a forge, empty where there is none."""
    for key in keys:
        data = data.get(key) if isinstance(data, dict) else None
    return data if isinstance(data, str) else ""


def _describe_merge_request(environment: Mapping[str, str]) -> ReviewedRequest:
    is_merged = environment.get("CI_MERGE_REQUEST_EVENT_TYPE") in _MERGING_PIPELINES
    commit = environment.get("CI_COMMIT_SHA", "")
    return ReviewedRequest(
        "this merge request",
        environment.get("CI_MERGE_REQUEST_TARGET_BRANCH_NAME", ""),
        # In a merged results pipeline the job's own commit is GitLab's merge, which nobody else has.
        environment.get("CI_MERGE_REQUEST_SOURCE_BRANCH_SHA") or commit,
        commit if is_merged else None,
    )


def _read_event(environment: Mapping[str, str]) -> dict[str, Any]:
    """Return the event that started a job of GitHub; empty where it cannot be read."""
    try:
        event = json.loads(Path(environment["GITHUB_EVENT_PATH"]).read_bytes())
    except (KeyError, OSError, ValueError):
        return {}
    return event if isinstance(event, dict) else {}
