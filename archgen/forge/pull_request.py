"""Find the pull or merge request of the running workflow, from the environment that the forge sets.

One comment for each key: found by a mark in its first line, updated if it exists, created if not.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal
from urllib.parse import urlencode

from archgen.forge.forge_api import ForgeApi, ForgeError, run_within
from archgen.frozen import NamedTuple, dataclass

CommentOutcome = Literal["created", "updated", "unchanged"]
_KEY_PATTERN = re.compile(r"[A-Za-z0-9_./-]+")


@dataclass(frozen=True, slots=True)
class CommentTarget:
    """A pull request as its API sees it: where its comments are listed, where one is changed, and who writes ours.

    `author_path` is two keys that lead to a comment's author, and the value found there if the comment is ours.
    """

    api: ForgeApi
    list_path: str
    comment_path: str
    change_method: Literal["PATCH", "PUT"]
    author_path: tuple[str, str, object]
    max_length: int


def put_comment(target: CommentTarget, text: str, key: str, *, creates: bool = True) -> CommentOutcome:
    """Update our comment of this key, or create it unless `creates` is False. Raise ForgeError."""
    if not _KEY_PATTERN.fullmatch(key):
        raise ForgeError(f"the key {key!r} may hold letters, digits, `_`, `.`, `/` and `-` only")
    marker = f"<!-- archgen: {key} -->"
    body = f"{marker}\n{text.strip()}\n"
    if len(body) > target.max_length:
        raise ForgeError(f"the text has {len(body):,} characters, a comment takes {target.max_length:,}")
    for comment in _own_comments(target):
        old_body = comment.get("body")
        if not isinstance(old_body, str) or old_body.split("\n", 1)[0].rstrip("\r") != marker:
            continue
        # Forges may change line ends and blanks; an unchanged comment is not written again.
        if old_body.replace("\r\n", "\n").strip() == body.strip():
            return "unchanged"
        target.api.send_request(target.change_method, f"{target.comment_path}/{comment['id']}", {"body": body})
        return "updated"
    if not creates:
        return "unchanged"
    target.api.send_request("POST", target.list_path, {"body": body})
    return "created"


def _own_comments(target: CommentTarget) -> Iterator[dict[str, Any]]:
    """Yield the comments that we wrote; the comment of a stranger who copies the mark is never changed."""
    user_key, id_key, our_id = target.author_path
    for comment in target.api.list_items(target.list_path, "comments, and ours is not among them"):
        author = comment.get(user_key) if isinstance(comment, dict) else None
        # The number becomes part of an address.
        if isinstance(author, dict) and author.get(id_key) == our_id and isinstance(comment.get("id"), int):
            yield comment


_REF_FOLDER = "refs/archgen/requests"
"""Where a clone keeps what it fetched: no branch and no tag is called so, whatever a stranger calls his."""
_LISTING_SECONDS = 120.0


class OpenRequest(NamedTuple):
    """An open request: its number, its title as its author wrote it, and where the forge keeps its last commit."""

    number: int
    title: str
    forge_ref: str

    @property
    def ref(self) -> str:
        """Where this clone keeps its last commit, once `refspec` is fetched."""
        return f"{_REF_FOLDER}/{self.number}"

    @property
    def refspec(self) -> str:
        """What git fetches: also for a fork's request, from the repository that it is to be merged into."""
        return f"+{self.forge_ref}:{self.ref}"


def list_open_requests(environment: Mapping[str, str] = os.environ) -> tuple[OpenRequest, ...]:
    """List the open requests to the branch that the job runs for, by number. Raise ForgeError."""
    return run_within(_LISTING_SECONDS, lambda: tuple(sorted(_list_requests(environment))))


def find_target_branch(environment: Mapping[str, str] = os.environ) -> str:
    """Return the branch that the job runs for. Raise ForgeError."""
    branch = environment.get("CI_COMMIT_BRANCH" if environment.get("GITLAB_CI") else "GITHUB_REF_NAME", "")
    if not branch:
        raise ForgeError("neither GITHUB_REF_NAME nor CI_COMMIT_BRANCH says which branch this job runs for")
    return branch


def _list_requests(environment: Mapping[str, str]) -> Iterator[OpenRequest]:
    branch = find_target_branch(environment)
    if environment.get("GITLAB_CI"):
        api, project = open_gitlab(environment), find_gitlab_project(environment)
        query = urlencode({"state": "opened", "target_branch": branch})
        yield from _read_requests(
            api, f"/projects/{project}/merge_requests?{query}", "iid", "refs/merge-requests/{}/head"
        )
        return
    api, repository = open_github(environment)
    query = urlencode({"state": "open", "base": branch})
    yield from _read_requests(api, f"/repos/{repository}/pulls?{query}", "number", "refs/pull/{}/head")


def _read_requests(api: ForgeApi, path: str, number_key: str, ref_pattern: str) -> Iterator[OpenRequest]:
    for request in api.list_items(path, "open requests"):
        number: Any = request.get(number_key) if isinstance(request, dict) else None
        # It becomes a part of a name in git.
        if isinstance(number, int) and not isinstance(number, bool) and number > 0:
            yield OpenRequest(number, str(request.get("title", "")), ref_pattern.format(number))


ACTIONS_BOT = "github-actions[bot]"
MAX_COMMENT_LENGTH = 65_536


