"""The commit that a project's files are at, read from git's objects only: no filter, hook or pager is ever run."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from archgen.git.git_call import run_git
from archgen.regular_files import open_named_file


def find_revision(root: Path, files: Iterable[str]) -> str:
    """Return the short hash of the last commit that touched these files, with a `+` if one of them differs from HEAD.

    Files are relative to `root`. Empty outside a git repository, without git, or if none of them was committed yet.
    """
    file_names = sorted(files)
    if not file_names:
        return ""
    commit = _run_git(root, "log", "-1", "--no-show-signature", "--format=%h", "HEAD", "--", *file_names)
    if not commit:
        return ""
    return commit.strip() + ("+" if differs_from_head(root, file_names) else "")


def find_revision_date(root: Path, files: Iterable[str]) -> str:
    """Return the day of the last commit that touched these files, as YYYY-MM-DD in its committer's time zone.

    Files are relative to `root`. Empty where `find_revision` is, and where a file differs from HEAD: what is not committed
    has no date.
    """
    file_names = sorted(files)
    if not file_names:
        return ""
    date = _run_git(root, "log", "-1", "--no-show-signature", "--format=%cs", "HEAD", "--", *file_names)
    return date.strip() if date and not differs_from_head(root, file_names) else ""


def find_commit_day(folder: Path, commit: str = "HEAD") -> str | None:
    """Return the day of a commit of the repository around a folder, as YYYY-MM-DD in its committer's time zone.

    None without git, outside of a repository, before the first commit, and of what is no commit.
    """
    while not folder.is_dir() and folder != folder.parent:  # a folder that a commit holds, and the disk does not
        folder = folder.parent
    day = _run_git(folder, "log", "-1", "--no-show-signature", "--format=%cs", "--end-of-options", commit, "--")
    return (day or "").strip() or None


def differs_from_head(root: Path, file_names: Iterable[str]) -> bool:
    """Whether some file differs from HEAD's blob; differences that git's conversion of line ends makes do not count.

    Files are relative to `root`.
    """
    # `git status` or `git diff` would run the filters that a repository configures: hashes are compared instead.
    listing = _run_git(root, "ls-tree", "-r", "-z", "HEAD", "--", *file_names)
    head_blobs = {
        name: blob_fields.split()[2]
        for blob_fields, _, name in (row.partition("\t") for row in (listing or "").split("\0"))
        if name
    }
    return any(not _matches_blob(root / name, head_blobs.get(name)) for name in file_names)


def _matches_blob(file: Path, blob: str | None) -> bool:
    """Whether a file has the content of a blob, given by its hash; a file that is not in HEAD has none."""
    if blob is None:
        return False
    try:
        with open_named_file(file) as stream:
            data = stream.read()
    except OSError:
        data = b""
    # A repository with the SHA-256 object format has hashes of 64 digits.
    algorithm = "sha1" if len(blob) == 40 else "sha256"  # noqa: PLR2004 - the length of a SHA-1 in hex
    return blob in {_blob_hash(data, algorithm), _blob_hash(data.replace(b"\r\n", b"\n"), algorithm)}


def _blob_hash(data: bytes, algorithm: str) -> str:
    return hashlib.new(algorithm, b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()


def _run_git(root: Path, *arguments: str) -> str | None:
    """Return the output of a git command, None if it fails."""
    result = run_git(root, *arguments)
    return None if result.status else result.output.decode("utf-8", "replace")
