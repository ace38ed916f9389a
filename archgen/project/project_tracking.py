"""A project in its repository: the same project at any commit."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from pathlib import Path

from archgen.git import (
    GitObjects,
    NoRepositoryError,
    UnknownRevisionError,
    find_repository,
    look_up_tree,
    resolve_revision,
)
from archgen.project.project_loading import LoadedProject, load_from_files
from archgen.project.project_search import PROJECT_FILE, ProjectNotFoundError, find_project
from archgen.project.slice_parsing import ParsedSlices
from archgen.syntax.committed_files import list_committed_files


class NotAtRevisionError(ProjectNotFoundError):
    """The project does not exist in a commit."""


@dataclass(frozen=True, slots=True)
class TrackedProject:
    """Where a project is in its repository.

    `locations` are the candidates in the order in which they are tried, each a folder from the repository's root and
    the file read first. There are several only where the disk does not (or no longer) hold the project.
    """

    objects: GitObjects
    locations: tuple[tuple[str, str], ...]

    def resolve_commit(self, revision: str) -> str:
        """Return the full hash of a revision's commit, or of a tree. Raises what `git.resolve_revision` raises."""
        try:
            return resolve_revision(self.objects.repository, revision)
        except UnknownRevisionError:
            # Such as the tree that `git merge-tree` makes of two branches: files without a history.
            tree = look_up_tree(self.objects.repository, revision)
            if not tree:
                raise
            return tree


def find_tracked_project(path: Path | None = None) -> TrackedProject:
    """Find the repository of the project at a path (None: around the current folder), on disk or only in commits.

    Raises `git.NoRepositoryError`, and `ProjectNotFoundError` where neither a project nor a repository is there.
    """
    try:
        root, first_file = find_project(path)
    except ProjectNotFoundError as nothing:
        return _find_in_commits(path, nothing)
    git_repository = find_repository(root)
    return TrackedProject(GitObjects(git_repository), ((git_repository.prefix, first_file),))


def _find_in_commits(path: Path | None, not_found: ProjectNotFoundError) -> TrackedProject:
    try:
        git_repository = find_repository(path or Path.cwd())
    except (NoRepositoryError, OSError):
        raise not_found from None
    prefix = git_repository.prefix
    # A path that is not on disk may have been a folder with an archgen.yaml or a file; without a path, archgen.yaml may
    # have been in the current folder or any folder above it, as in find_project.
    if path is not None:
        return TrackedProject(
            GitObjects(git_repository),
            ((prefix, PROJECT_FILE), (posixpath.dirname(prefix), posixpath.basename(prefix))),
        )
    folders = [prefix]
    while folders[-1]:
        folders.append(posixpath.dirname(folders[-1]))
    return TrackedProject(GitObjects(git_repository), tuple((folder, PROJECT_FILE) for folder in folders))


def load_at_revision(
    tracked_project: TrackedProject, revision: str, parsed_slices: ParsedSlices | None = None
) -> LoadedProject:
    """Read a project at a revision, from git's objects; slices in `parsed_slices` are not parsed again.

    Raises `NotAtRevisionError` if the project does not exist there, and what `git.resolve` raises.
    """
    return load_at_commit(tracked_project, tracked_project.resolve_commit(revision), parsed_slices, revision)


def load_at_commit(
    tracked_project: TrackedProject, commit: str, parsed_slices: ParsedSlices | None = None, revision: str = ""
) -> LoadedProject:
    """Read a project at a commit, given by its full hash; `revision` is the name that errors use.

    Raises `NotAtRevisionError` if the project does not exist there.
    """
    for folder, first_file in tracked_project.locations:
        files = list_committed_files(tracked_project.objects, commit, folder)
        if first_file and files is not None and files.has_path(first_file):
            return load_from_files(files, first_file, parsed_slices)
    folder, first_file = tracked_project.locations[0]
    msg = f"the project `{posixpath.join(folder, first_file)}` does not exist in `{revision or commit}`"
    raise NotAtRevisionError(msg)
