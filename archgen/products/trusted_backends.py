"""Which of a project's own backends and passes may run in a review: those that a trusted revision names, as they are there."""

from __future__ import annotations

import os
import stat
from collections.abc import Collection
from pathlib import Path

from archgen.emit.backend_manifests import Backend
from archgen.emit.file_tree import OutputError, list_files_below
from archgen.frozen import dataclass
from archgen.git.object_reader import LINK_MODE, GitObjects, TreeEntry
from archgen.pipeline import VersionCache, check_loaded_project
from archgen.project import NotAtRevisionError, find_tracked_project, load_at_revision
from archgen.syntax.committed_files import CommittedFiles
from archgen.syntax.project_files import ProjectFiles

_MAX_NAMED_FILES = 3


class UntrustedPassError(OutputError):
    """A pass of the project may not run: the trusted revision does not name it, or holds another one."""


class UntrustedBackendError(OutputError):
    """A backend of the project may not run: the trusted revision does not name it, or holds another one."""


@dataclass(frozen=True, slots=True)
class TrustedRevision:
    """What a revision that is trusted says about the project's own backends and passes."""

    revision: str
    """As the user wrote it."""
    allowed_names: Collection[str] = ()
    committed_files: CommittedFiles | None = None
    """The project's files there; None where the project does not exist there."""
    allowed_passes: Collection[str] = ()


def read_trusted_revision(
    project: Path | None, revision: str, version_cache: VersionCache | None = None
) -> TrustedRevision:
    """Read what a revision says about backends. A project that is new since then is allowed none.

    Raise `git.GitError` where it cannot be read.
    """
    version_cache = version_cache or VersionCache()
    try:
        # The main line decides: the branch under review must not allow its own templates to run.
        loaded_project = load_at_revision(find_tracked_project(project), revision, version_cache.parsed_slices)
    except NotAtRevisionError:
        return TrustedRevision(revision)
    files = loaded_project.files
    review = check_loaded_project(loaded_project, version_cache, (), has_timing=False).architecture.review
    return TrustedRevision(
        revision, review.backends, files if isinstance(files, CommittedFiles) else None, review.passes
    )


def refuse_untrusted(backend: Backend, trusted_revision: TrustedRevision) -> None:
    """Raise UntrustedBackendError unless the revision names the backend and holds the very files of its folder."""
    refusal = f"the project's own backend `{backend.id}` is not run here:"
    revision, committed_files = trusted_revision.revision, trusted_revision.committed_files
    if committed_files is None or backend.id not in trusted_revision.allowed_names:
        msg = f"{refusal} the revision that is trusted does not name it"
        raise UntrustedBackendError(msg, "add it to `review.backends` there, in a change of its own")
    # A name alone would let the branch bring templates of its own under it.
    if backend.name not in committed_files.folders:
        msg = f"{refusal} `{revision}` has no folder `{backend.name}`"
        raise UntrustedBackendError(msg, f"bring the folder into `{revision}` first, in a change of its own")
    different_files = _list_different_files(backend, committed_files)
    if different_files:
        names = ", ".join(f"`{file}`" for file in different_files[:_MAX_NAMED_FILES])
        further = len(different_files) - _MAX_NAMED_FILES
        msg = (
            f"{refusal} it differs from the one in `{revision}`: {names}{f' and {further} more' if further > 0 else ''}"
        )
        raise UntrustedBackendError(
            msg, f"bring its change into `{revision}` first, or this branch up to date with `{revision}`"
        )


def refuse_untrusted_pass(name: str, file: str, files: ProjectFiles, trusted_revision: TrustedRevision) -> None:
    """Raise UntrustedPassError unless the revision names a pass of the project and holds the very file of it."""
    refusal = f"the project's own pass `{name}` is not run here:"
    revision, committed_files = trusted_revision.revision, trusted_revision.committed_files
    if committed_files is None or name not in trusted_revision.allowed_passes:
        msg = f"{refusal} the revision that is trusted does not name it"
        raise UntrustedPassError(msg, "add it to `review.passes` there, in a change of its own")
    there, here = committed_files.fetch_bytes(file), files.fetch_bytes(file)
    is_same = isinstance(there, bytes) and isinstance(here, bytes) and here.replace(b"\r\n", b"\n") == there
    if files.is_behind_link(file) or committed_files.is_behind_link(file) or not (is_same or there == here):
        msg = f"{refusal} `{file}` is not as it is in `{revision}`"
        raise UntrustedPassError(
            msg, f"bring its change into `{revision}` first, or this branch up to date with `{revision}`"
        )


def _list_different_files(backend: Backend, committed_files: CommittedFiles) -> list[str]:
    """Return the files of the backend's folder that are only on disk, only in the commit, or not the same in both."""
    prefix = f"{backend.name}/"
    blobs = {path: blob for path, blob in committed_files.blobs.items() if path.startswith(prefix)}
    disk_files = {prefix + path: backend.folder / path for path in list_files_below(backend.folder)}
    return [
        path
        for path in sorted(blobs.keys() | disk_files.keys())
        if path not in blobs
        or path not in disk_files
        or not _has_content(disk_files[path], blobs[path], committed_files.objects)
    ]


def _has_content(file: Path, blob: TreeEntry, objects: GitObjects) -> bool:
    """Whether a file or link on disk is what a commit holds; it is never executed, so its permissions do not count."""
    # The size first, so that no file is read that is far larger; git's conversion of line ends doubles it at most.
    size = objects.blob_size(blob.object_id)
    status = file.lstat()
    if size is None or status.st_size > 2 * size:
        return False
    if stat.S_ISLNK(status.st_mode):
        return blob.mode == LINK_MODE and os.fsencode(file.readlink()) == objects.read_blob(blob.object_id)
    if blob.mode == LINK_MODE or not stat.S_ISREG(status.st_mode):
        return False
    data = file.read_bytes()
    return objects.read_blob(blob.object_id) in {data, data.replace(b"\r\n", b"\n")}
