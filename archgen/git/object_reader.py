"""Read trees and blobs. Two `git cat-file` processes serve any number of blobs: one returns sizes, one contents.

Commits are merged without a checkout, in a bare repository that borrows the objects of the real one and has none of its
settings, so that neither attributes nor a configured merge driver run a program.
"""

from __future__ import annotations

import os
import select
import tempfile
import weakref
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING

from archgen.frozen import NamedTuple, dataclass
from archgen.git.git_call import (
    ANSWER_SECONDS,
    SAFE_COMMAND,
    GitError,
    GitOutputError,
    GitResult,
    git_environment,
    read_git_output,
    run_git,
)
from archgen.git.repository_lookup import GitRepository, list_cut_commits

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


_OLDEST_GIT = "2.38"
"""The first version whose `merge-tree` writes trees."""
_STAGES = {"1": 0, "2": 1, "3": 2}
"""The versions of a file in conflict, as git numbers them: base, ours, theirs."""


@dataclass(frozen=True, slots=True)
class PathConflict:
    """A path that git does not merge: the blobs of its base, ours and theirs, empty for a version that lacks it."""

    path: str
    mode: str
    blobs: tuple[str, str, str]


@dataclass(frozen=True, slots=True)
class TreeMerge:
    """The tree that git makes of two commits; files in conflict hold markers in it."""

    tree: str
    conflicts: tuple[PathConflict, ...]


class MergeFolder:
    """A bare repository in a temporary folder, in which commits of another one are merged."""

    def __init__(self, folder: Path, source: GitRepository) -> None:
        self.objects = GitObjects(GitRepository(folder, source.prefix, is_bare=True))
        self._folder = folder

    def merge_commits(self, ours: str, theirs: str) -> TreeMerge:
        """Merge two commits, given by their hashes. Raise GitError where git cannot."""
        result = self._run("merge-tree", "--write-tree", "-z", "--no-messages", ours, theirs)
        if result.status not in {0, 1}:
            raise GitError(_explain_failure(result.error_text))
        tree, *entries = result.text.split("\0")
        return TreeMerge(tree, tuple(_read_conflicts(entries)))

    def replace_files(self, tree: str, contents: Mapping[str, tuple[str, bytes | None]]) -> str:
        """Return a tree with the modes and contents of some files replaced, by path; None takes a file away."""
        if not contents:
            return tree
        self._run_safely("read-tree", tree)
        no_blob = "0" * len(self._run_safely("rev-parse", tree))
        for path, (mode, content) in contents.items():
            blob = "" if content is None else self._run_safely("hash-object", "-w", "--stdin", stdin=content)
            fields = f"{mode} {blob}" if blob else f"0 {no_blob}"
            # The path last and by NUL, since it may hold anything.
            entry = f"{fields}\t{path}\0".encode("utf-8", "surrogateescape")
            self._run_safely("update-index", "-z", "--index-info", stdin=entry)
        return self._run_safely("write-tree")

    def commit_tree(self, tree: str, parents: tuple[str, ...]) -> str:
        """Return a commit of a tree, so that more can be merged into it."""
        person = ("-c", "user.name=archgen", "-c", "user.email=archgen@localhost")
        words = [word for parent in parents for word in ("-p", parent)]
        return self._run_safely(*person, "commit-tree", tree, *words, "-m", "merged")

    def pack_commit(self, commit: str, known_commits: Sequence[str]) -> bytes:
        """Return a pack of what a commit has and others have not, for the repository that lent its objects."""
        revisions = "\n".join((commit, *(f"^{each}" for each in known_commits)))
        return self._run_checked("pack-objects", "--revs", "--stdout", "-q", stdin=f"{revisions}\n".encode()).output

    def _run(self, *words: str, stdin: bytes = b"") -> GitResult:
        return run_git(self._folder, "--git-dir=.", *words, stdin=stdin)

    def _run_safely(self, *words: str, stdin: bytes = b"") -> str:
        return self._run_checked(*words, stdin=stdin).text.strip()

    def _run_checked(self, *words: str, stdin: bytes = b"") -> GitResult:
        result = self._run(*words, stdin=stdin)
        if result.status:
            raise GitError(f"git cannot merge here: {result.error_text}")
        return result


