"""Files that may be something else by now, such as a pipe that never ends: opened without waiting, and examined when open."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

_FILE_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


class NoRegularFileError(OSError):
    """What is to be read is a folder, a pipe or the like: `strerror` says which."""


def read_named_file(path: Path, max_bytes: int) -> bytes:
    """Return the bytes of a file that a user names on the command line, wherever it lies.

    Raise NoRegularFileError (a device or pipe would never end), and OSError, also for what is too large.
    """
    with open_named_file(path) as stream:
        # One byte more than allowed tells "too large" without trusting st_size, which may grow while it is read.
        data = stream.read(max_bytes + 1)
    if len(data) > max_bytes:
        raise OSError(errno.EINVAL, f"it has more than {max_bytes:,} bytes", str(path))
    return data


def holds_bytes(path: Path, data: bytes) -> bool:
    """Return whether a regular file holds just these bytes."""
    try:
        with open_named_file(path) as stream:
            return stream.read(len(data) + 1) == data
    except OSError:
        return False


@contextmanager
def open_named_file(path: Path, flags: int = 0) -> Iterator[BinaryIO]:
    """Open a file to be read in parts; `flags` are further ones of `os.open`. Raise NoRegularFileError, and OSError."""
    # Opened first, then examined by its descriptor: a path checked before it is opened could be swapped in between.
    # O_NONBLOCK keeps the call from waiting for a pipe's writer; O_BINARY exists on Windows only.
    descriptor = os.open(path, flags | os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    mode = os.fstat(descriptor).st_mode
    if not stat.S_ISREG(mode):
        os.close(descriptor)
        raise NoRegularFileError(errno.EINVAL, describe_file_kind(mode), str(path))
    with os.fdopen(descriptor, "rb") as stream:
        yield stream


def describe_file_kind(mode: int) -> str:
    """Say what something on disk is that is no file: `this is a folder, not a file`."""
    kind = next((name for test, name in _FILE_KINDS if test(mode)), "no regular file")
    return f"this is {kind}, not a file"
