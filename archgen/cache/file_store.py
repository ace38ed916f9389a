"""The one way in which archgen caches: files named by a digest of all that decides them, so that none is ever out of date.

A file is written aside and moved into place, so that no reader sees half of it; the oldest beyond a number are removed.
A cache never fails a run: a disk that is full or read-only costs only the time that it would have saved, and whatever
cannot be read counts as missing.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from pathlib import Path

from archgen.frozen import NamedTuple


class FileStore(NamedTuple):
    """The cached files of one kind. `folder` None is the store that holds nothing; without `most_files` none is removed."""

    folder: Path | None
    suffix: str
    most_files: int | None = None

    def path_of(self, key: str) -> Path | None:
        """Return the path of a cached file, whether or not it exists; None without a folder."""
        return None if self.folder is None else self.folder / f"{key}{self.suffix}"

    def load(self, key: str) -> bytes | None:
        """Return a cached file, None where there is none."""
        path = self.path_of(key)
        try:
            return None if path is None else path.read_bytes()
        except OSError:
            return None

    def store(self, key: str, data: bytes) -> None:
        """Store a file, in place of one that may exist, and remove the oldest beyond the bound."""
        path = self.path_of(key)
        if path is None:
            return
        with contextlib.suppress(OSError):
            _replace_file(path, data, self.suffix)
            if self.most_files is not None:
                self.prune(self.most_files)

    def prune(self, most_files: int) -> None:
        """Remove the oldest files, all but so many."""
        if self.folder is None:
            return
        with contextlib.suppress(OSError):
            newest_first = sorted(
                self.folder.glob(f"*{self.suffix}"), key=lambda file: file.stat().st_mtime, reverse=True
            )
            for outdated_file in newest_first[most_files:]:
                outdated_file.unlink(missing_ok=True)


def _replace_file(path: Path, data: bytes, suffix: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, since a move across file systems is not atomic; another process may store the same file. One that a
    # killed run leaves is removed among the oldest, as it ends like all others.
    descriptor, name = tempfile.mkstemp(suffix=suffix, dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as part:
            part.write(data)
        os.replace(name, path)  # noqa: PTH105 - as atomic as the system can
    except BaseException:  # Ctrl-C is no Exception
        os.unlink(name)  # noqa: PTH108 - beside the call above
        raise


def digest_text(text: str) -> str:
    """Return the digest of a text, for the name of a file; it may hold lone surrogates, which UTF-8 cannot write."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def digest_bytes(data: bytes | None) -> str | None:
    """Return the digest of bytes, None for a file that is missing."""
    return None if data is None else hashlib.sha256(data).hexdigest()
