"""Read a project's files from a folder on disk."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from archgen.syntax.files import MAX_BYTES, TOO_LARGE, Refusal

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


@dataclass(frozen=True, slots=True)
class Folder:
    """The files below a folder on disk. Implements `ProjectFiles`."""

    root: Path
    commit: str = ""

    def exists(self, path: str) -> bool:
        """Whether there is anything at a path, even a broken link."""
        return os.path.lexists(self.root / path)

    def walk(self, top: str) -> Iterator[tuple[str, list[str], list[str]]]:
        """Walk as `os.walk` does, with folders relative to `top`; links to folders are not entered."""
        start = self.root / top
        for folder, folders, names in os.walk(start):
            below = os.path.relpath(folder, start).replace(os.sep, "/")
            yield "" if below == "." else below, folders, names

    def fetch(self, path: str) -> bytes | Refusal:
        """Return a regular file's bytes, or why it cannot be used.

        It never waits for the other end of a pipe and never follows a link out of the folder.
        """
        full = self.root / path
        if not Path(os.path.realpath(full)).is_relative_to(os.path.realpath(self.root)):
            return Refusal("this link leads out of the project's folder", "copy the file into the project")
        try:
            return _bytes(full)
        except OSError as error:
            return Refusal(_reason(full, error))


def _bytes(path: Path) -> bytes | Refusal:
    # Opened first, then examined by its descriptor: a path checked before it is opened could be swapped in between.
    # O_NONBLOCK keeps the call from waiting for a pipe's writer; O_BINARY exists on Windows only.
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        mode = os.fstat(handle).st_mode
        if not stat.S_ISREG(mode):
            return Refusal(_not_a_file(mode))
        # One byte more than allowed tells "too large" without trusting st_size, which may grow while it is read.
        data = stream.read(MAX_BYTES + 1)
        return data if len(data) <= MAX_BYTES else TOO_LARGE


def _not_a_file(mode: int) -> str:
    kind = next((name for test, name in _KINDS if test(mode)), "no regular file")
    return f"this is {kind}, not a file"


def _reason(path: Path, error: OSError) -> str:
    try:
        mode = path.lstat().st_mode
    except OSError:
        return f"the file cannot be read: {_words(error)}"
    if stat.S_ISLNK(mode) and not path.exists():
        return "this is a broken link: what it points to does not exist"
    if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode)):
        return _not_a_file(mode)
    return f"the file cannot be read: {_words(error)}"


def _words(error: OSError) -> str:
    return (error.strerror or "unknown reason").lower()
