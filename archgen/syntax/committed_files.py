"""Read a project's files from a commit, straight from git's objects: nothing is checked out.

Links are followed here, not by the operating system: a commit may hold any link, and none may leave the project.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from pathlib import Path

from archgen.frozen import dataclass
from archgen.git.object_reader import LINK_MODE, SUBMODULE_MODE, GitObjects, TreeEntry
from archgen.syntax.project_files import (
    MAX_BYTES,
    NO_SUCH_FOLDER,
    TOO_LARGE,
    FileRefusal,
    find_path_refusal,
    find_place_refusal,
)

_MAX_LINKS = 40  # Linux gives up after as many (MAXSYMLINKS), with the same message
_LINK_LEADS_OUT = FileRefusal("this link leads out of the project's folder", "copy the file into the project")
_LINK_IS_BROKEN = FileRefusal("this is a broken link: what it points to does not exist")
_LINKS_LOOP = FileRefusal("the file cannot be read: too many levels of symbolic links")
_FILE_IS_ABSENT = FileRefusal("the file cannot be read: no such file or directory")
_FILE_IS_FOLDER = FileRefusal("this is a folder, not a file")
_CONTENT_NOT_FETCHED = FileRefusal(
    "this partial clone does not hold the file's content", "fetch it with `git checkout`, then try again"
)


@dataclass(frozen=True, slots=True)
class CommittedFiles:
    """The files below one folder of a commit. Implements `ProjectFiles`."""

    objects: GitObjects
    commit: str
    root: Path
    blobs: Mapping[str, TreeEntry]
    """Regular files, links and submodules, by path."""
    folders: Mapping[str, tuple[str, ...]]
    """The names in each folder, by the folder's path; "" is the project's own."""

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link.

        Every path inside a submodule counts as present: a commit holds only the submodule's hash, not its files.
        """
        folder, _, name = posixpath.normpath(path).rpartition("/")
        # Only the folder is resolved: the last name may be a link that points nowhere, as with os.path.lexists.
        parent = self._follow_links(folder)
        if isinstance(parent, FileRefusal):
            return False
        resolved_path = posixpath.join(parent, name)
        return (
            resolved_path in self.blobs
            or resolved_path in self.folders
            or self._find_submodule(resolved_path) is not None
        )

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        return self._follow_links(path) != posixpath.normpath(path)

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk as `os.walk` does; a submodule is an empty folder. Callers may remove folders from the list in place."""
        start = self._follow_links(top)
        pending_folders = [] if isinstance(start, FileRefusal) or start not in self.folders else [(start, "")]
        while pending_folders:
            folder, relative_folder = pending_folders.pop()
            content_names = self.folders.get(folder, ())
            folder_names = [name for name in content_names if self._is_folder(posixpath.join(folder, name))]
            folders, file_names = list(folder_names), [name for name in content_names if name not in folder_names]
            yield relative_folder, folders, file_names
            # `folders` may be shorter now: the caller takes out what it does not want to enter. Reversed, because the
            # last path is popped first. A link to a folder is listed but is no key of self.folders: it is not entered.
            pending_folders += [
                (path, posixpath.join(relative_folder, name))
                for name in reversed(folders)
                if (path := posixpath.join(folder, name)) in self.folders
            ]

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a file's bytes as they were committed, or why it cannot be used."""
        resolved_path = self._follow_links(path)
        if isinstance(resolved_path, FileRefusal):
            return resolved_path
        blob = self.blobs.get(resolved_path)
        if blob is None:
            submodule = self._find_submodule(resolved_path)
            if submodule:
                return FileRefusal(f"this lies in the submodule `{submodule}`, of which a commit holds no files")
            return _FILE_IS_FOLDER if resolved_path in self.folders else _FILE_IS_ABSENT
        if blob.mode == SUBMODULE_MODE:
            return _FILE_IS_FOLDER
        # The size is asked first: a huge blob is never brought into memory. None: the object is not in this clone.
        size = self.objects.blob_size(blob.object_id)
        if size is not None and size > MAX_BYTES:
            return TOO_LARGE
        data = self.objects.read_blob(blob.object_id) if size is not None else None
        return _CONTENT_NOT_FETCHED if data is None else data

    def open_folder(self, path: str) -> CommittedFiles | FileRefusal:
        """Return the files of another folder of the same commit, or why they cannot be used.

        git lists nothing below a link or a submodule: there is no such folder.
        """
        own_folder = self.root.relative_to(self.objects.repository.top).as_posix()
        refusal = find_path_refusal(path) or find_place_refusal(own_folder, path)
        if refusal:
            return refusal
        target = posixpath.normpath(posixpath.join(own_folder, path))
        return list_committed_files(self.objects, self.commit, target) or NO_SUCH_FOLDER

    def _find_submodule(self, path: str) -> str | None:
        """Return the submodule that a path lies in, or None."""
        parts = path.split("/")
        parent_paths = ("/".join(parts[:end]) for end in range(1, len(parts)))
        return next(
            (name for name in parent_paths if (blob := self.blobs.get(name)) and blob.mode == SUBMODULE_MODE), None
        )

    def _is_folder(self, path: str) -> bool:
        blob = self.blobs.get(path)
        if blob is None or blob.mode == SUBMODULE_MODE:
            return True
        return blob.mode == LINK_MODE and self._follow_links(path) in self.folders

    def _follow_links(self, path: str) -> str | FileRefusal:
        """Follow the links on a path; return the path they lead to, which need not exist, or a refusal if it leaves."""
        # A stack of path parts, the next one last: a link's target replaces the link, relative to the link's folder.
        pending_parts, resolved_path, link_count = path.split("/")[::-1], "", 0
        while pending_parts:
            part = pending_parts.pop()
            if part in {"", "."}:
                continue
            if part == "..":
                if not resolved_path:
                    return _LINK_LEADS_OUT
                resolved_path = posixpath.dirname(resolved_path)
                continue
            resolved_path = posixpath.join(resolved_path, part)
            blob = self.blobs.get(resolved_path)
            if blob is None or blob.mode != LINK_MODE:
                continue
            target, link_count = self._read_link_target(blob), link_count + 1
            if target.startswith("/"):
                return _LINK_LEADS_OUT
            if link_count > _MAX_LINKS:
                return _LINKS_LOOP
            resolved_path = posixpath.dirname(resolved_path)
            pending_parts += target.split("/")[::-1]
        # Without a link on the way a missing file is simply absent, which fetch_bytes says in other words.
        return (
            _LINK_IS_BROKEN
            if link_count and resolved_path and resolved_path not in self.blobs and resolved_path not in self.folders
            else resolved_path
        )

    def _read_link_target(self, blob: TreeEntry) -> str:
        size = self.objects.blob_size(blob.object_id)
        data = self.objects.read_blob(blob.object_id) if size is not None and size < MAX_BYTES else None
        # A target that cannot be read (partial clone, absurd size) counts as absolute, which _follow_links refuses.
        return "/" if data is None else data.decode("utf-8", "surrogateescape")


def list_committed_files(objects: GitObjects, commit: str, folder_path: str) -> CommittedFiles | None:
    """Return the files below a folder of a commit, or None where the commit has no such folder."""
    blobs = objects.list_tree(commit, folder_path)
    if blobs is None:
        return None
    # git lists files only; folders follow from their paths. Dicts serve as ordered sets: git's order is kept.
    names_by_folder: dict[str, dict[str, None]] = {"": {}}
    for path in blobs:
        current_path = path
        while current_path:
            parent, _, name = current_path.rpartition("/")
            is_parent_known = parent in names_by_folder
            names_by_folder.setdefault(parent, {})[name] = None
            if is_parent_known:
                break  # then all folders above are known as well
            current_path = parent
    folder_contents = {folder: tuple(names) for folder, names in names_by_folder.items()}
    return CommittedFiles(objects, commit, objects.repository.top / folder_path, blobs, folder_contents)
