"""The open pull or merge requests of the repository that a CI job runs in: what the forge's API says of them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple
from urllib.parse import urlencode

from archgen.forge.forge_api import ForgeApi, ForgeError
from archgen.forge.pull_request import find_gitlab_project, open_github, open_gitlab
from archgen.forge.time_limit import run_within

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
        msg = "neither GITHUB_REF_NAME nor CI_COMMIT_BRANCH says which branch this job runs for"
        raise ForgeError(msg)
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