def find_pull_request(environment: Mapping[str, str]) -> CommentTarget:
    """Find the pull request that the job runs for. GITHUB_TOKEN needs the permission `pull-requests: write`."""
    api, repository = open_github(environment)
    return _target_pull_request(api, repository, _find_number(environment, api, repository))


def find_request(environment: Mapping[str, str], number: int) -> CommentTarget:
    """Return the pull or merge request of a number, in the repository that the job runs in."""
    if environment.get("GITLAB_CI"):
        return _target_merge_request(open_gitlab(environment), find_gitlab_project(environment), number)
    return _target_pull_request(*open_github(environment), number)


def open_github(environment: Mapping[str, str]) -> tuple[ForgeApi, str]:
    """Return GitHub's API with the job's token, and the repository."""
    token = environment.get("GITHUB_TOKEN") or environment.get("GH_TOKEN")
    repository = environment.get("GITHUB_REPOSITORY", "")
    if not token:
        raise ForgeError("GITHUB_TOKEN is not set: pass `${{ github.token }}` to this step")
    # It becomes a part of the URL: nothing but a name may get there.
    if not re.fullmatch(r"[\w.-]+/[\w.-]+", repository):
        raise ForgeError("GITHUB_REPOSITORY names no repository")
    headers = {"Authorization": f"Bearer {token}", "X-GitHub-Api-Version": "2022-11-28"}
    return ForgeApi(environment.get("GITHUB_API_URL", "https://api.github.com"), headers), repository


def _target_pull_request(api: ForgeApi, repository: str, number: int) -> CommentTarget:
    issues = f"/repos/{repository}/issues"
    return CommentTarget(
        api,
        f"{issues}/{number}/comments",
        f"{issues}/comments",
        "PATCH",
        ("user", "login", _token_author(api)),
        MAX_COMMENT_LENGTH,
    )


def _find_number(environment: Mapping[str, str], api: ForgeApi, repository: str) -> int:
    """Find the pull request's number by the event that started the job."""
    try:
        event = json.loads(Path(environment["GITHUB_EVENT_PATH"]).read_bytes())
        if "workflow_run" in event:
            return _find_reviewed_number(event["workflow_run"], api, repository)
        return int(event["pull_request"]["number"])
    except (KeyError, OSError, ValueError, TypeError):
        raise ForgeError("the event that started this job is no pull request") from None


def _find_reviewed_number(workflow_run: Mapping[str, Any], api: ForgeApi, repository: str) -> int:
    """Find the pull request whose review has ended, by its branch and commit.

    For a fork the event lists no pull requests. What the review uploaded could name one, but the fork wrote that, and
    might name a stranger's.
    """
    owner, branch = workflow_run["head_repository"]["owner"]["login"], workflow_run["head_branch"]
    query = urlencode({"state": "open", "head": f"{owner}:{branch}", "per_page": 100})
    for pull_request in api.send_request("GET", f"/repos/{repository}/pulls?{query}"):
        if pull_request["head"]["sha"] == workflow_run["head_sha"]:
            return int(pull_request["number"])
    msg = "no open pull request ends with the commit that was reviewed: it was closed, or its branch moved on"
    raise ForgeError(msg)


def _token_author(api: ForgeApi) -> object:
    """Return whose comments are ours: the token's user, or the bot of Actions for a job's own token."""
    try:
        return api.send_request("GET", "/user")["login"]
    except ForgeError as error:
        if error.status in {401, 403, 404}:
            return ACTIONS_BOT
        raise
    except (KeyError, TypeError):
        return ACTIONS_BOT


MAX_NOTE_LENGTH = 1_000_000


def find_merge_request(environment: Mapping[str, str]) -> CommentTarget:
    """Find the merge request that the job runs for."""
    api = open_gitlab(environment)
    number = environment.get("CI_MERGE_REQUEST_IID", "")
    if not (number.isascii() and number.isdecimal()):
        raise ForgeError("this job runs for no merge request")
    # A fork's pipeline runs in the fork, whose merge requests are others.
    project = environment.get("CI_MERGE_REQUEST_PROJECT_ID") or environment.get("CI_PROJECT_ID", "")
    return _target_merge_request(api, _require_number(project), int(number))


def open_gitlab(environment: Mapping[str, str]) -> ForgeApi:
    """Return GitLab's API with ARCHGEN_TOKEN, a project access token with the scope `api`."""
    token = environment.get("ARCHGEN_TOKEN")
    if not token:
        raise ForgeError(
            "ARCHGEN_TOKEN is not set: a job's own token cannot write comments, a project access token (scope api) can"
        )
    return ForgeApi(environment.get("CI_API_V4_URL", "https://gitlab.com/api/v4"), {"PRIVATE-TOKEN": token})


def find_gitlab_project(environment: Mapping[str, str]) -> str:
    """Return the number of the project that the job runs in."""
    return _require_number(environment.get("CI_PROJECT_ID", ""))


def _require_number(text: str) -> str:
    if not (text.isascii() and text.isdecimal()):
        raise ForgeError("this job runs for no merge request: CI_PROJECT_ID names no project")
    return text


def _target_merge_request(api: ForgeApi, project: str, number: int) -> CommentTarget:
    notes = f"/projects/{project}/merge_requests/{number}/notes"
    user = api.send_request("GET", "/user")
    if not isinstance(user, dict) or "id" not in user:
        raise ForgeError("GitLab does not say whose token this is")
    return CommentTarget(api, notes, notes, "PUT", ("author", "id", user["id"]), MAX_NOTE_LENGTH)
