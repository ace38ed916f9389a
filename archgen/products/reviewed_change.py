"""The change that a review judges: from where the branch left what it is merged into, to the files as they are now.

Comment, findings and outputs are all of these files: a comment about HEAD beside findings of an edited work tree would
contradict them.
"""

from __future__ import annotations

import shlex
from pathlib import Path, PurePosixPath

from archgen import git, project
from archgen.compare import Comparison
from archgen.compare.review_facts import ReviewFacts
from archgen.diagnostics import Diagnostic, shorten_hash
from archgen.frozen import NamedTuple, dataclass, field
from archgen.git.project_revision import differs_from_head
from archgen.git.repository_lookup import look_up_commit
from archgen.pipeline import CheckedProject, VersionCache
from archgen.products.compared_versions import (
    WORKING_TREE_NAME,
    ProjectVersion,
    compare_named_versions,
    read_at_base,
)
from archgen.products.merge_breaks import find_breaks
from archgen.products.workspace_changes import WorkspaceChanges, find_new_differences
from archgen.project import PROJECT_FILE
from archgen.project.project_tracking import TrackedProject, load_at_commit


class ReviewedRequest(NamedTuple):
    """A pull or merge request, or what waits in a merge queue: its name in titles, the branch it is merged into, and its
    last commit (both empty if unknown).

    `merge_commit` is the merge that the forge made of both for the job: empty if it made one whose hash is unknown, None
    if it made none.
    """

    name: str
    target_branch: str = ""
    head_commit: str = ""
    merge_commit: str | None = None


@dataclass(frozen=True, slots=True)
class ReviewedChange:
    """A compared change: both versions, what changed, which breaks count, and the command that shows it to a reader."""

    old_version: ProjectVersion
    new_version: ProjectVersion
    comparison: Comparison
    breaks: tuple[Diagnostic, ...]
    command: str
    code: WorkspaceChanges = field(default_factory=WorkspaceChanges)
    """What the code does otherwise than the model says since the change."""


def find_merge_target(path: Path | None, base: str, request: ReviewedRequest | None) -> str:
    """Return the revision that the change is merged into: `base`, or the first parent of the merge that a forge made.

    What a forge names as base may be older than what it merged into. Raise what `project.find_tracked_project` raises.
    """
    if request is None or request.merge_commit is None:
        return base
    repository = project.find_tracked_project(path).objects.repository
    # A job may have checked out the branch instead. A merge train that fast-forwards has no merge either; a shallow
    # clone cannot say, and is told so where the parent is asked for.
    is_checked_out = request.merge_commit in {"", look_up_commit(repository, "HEAD")}
    is_merge = repository.is_shallow or bool(look_up_commit(repository, "HEAD^2"))
    return "HEAD^1" if is_checked_out and is_merge else base


def compare_change(  # noqa: PLR0913, PLR0917 - what is compared, and all that is known of it
    checked_project: CheckedProject,
    path: Path | None,
    target: str,
    request: ReviewedRequest | None,
    version_cache: VersionCache,
    forge_facts: ReviewFacts | None = None,
) -> ReviewedChange:
    """Compare a project with where it left `target`. Raise `git.GitError`, or `project.NotAtRevisionError` where it did
    not exist there.
    """
    tracked_project = project.find_tracked_project(path)
    repository = tracked_project.objects.repository
    # HEAD has all of its own parent; any other target may have moved on.
    fork = git.find_common_commit(repository, target, "HEAD")
    if fork.commit_id == git.resolve_revision(repository, target):
        fork = fork._replace(description=target)
    old_name = request.target_branch if request and request.target_branch else fork.description
    new_version = _name_version(checked_project, tracked_project, request, version_cache)
    old_version = read_at_base(git.BaseCommit(fork.commit_id, old_name), path, version_cache, new_version)
    comparison = compare_named_versions(old_version, new_version, forge_facts=forge_facts)
    return ReviewedChange(
        old_version,
        new_version,
        comparison,
        find_breaks(comparison, checked_project),
        _repeat_command(old_version, new_version, tracked_project, request),
        find_new_differences(
            old_version.checked_project,
            checked_project,
            tracked_project.objects,
            fork.commit_id,
            tracked_project.locations[0][0],
        ),
    )


def _name_version(
    checked_project: CheckedProject,
    tracked_project: TrackedProject,
    request: ReviewedRequest | None,
    version_cache: VersionCache,
) -> ProjectVersion:
    """Name the files as they are: by the request or HEAD if they are what was committed, else as the work tree."""
    head = git.resolve_revision(tracked_project.objects.repository, "HEAD")
    is_committed = _is_as_committed(checked_project, tracked_project, head, version_cache)
    if request is None:
        name = "HEAD" if is_committed else f"{WORKING_TREE_NAME}, with changes that are not committed"
        return ProjectVersion(name, checked_project, head if is_committed else "")
    addition = "" if is_committed else ", with changes that are not committed"
    return ProjectVersion(f"{request.name}{addition}", checked_project, request.head_commit or head)


def _is_as_committed(
    checked_project: CheckedProject, tracked_project: TrackedProject, head: str, version_cache: VersionCache
) -> bool:
    """Whether the files of a project are those of HEAD: none changed, came or went."""
    try:
        committed_project = load_at_commit(tracked_project, head, version_cache.parsed_slices)
    except project.NotAtRevisionError:
        return False
    files = {*checked_project.loaded_project.sources.file_names(), *checked_project.input_files}
    committed_files = {*committed_project.sources.file_names(), *committed_project.interface_files}
    return committed_files <= files and not differs_from_head(checked_project.root, sorted(files))


def _repeat_command(
    old_version: ProjectVersion,
    new_version: ProjectVersion,
    tracked_project: TrackedProject,
    request: ReviewedRequest | None,
) -> str:
    """Return the command that shows the same in a clone, by hashes: names mean other commits tomorrow."""
    folder, first_file = tracked_project.locations[0]
    place = folder if first_file == PROJECT_FILE else str(PurePosixPath(folder, first_file))
    old_hash, new_hash = shorten_hash(old_version.commit), shorten_hash(new_version.commit)
    # A forge's merge commit is in nobody's clone: what the branch did since it left the other commit is the same change.
    versions = [f"{old_hash}...{new_hash}"] if request else [old_hash, *([new_hash] if new_hash else [])]
    return " ".join(["archgen diff", *versions, *(["-C", shlex.quote(place)] if place else [])])
