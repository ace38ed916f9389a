"""A merge request of GitLab, from the variables of a CI job."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.forge.comment_post import CommentTarget
from archgen.forge.forge_api import ForgeApi, ForgeError

MAX_NOTE_LENGTH = 1_000_000


def find_merge_request(environment: Mapping[str, str]) -> CommentTarget:
    """Find the merge request that the job runs for. ARCHGEN_TOKEN is a project access token with the scope `api`."""
    token = environment.get("ARCHGEN_TOKEN")
    if not token:
        msg = (
            "ARCHGEN_TOKEN is not set: a job's own token cannot write comments, a project access token (scope api) can"
        )
        raise ForgeError(msg)
    project, number = environment.get("CI_PROJECT_ID", ""), environment.get("CI_MERGE_REQUEST_IID", "")
    if not (project.isascii() and project.isdecimal() and number.isascii() and number.isdecimal()):
        msg = "this job runs for no merge request"
        raise ForgeError(msg)
    api = ForgeApi(environment.get("CI_API_V4_URL", "https://gitlab.com/api/v4"), {"PRIVATE-TOKEN": token})
    notes = f"/projects/{project}/merge_requests/{number}/notes"
    user = api.send_request("GET", "/user")
    if not isinstance(user, dict) or "id" not in user:
        msg = "GitLab does not say whose token this is"
        raise ForgeError(msg)
    return CommentTarget(api, notes, notes, "PUT", ("author", "id", user["id"]), MAX_NOTE_LENGTH)
