"""Read trees and blobs. Two `git cat-file` processes serve any number of blobs: one returns sizes, one contents."""

from __future__ import annotations

import os
import weakref
from typing import IO, TYPE_CHECKING, NamedTuple

from archgen.git.call import SAFE, call, environment
from archgen.git.repository import Repository

if TYPE_CHECKING:
    import subprocess

LINK = "120000"
SUBMODULE = "160000"
_SMALL = 65_536
_MOST_HELD = 4096
"""The most small files that are cached: most are the same in most commits."""


class Blob(NamedTuple):
    """An entry of a tree: a file, a symbolic link (`mode` is LINK_MODE) or a submodule's commit (SUBMODULE_MODE)."""

    mode: str
    id: str


class Objects:
    """The objects of one repository."""

    def __init__(self, repository: Repository) -> None:
        """Start no process yet."""
        self.repository = repository
        self._sizes = _Batch(repository, "--batch-check")
        self._contents = _Batch(repository, "--batch")
        self._held: dict[str, bytes] = {}

    def tree(self, commit: str, prefix: str = "") -> dict[str, Blob] | None:
        """Return everything below a folder of a commit, by path; None where there is no such folder."""
        done = call(self.repository.top, "ls-tree", "-r", "-z", "--full-tree", f"{commit}:{prefix}")
        if done.status:
            return None
        rows = (row.partition("\t") for row in done.text.split("\0") if row)
        return {path: Blob(words[:6], words.rpartition(" ")[2]) for words, _, path in rows}

    def size(self, blob: str) -> int | None:
        """Return a blob's size in bytes, None where this clone does not have it."""
        if blob in self._held:
            return len(self._held[blob])
        words = self._sizes.ask(blob)
        return int(words[2]) if words else None

    def content(self, blob: str) -> bytes | None:
        """Return a blob's content, None where this clone does not have it. Ask for its size first."""
        held = self._held.get(blob)
        if held is not None:
            return held
        words = self._contents.ask(blob)
        if not words:
            return None
        data = self._contents.read(int(words[2]))
        if len(data) <= _SMALL and len(self._held) < _MOST_HELD:
            self._held[blob] = data
        return data


class _Batch:
    """A `git cat-file` process that answers one question after the other. It ends with its owner."""

    def __init__(self, repository: Repository, mode: str) -> None:
        self._repository = repository
        self._mode = mode
        self._process: subprocess.Popen[bytes] | None = None

    def ask(self, blob: str) -> list[str] | None:
        """Return the three words of the answer's first line, None where there is no such blob."""
        source, sink = self._pipes()
        try:
            sink.write(blob.encode() + b"\n")
            sink.flush()
            words = source.readline().decode().split()
        except OSError:
            words = []
        if not words:  # git gave up: a blob that a partial clone would have to fetch
            self._process = None
        return words if len(words) == 3 and words[1] == "blob" else None  # noqa: PLR2004 - id, kind, size

    def read(self, size: int) -> bytes:
        """Read a content of `size` bytes and the line end behind it."""
        source, _ = self._pipes()
        return source.read(size + 1)[:size]

    def _pipes(self) -> tuple[IO[bytes], IO[bytes]]:
        process = self._process or self._start()
        if process.stdout is None or process.stdin is None:  # pragma: no cover - they are asked for below
            raise AssertionError
        return process.stdout, process.stdin

    def _start(self) -> subprocess.Popen[bytes]:
        import subprocess

        process = self._process = subprocess.Popen(  # noqa: S603 - a fixed program, questions are hashes
            [*SAFE, "cat-file", self._mode],
            cwd=self._repository.top,
            env=environment(os.environ),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        # Ends the process together with this object, at the latest with the interpreter.
        weakref.finalize(self, _end, process)
        return process


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.communicate()
