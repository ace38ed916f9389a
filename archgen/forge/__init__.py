"""Where pull requests live: put one comment on a pull request of GitHub or a merge request of GitLab, and keep it
current.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from archgen.forge.forge_api import ForgeError, run_within
from archgen.forge.pull_request import CommentOutcome, CommentTarget, find_merge_request, find_pull_request, put_comment

TOTAL_SECONDS = 120.0
"""All requests together. Each waits at most 30 s for the next byte, but a server may send a byte now and then."""

__all__ = ["CommentOutcome", "ForgeError", "post_comment"]


def post_comment(text: str, key: str, environment: Mapping[str, str] = os.environ) -> CommentOutcome:
    """Put a text on the pull request that a CI job runs for, replacing the one that was put there under this key.

    The job's environment says where: GitHub's or GitLab's own variables, and a token that may write comments. Raises
    `ForgeError` where there is no pull request, or the forge refuses or does not answer within two minutes.
    """
    return run_within(TOTAL_SECONDS, lambda: put_comment(_find_target(environment), text, key))


def _find_target(environment: Mapping[str, str]) -> CommentTarget:
    if environment.get("GITLAB_CI"):
        return find_merge_request(environment)
    if environment.get("GITHUB_ACTIONS"):
        return find_pull_request(environment)
    raise ForgeError("this is no job of GitHub Actions or GitLab CI: neither GITHUB_ACTIONS nor GITLAB_CI is set")
