"""Read a project's files from a folder on disk."""

from __future__ import annotations

import errno
import os
import posixpath
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from archgen.frozen import dataclass
from archgen.syntax.project_files import (
    MAX_BYTES,
    NO_SUCH_FOLDER,
    TOO_LARGE,
    FileRefusal,
    find_path_refusal,
    find_place_refusal,
)

_FILE_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
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


def read_named_file(path: Path, max_bytes: int = MAX_BYTES) -> bytes:
    """Return the bytes of a file that a user names on the command line, wherever it lies.

    Raise OSError for what is no regular file (a device or pipe would never end) and for what is too large.
    """
    data = _read_regular_file(path, max_bytes)
    if isinstance(data, FileRefusal):
        message = data.message if data is not TOO_LARGE else f"it has more than {max_bytes:,} bytes"
        raise OSError(errno.EINVAL, message, str(path))
    return data


@contextmanager
def open_named_file(path: Path) -> Iterator[BinaryIO]:
    """Open a file that a user names on the command line, to be read in parts.

    Raise OSError for what is no regular file.
    """
    with _open_without_waiting(path) as stream:
        mode = os.fstat(stream.fileno()).st_mode
        if not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, _describe_file_kind(mode), str(path))
        yield stream


def _open_without_waiting(path: Path, flags: int = 0) -> BinaryIO:
    # Opened first, then examined by its descriptor: a path checked before it is opened could be swapped in between.
    # O_NONBLOCK keeps the call from waiting for a pipe's writer; O_BINARY exists on Windows only.
    descriptor = os.open(path, flags | os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    return os.fdopen(descriptor, "rb")


def _read_regular_file(path: Path, max_bytes: int = MAX_BYTES, flags: int = 0) -> bytes | FileRefusal:
    with _open_without_waiting(path, flags) as stream:
        mode = os.fstat(stream.fileno()).st_mode
        if not stat.S_ISREG(mode):
            return FileRefusal(_describe_file_kind(mode))
        # One byte more than allowed tells "too large" without trusting st_size, which may grow while it is read.
        data = stream.read(max_bytes + 1)
        return data if len(data) <= max_bytes else TOO_LARGE


def _describe_file_kind(mode: int) -> str:
    kind = next((name for test, name in _FILE_KINDS if test(mode)), "no regular file")
    return f"this is {kind}, not a file"


def _describe_read_error(path: Path, error: OSError) -> str:
    try:
        mode = path.lstat().st_mode
    except OSError:
        return f"the file cannot be read: {_format_os_error(error)}"
    if stat.S_ISLNK(mode) and not path.exists():
        return "this is a broken link: what it points to does not exist"
    if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode)):
        return _describe_file_kind(mode)
    return f"the file cannot be read: {_format_os_error(error)}"


def _format_os_error(error: OSError) -> str:
    return (error.strerror or "unknown reason").lower()
