"""Merge commits without a checkout, and without a trace in the repository: new objects go into a folder of their own.

git merges in a bare repository that borrows the objects of the real one and has none of its settings, so that neither
attributes nor a configured merge driver run a program.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from archgen.frozen import dataclass
from archgen.git.git_call import GitError, GitResult, run_git
from archgen.git.object_reader import GitObjects
from archgen.git.repository_lookup import GitRepository, list_cut_commits

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
