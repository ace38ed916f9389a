"""A project in its repository: the same project at any commit."""

from __future__ import annotations

import posixpath
from pathlib import Path

from archgen.frozen import dataclass
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
from archgen.project.slice_parsing import ParsedSlices, parse_slice
from archgen.syntax.committed_files import list_committed_files
from archgen.syntax.project_files import MAX_BYTES
from archgen.syntax.yaml_tree import ScalarNode, find_value

_MAX_GONE_PROJECTS = 100
"""Maximal number of projects that are read to find one that moved."""


class NotAtRevisionError(ProjectNotFoundError):
    """The project does not exist in a commit."""


class UnclearMoveError(NotAtRevisionError):
    """Several projects of a commit are gone, and nobody can say which of them the project was."""


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


def find_moved_project(
    tracked_project: TrackedProject, revision: str, project_id: str, later_revision: str = ""
) -> TrackedProject:
    """Find a project that lay in another folder at a revision: the one with its id, else the only one that is gone.

    Only those count that are not there any more, on disk or at a later revision: what is still there did not move.
    Raises `NotAtRevisionError` if there is none, `UnclearMoveError` where nobody can say which of several it is.
    """
    objects = tracked_project.objects
    tree = objects.list_tree(tracked_project.resolve_commit(revision)) or {}
    later_tree = objects.list_tree(tracked_project.resolve_commit(later_revision)) if later_revision else None
    top = objects.repository.top
    gone_files = [
        path
        for path in tree
        if posixpath.basename(path) == PROJECT_FILE
        and not (path in later_tree if later_tree is not None else (top / path).exists())
    ][:_MAX_GONE_PROJECTS]
    named_files = [path for path in gone_files if _read_project_id(objects, tree[path].object_id) == project_id]
    candidates = named_files or gone_files
    if len(candidates) == 1:
        return TrackedProject(objects, ((posixpath.dirname(candidates[0]), PROJECT_FILE),))
    folder, first_file = tracked_project.locations[0]
    msg = f"the project `{posixpath.join(folder, first_file)}` does not exist in `{revision}`"
    if not candidates:
        raise NotAtRevisionError(msg)
    msg += f", and which of {len(candidates)} others it was is not clear"
    raise UnclearMoveError(msg)


def _read_project_id(objects: GitObjects, blob_id: str) -> str | None:
    """Return the id that an archgen.yaml writes for its project."""
    size = objects.blob_size(blob_id)
    data = objects.read_blob(blob_id) if size is not None and size <= MAX_BYTES else None
    document = parse_slice(PROJECT_FILE, data.decode("utf-8", "replace")).document if data is not None else None
    section = document.root.get("project") if document else None
    project_id = find_value(section, "id")
    return project_id.text if isinstance(project_id, ScalarNode) else None


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
