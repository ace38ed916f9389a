"""Which commit a project's files stand at, read from git's objects alone: no filter, hook or pager is ever run."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from archgen.git.call import call


def revision(root: Path, files: Iterable[str]) -> str:
    """Name the last commit that touched these files (relative to `root`), with `+` if one of them differs from it.

    Empty outside of a git repository, without git, or where nothing was committed yet.
    """
    names = sorted(files)
    if not names:
        return ""
    commit = _git(root, "log", "-1", "--no-show-signature", "--format=%h", "HEAD", "--", *names)
    if not commit:
        return ""
    return commit.strip() + ("+" if _changed(root, names) else "")


def _changed(root: Path, names: list[str]) -> bool:
    """Compare the files with HEAD's blobs by hash; line ends that git converts count as equal."""
    listing = _git(root, "ls-tree", "-r", "-z", "HEAD", "--", *names)
    held = {
        name: words.split()[2]
        for words, _, name in (row.partition("\t") for row in (listing or "").split("\0"))
        if name
    }
    return any(not _same(root / name, held.get(name)) for name in names)


def _same(file: Path, blob: str | None) -> bool:
    if blob is None:
        return False
    data = file.read_bytes() if file.is_file() else b""
    algorithm = "sha1" if len(blob) == 40 else "sha256"  # noqa: PLR2004 - the length of a SHA-1 in hex
    return blob in {_blob(data, algorithm), _blob(data.replace(b"\r\n", b"\n"), algorithm)}


def _blob(data: bytes, algorithm: str) -> str:
    return hashlib.new(algorithm, b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()


def _git(root: Path, *arguments: str) -> str | None:
    done = call(root, *arguments)
    return None if done.status else done.out.decode("utf-8", "replace")
