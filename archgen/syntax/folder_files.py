"""Read a project's files from a folder on disk."""

from __future__ import annotations

import os
import posixpath
import stat
from collections.abc import Iterator
from pathlib import Path

from archgen.frozen import dataclass
from archgen.regular_files import NoRegularFileError, describe_file_kind, open_named_file
from archgen.syntax.project_files import (
    MAX_BYTES,
    NO_SUCH_FOLDER,
    TOO_LARGE,
    FileRefusal,
    find_path_refusal,
    find_place_refusal,
)


@dataclass(frozen=True, slots=True)
class FolderFiles:
    """The files below a folder on disk. Implements `ProjectFiles`."""

    root: Path
    commit: str = ""

    def has_path(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link."""
        return os.path.lexists(self.root / path)

    def is_behind_link(self, path: str) -> bool:
        """Whether a path leads to a file through a symbolic link."""
        parts = path.split("/")
        return any((self.root / "/".join(parts[:end])).is_symlink() for end in range(1, len(parts) + 1))

    def walk_folders(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk as `os.walk` does, with folders relative to `top`; links to folders are not entered."""
        # `os.walk` of Python 3.11 calls itself for each level, and a branch may nest folders deeper than Python calls.
        pending_folders = [""]
        while pending_folders:
            relative_folder = pending_folders.pop()
            folders, file_names, links = _list_folder(self.root / top / relative_folder)
            yield relative_folder, folders, file_names
            # The caller has taken out what is not to be entered.
            pending_folders += [
                posixpath.join(relative_folder, name) for name in reversed(folders) if name not in links
            ]

    def fetch_bytes(self, path: str) -> bytes | FileRefusal:
        """Return a regular file's bytes, or why it cannot be used.

        It never waits for the other end of a pipe and never follows a link out of the folder.
        """
        full_path = self.root / path
        real_path = Path(os.path.realpath(full_path))
        if not real_path.is_relative_to(os.path.realpath(self.root)):
            return FileRefusal("this link leads out of the project's folder", "copy the file into the project")
        try:
            # It leads to no link now: one that is there later was put there since.
            return _read_regular_file(real_path, flags=getattr(os, "O_NOFOLLOW", 0))
        except NoRegularFileError as error:
            return FileRefusal(str(error.strerror))
        except OSError as error:
            return FileRefusal(_describe_read_error(full_path, error))

    def open_folder(self, path: str) -> FolderFiles | FileRefusal:
        """Return the files of another folder of the repository, or why they cannot be used."""
        # Imported here: only projects with libraries ask git.
        from archgen.git import NoRepositoryError, find_repository

        refusal = find_path_refusal(path)
        if refusal:
            return refusal
        try:
            own_folder, has_repository = find_repository(self.root).prefix, True
        except NoRepositoryError:
            own_folder, has_repository = "", False
        refusal = find_place_refusal(own_folder, path, has_repository=has_repository)
        if refusal:
            return refusal
        target = os.path.normpath(os.path.join(os.path.realpath(self.root), path))  # noqa: PTH118 - `..` goes by names
        if not os.path.isdir(target):  # noqa: PTH112 - Path.is_dir raises where a folder may not be entered
            return NO_SUCH_FOLDER
        if os.path.realpath(target) != target:
            return FileRefusal("this folder is reached through a symbolic link", "name the folder itself")
        return FolderFiles(Path(target))


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link that leads round in a circle
        return False


def _list_folder(folder: Path) -> tuple[list[str], list[str], set[str]]:
    """Return the names of the folders, of the files, and of those that are links; none of a folder that cannot be read."""
    folders: list[str] = []
    file_names: list[str] = []
    links: set[str] = set()
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                (folders if _is_folder(entry) else file_names).append(entry.name)
                if entry.is_symlink():
                    links.add(entry.name)
    except OSError:
        return [], [], set()
    return folders, file_names, links


def _read_regular_file(path: Path, flags: int) -> bytes | FileRefusal:
    with open_named_file(path, flags) as stream:
        data = stream.read(MAX_BYTES + 1)
        return data if len(data) <= MAX_BYTES else TOO_LARGE


def _describe_read_error(path: Path, error: OSError) -> str:
    try:
        mode = path.lstat().st_mode
    except OSError:
        return f"the file cannot be read: {_format_os_error(error)}"
    if stat.S_ISLNK(mode) and not path.exists():
        return "this is a broken link: what it points to does not exist"
    if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode)):
        return describe_file_kind(mode)
    return f"the file cannot be read: {_format_os_error(error)}"


def _format_os_error(error: OSError) -> str:
    return (error.strerror or "unknown reason").lower()
