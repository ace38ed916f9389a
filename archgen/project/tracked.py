"""A project in its repository: the same project at any commit."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from pathlib import Path

from archgen.git import NoRepositoryError, Objects, repository, resolve
from archgen.project.find import MARKER, ProjectNotFoundError, find
from archgen.project.loaded import Loaded, load_from
from archgen.project.slices import Slices
from archgen.syntax.committed import committed


class NotAtRevisionError(ProjectNotFoundError):
    """The project does not exist in a commit."""


@dataclass(frozen=True, slots=True)
class Tracked:
    """Where a project is in its repository.

    `locations` are the candidates in the order in which they are tried, each a folder from the repository's root and
    the file read first. There are several only where the disk does not (or no longer) hold the project.
    """

    objects: Objects
    places: tuple[tuple[str, str], ...]

    def commit(self, revision: str) -> str:
        """Return the full hash of a revision's commit. Raises what `git.resolve` raises."""
        return resolve(self.objects.repository, revision)


def tracked(path: Path | None = None) -> Tracked:
    """Find the repository of the project at a path (None: around the current folder), on disk or only in commits.

    Raises `git.NoRepositoryError`, and `ProjectNotFoundError` where neither a project nor a repository is there.
    """
    try:
        root, first = find(path)
    except ProjectNotFoundError as nothing:
        return _only_committed(path, nothing)
    found = repository(root)
    return Tracked(Objects(found), ((found.prefix, first),))


def _only_committed(path: Path | None, nothing: ProjectNotFoundError) -> Tracked:
    try:
        found = repository(path or Path.cwd())
    except (NoRepositoryError, OSError):
        raise nothing from None
    prefix = found.prefix
    # A path that is not on disk may have been a folder with an archgen.yaml or a file; without a path, archgen.yaml may
    # have been in the current folder or any folder above it, as in find_project.
    if path is not None:
        return Tracked(Objects(found), ((prefix, MARKER), (posixpath.dirname(prefix), posixpath.basename(prefix))))
    folders = [prefix]
    while folders[-1]:
        folders.append(posixpath.dirname(folders[-1]))
    return Tracked(Objects(found), tuple((folder, MARKER) for folder in folders))


def load_at(project: Tracked, revision: str, known: Slices | None = None) -> Loaded:
    """Read a project at a revision, from git's objects; slices in `parsed_slices` are not parsed again.

    Raises `NotAtRevisionError` if the project does not exist there, and what `git.resolve` raises.
    """
    return load_commit(project, project.commit(revision), known, revision)


def load_commit(project: Tracked, commit: str, known: Slices | None = None, revision: str = "") -> Loaded:
    """Read a project at a commit, given by its full hash; `revision` is the name that errors use.

    Raises `NotAtRevisionError` if the project does not exist there.
    """
    for folder, first in project.places:
        files = committed(project.objects, commit, folder)
        if first and files is not None and files.exists(first):
            return load_from(files, first, known)
    folder, first = project.places[0]
    msg = f"the project `{posixpath.join(folder, first)}` does not exist in `{revision or commit}`"
    raise NotAtRevisionError(msg)
