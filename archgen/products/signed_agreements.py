"""Which agreements of two partners were signed: the tags that record it, and the project as it was then.

A tag counts that is called `signed/A-B/...`, with the ids of both partners in either order, and lies in the history of HEAD.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from archgen.diagnostics import shorten_hash
from archgen.frozen import replace
from archgen.git import GitError
from archgen.git.commit_log import list_tags_below
from archgen.model.agreed_terms import Signature
from archgen.pipeline import CheckedProject, VersionCache
from archgen.products import compared_versions
from archgen.products.compared_versions import ProjectVersion
from archgen.project import ProjectNotFoundError
from archgen.views.agreement.interface_record import SignedTag


def find_signed_tags(root: Path, first: str, second: str) -> tuple[SignedTag, ...]:
    """Return the tags that record signatures of two partners, newest first."""
    prefixes = (f"signed/{first}-{second}", f"signed/{second}-{first}")
    return tuple(
        SignedTag(tag.name, tag.date, tag.tagger, tag.subject, shorten_hash(tag.commit))
        for tag in list_tags_below(root, prefixes)
    )


def read_last_signed(
    checked_project: CheckedProject, signature: Signature | None, signed_tags: Sequence[SignedTag]
) -> ProjectVersion | None:
    """Read a project as it was signed last: as `agreements` records it, else at the newest tag; None where that cannot be."""
    if signature:
        revision, name = signature.revision or "", signature.tag or shorten_hash(signature.revision or "")
    elif signed_tags:
        name = signed_tags[0].name
        revision = f"refs/tags/{name}"
    else:
        return None
    try:
        return replace(read_agreed_version(revision, checked_project), name=name)
    except (GitError, ProjectNotFoundError):
        return None


def read_agreed_version(revision: str, checked_project: CheckedProject, path: Path | None = None) -> ProjectVersion:
    """Read a project as it was, also where it lay in another folder. `path` is where it is now, by default its root.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    working_tree = ProjectVersion(compared_versions.WORKING_TREE_NAME, checked_project)
    project_path = path or checked_project.root
    return compared_versions.read_earlier_version(revision, project_path, VersionCache(), working_tree)
