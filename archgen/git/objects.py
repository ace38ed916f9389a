"""Read trees and blobs. Two processes of `git cat-file` serve any number of blobs: one tells sizes, one gives contents."""

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
"""Small files are held, so many of them: most are the same in most commits."""


class Blob(NamedTuple):
    """What a tree holds at a path: a file, a symbolic link (`mode` is LINK) or a submodule's commit (SUBMODULE)."""

    mode: str
    id: str


class Objects:
    """The objects of one repository."""

    def __init__(self, repository: Repository) -> None:
        """Start nothing yet."""
        self.repository = repository
        self._sizes = _Batch(repository, "--batch-check")
        self._contents = _Batch(repository, "--batch")
        self._held: dict[str, bytes] = {}

    def tree(self, commit: str, prefix: str = "") -> dict[str, Blob] | None:
        """Give all that lies below a folder of a commit, by path; None where there is no such folder."""
        done = call(self.repository.top, "ls-tree", "-r", "-z", "--full-tree", f"{commit}:{prefix}")
        if done.status:
            return None
        rows = (row.partition("\t") for row in done.text.split("\0") if row)
        return {path: Blob(words[:6], words.rpartition(" ")[2]) for words, _, path in rows}

    def size(self, blob: str) -> int | None:
        """Give a blob's size, None where this clone does not have it."""
        if blob in self._held:
            return len(self._held[blob])
        words = self._sizes.ask(blob)
        return int(words[2]) if words else None

    def content(self, blob: str) -> bytes | None:
        """Give a blob's content, None where this clone does not have it. Ask for its size first."""
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
    """A process of `git cat-file` that answers one question after the other. It ends with its owner."""

    def __init__(self, repository: Repository, mode: str) -> None:
        self._repository = repository
        self._mode = mode
        self._process: subprocess.Popen[bytes] | None = None

    def ask(self, blob: str) -> list[str] | None:
        """Give the three words of the answer's first line, None where there is no such object."""
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
        weakref.finalize(self, _end, process)
        return process


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.communicate()