def _explain_failure(error_text: str) -> str:
    if "usage: git merge-tree" in error_text:
        return f"git {_OLDEST_GIT} or newer is needed to merge without a checkout"
    # Hints about settings may stand above it.
    reasons = (line.removeprefix("fatal: ") for line in error_text.splitlines() if not line.startswith("hint:"))
    return f"git cannot merge these commits: {next(reasons, 'it gave no reason')}"


def _read_conflicts(entries: list[str]) -> Iterator[PathConflict]:
    """Yield the files in conflict from the entries of `git merge-tree -z`: `MODE OBJECT STAGE<tab>PATH`."""
    blobs: dict[str, list[str]] = {}
    modes: dict[str, str] = {}
    for entry in entries:
        fields, _, path = entry.partition("\t")
        if not path:
            continue
        mode, blob, stage = fields.split(" ")
        blobs.setdefault(path, ["", "", ""])[_STAGES[stage]] = blob
        modes[path] = mode
    for path, versions in blobs.items():
        yield PathConflict(path, modes[path], (versions[0], versions[1], versions[2]))


@contextmanager
def open_merge_folder(repository: GitRepository) -> Iterator[MergeFolder]:
    """Make a repository that borrows all objects of another one; it is gone afterwards. Raise GitError."""
    paths = run_git(repository.top, "rev-parse", "--git-path", "objects", "--show-object-format")
    if paths.status:
        raise GitError(f"the repository cannot be read: {paths.error_text}")
    objects, object_format = paths.text.splitlines()
    with tempfile.TemporaryDirectory(prefix="archgen-") as name:
        # Called as the real one: a project without an id takes the folder's name.
        folder = Path(name) / repository.top.name
        for part in ("objects/info", "refs"):
            (folder / part).mkdir(parents=True)
        alternates = os.fsencode((repository.top / objects).resolve())
        (folder / "objects/info/alternates").write_bytes(alternates + b"\n")
        (folder / "HEAD").write_text("ref: refs/heads/merged\n", "ascii")
        extension = f"[extensions]\n\tobjectFormat = {object_format}\n" if object_format != "sha1" else ""
        version = 1 if extension else 0
        (folder / "config").write_text(
            f"[core]\n\trepositoryFormatVersion = {version}\n\tbare = true\n{extension}", "ascii"
        )
        # Where a shallow clone ends, git looks for no parents.
        cut_commits = list_cut_commits(repository)
        if cut_commits:
            (folder / "shallow").write_text("".join(f"{commit}\n" for commit in cut_commits), "ascii")
        yield MergeFolder(folder, repository)


_MAX_CONFLICTS = 127
"""`git merge-file` ends with the number of conflicts, at most this, and with more where it fails."""


@dataclass(frozen=True, slots=True)
class LineMerge:
    """Merged lines, with git's markers round each conflict."""

    content: bytes
    conflict_count: int


def merge_lines(
    base: bytes, ours: bytes, theirs: bytes, *, marker_size: int = 7, shows_base: bool = False
) -> LineMerge:
    """Merge what changed between `base` and `theirs` into `ours`. Raise GitError for what git takes for binary.

    With `shows_base` each conflict also shows what stood there before.
    """
    labels = ("-L", "ours", "-L", "base", "-L", "theirs")
    style = ("--diff3",) if shows_base else ()
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder_name:
        folder = Path(folder_name)
        for name, content in (("ours", ours), ("base", base), ("theirs", theirs)):
            (folder / name).write_bytes(content)
        result = run_git(
            folder, "merge-file", "-p", *style, f"--marker-size={marker_size}", *labels, "ours", "base", "theirs"
        )
    if result.status > _MAX_CONFLICTS or result.status < 0:
        raise GitError(f"git cannot merge these texts: {result.error_text}")
    return LineMerge(result.output, result.status)
