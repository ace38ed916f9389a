"""Where pull requests live: put one comment on a pull request of GitHub or a merge request of GitLab, and keep it
current.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from archgen.forge.comment_post import CommentOutcome, put_comment
from archgen.forge.forge_api import ForgeError
from archgen.forge.pull_request import find_merge_request, find_pull_request

__all__ = ["CommentOutcome", "ForgeError", "post_comment"]


def post_comment(text: str, key: str, environment: Mapping[str, str] = os.environ) -> CommentOutcome:
    """Put a text on the pull request that a CI job runs for, replacing the one that was put there under this key.

    The job's environment says where: GitHub's or GitLab's own variables, and a token that may write comments. Raises
    `ForgeError` where there is no pull request or the forge refuses.
    """
    if environment.get("GITLAB_CI"):
        return put_comment(find_merge_request(environment), text, key)
    if environment.get("GITHUB_ACTIONS"):
        return put_comment(find_pull_request(environment), text, key)
    msg = "this is no job of GitHub Actions or GitLab CI: neither GITHUB_ACTIONS nor GITLAB_CI is set"
    raise ForgeError(msg)
