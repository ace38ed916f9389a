"""Read trees and blobs. Two `git cat-file` processes serve any number of blobs: one returns sizes, one contents."""

from __future__ import annotations

import os
import select
import weakref
from typing import IO, TYPE_CHECKING

from archgen.frozen import NamedTuple
from archgen.git.git_call import (
    ANSWER_SECONDS,
    SAFE_COMMAND,
    GitError,
    GitOutputError,
    git_environment,
    read_git_output,
    run_git,
)
from archgen.git.repository_lookup import GitRepository

if TYPE_CHECKING:
    import subprocess

LINK_MODE = "120000"
SUBMODULE_MODE = "160000"
MAX_LIST_BYTES = 32_000_000
"""The longest list of a commit's files that is read: about 300,000 files."""
_SMALL_BYTES = 65_536
_MAX_CACHED = 4096
"""The most small files that are cached: most are the same in most commits."""


class TreeEntry(NamedTuple):
    """An entry of a tree: a file, a symbolic link (`mode` is LINK_MODE) or a submodule's commit (SUBMODULE_MODE)."""

    mode: str
    object_id: str


class GitObjects:
    """The objects of one repository."""

    def __init__(self, repository: GitRepository) -> None:
        """Start no process yet."""
        self.repository = repository
        self._sizes = _BatchProcess(repository, "--batch-check")
        self._contents = _BatchProcess(repository, "--batch")
        self._cached_blobs: dict[str, bytes] = {}

    def list_tree(self, commit: str, prefix: str = "") -> dict[str, TreeEntry] | None:
        """Return everything below a folder of a commit, by path; None where there is no such folder.

        Raise GitError where there is more than any project has.
        """
        try:
            output = read_git_output(
                self.repository.top,
                *("ls-tree", "-r", "-z", "--full-tree", f"{commit}:{prefix}"),
                max_bytes=MAX_LIST_BYTES,
            )
        except GitOutputError:
            place = f"below `{prefix}` " if prefix else ""
            msg = f"the commit {commit[:10]} holds more files {place}than a project may have: their list is longer than"
            raise GitError(f"{msg} {MAX_LIST_BYTES // 1_000_000} MB") from None
        if output is None:
            if self._has_folder(commit, prefix):
                msg = f"the commit {commit[:10]} cannot be read: the repository is damaged (`git fsck` says where)"
                raise GitError(msg)
            return None
        text = output.decode("utf-8", "surrogateescape")
        rows = (row.partition("\t") for row in text.split("\0") if row)
        return {path: TreeEntry(fields[:6], fields.rpartition(" ")[2]) for fields, _, path in rows}

    def _has_folder(self, commit: str, prefix: str) -> bool:
        """Return whether a commit has a folder, or cannot say so because the folders above it are damaged."""
        result = run_git(
            self.repository.top, "ls-tree", "-d", "-z", "--full-tree", commit, "--", *filter(None, [prefix])
        )
        return bool(result.status or result.output or not prefix)

    def blob_size(self, blob_id: str) -> int | None:
        """Return a blob's size in bytes, None where this clone does not have it."""
        if blob_id in self._cached_blobs:
            return len(self._cached_blobs[blob_id])
        fields = self._sizes.query_object(blob_id)
        return int(fields[2]) if fields else None

    def read_blob(self, blob_id: str) -> bytes | None:
        """Return a blob's content, None where this clone does not have it. Ask for its size first."""
        cached = self._cached_blobs.get(blob_id)
        if cached is not None:
            return cached
        fields = self._contents.query_object(blob_id)
        if not fields:
            return None
        data = self._contents.read_content(int(fields[2]))
        if len(data) <= _SMALL_BYTES and len(self._cached_blobs) < _MAX_CACHED:
            self._cached_blobs[blob_id] = data
        return data


class _BatchProcess:
    """A `git cat-file` process that answers one question after the other. It ends with its owner."""

    def __init__(self, repository: GitRepository, mode: str) -> None:
        self._repository = repository
        self._mode = mode
        self._process: subprocess.Popen[bytes] | None = None

    def query_object(self, blob: str) -> list[str] | None:
        """Return the three words of the answer's first line, None where there is no such blob."""
        source, sink = self._get_pipes()
        try:
            sink.write(blob.encode() + b"\n")
            sink.flush()
            self._await_answer(source)
            fields = source.readline().decode().split()
        except OSError:
            fields = []
        if not fields:  # git gave up: a blob that a partial clone would have to fetch
            self._process = None
        if fields[1:2] == ["tree"] and self._process:
            # Its content would be taken for the answer to the next question.
            self._process.kill()
            self._process = None
        return fields if len(fields) == 3 and fields[1] == "blob" else None  # noqa: PLR2004 - id, kind, size

    def read_content(self, size: int) -> bytes:
        """Read a content of `size` bytes and the line end behind it."""
        source, _ = self._get_pipes()
        return source.read(size + 1)[:size]

    def _await_answer(self, source: IO[bytes]) -> None:
        """Wait until git begins to answer. Raise GitError where it does not: an object may be a pipe, or on a dead disk.

        Windows cannot wait for a pipe with a limit of time.
        """
        if not hasattr(select, "poll"):
            return
        waiting = select.poll()  # `select.select` takes no descriptor above 1,023
        waiting.register(source, select.POLLIN)
        if not waiting.poll(ANSWER_SECONDS * 1000):
            if self._process:
                self._process.kill()
            msg = f"git does not answer: an object of the repository could not be read within {ANSWER_SECONDS} s"
            raise GitError(msg)

    def _get_pipes(self) -> tuple[IO[bytes], IO[bytes]]:
        process = self._process or self._start()
        if process.stdout is None or process.stdin is None:  # pragma: no cover - they are asked for below
            raise AssertionError
        return process.stdout, process.stdin

    def _start(self) -> subprocess.Popen[bytes]:
        import subprocess

        process = self._process = subprocess.Popen(  # noqa: S603 - a fixed program, questions are hashes
            [*SAFE_COMMAND, "cat-file", self._mode],
            cwd=self._repository.top,
            env=git_environment(os.environ),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        # Ends the process together with this object, at the latest with the interpreter.
        weakref.finalize(self, _end_process, process)
        return process


def _end_process(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.communicate()
