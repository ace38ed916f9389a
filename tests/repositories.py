"""Real git repositories in temporary folders."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

_CACHE_FOLDER = os.environ["XDG_CACHE_HOME"]
"""The cache of this run, which its end removes; some tests have another."""


def git(folder: Path, *words: str, stdin: bytes | None = None, day: str | None = None) -> str:
    """Run git as a user who has no settings of his own, on a day (YYYY-MM-DD) if one is given."""
    person = {
        f"GIT_{who}_{what}": f"{what.lower()}@x.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    environment = {**os.environ, **person, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    if day is not None:
        environment |= {f"GIT_{who}_DATE": f"{day}T12:00:00+0000" for who in ("AUTHOR", "COMMITTER")}
    done = subprocess.run(  # noqa: S603 - a fixed program
        # Its own housekeeping would be two more processes for each commit.
        ["git", "-c", "maintenance.auto=false", "-c", "gc.auto=0", *words],  # noqa: S607 - the same that archgen calls
        cwd=folder,
        env=environment,
        input=stdin,
        capture_output=True,
        check=True,
    )
    return done.stdout.decode().strip()


def repository(
    folder: Path, files: Mapping[str, str | bytes] | None = None, *options: str, day: str | None = None
) -> Path:
    """Make a repository on branch `main`, with one commit if there are files."""
    folder.mkdir(parents=True, exist_ok=True)
    if options:
        git(folder, "init", "-q", "-b", "main", *options)
    elif not (folder / ".git").exists():  # git itself leaves one that is there as it is
        if files is not None and not any(folder.iterdir()) and _has_been_asked_for(key := (tuple(files.items()), day)):
            return shutil.copytree(_make_first_commit(*key), folder, symlinks=True, dirs_exist_ok=True)
        shutil.copytree(_make_empty_repository(), folder / ".git")
    if files is not None:
        commit(folder, files, day)
    return folder


@cache
def _make_empty_repository() -> Path:
    """Return what `git init` makes, but for its samples of hooks: it is copied hundreds of times."""
    folder = Path(tempfile.mkdtemp(dir=_CACHE_FOLDER))
    git(folder, "init", "-q", "-b", "main")
    for sample in (folder / ".git").glob("hooks/*.sample"):
        sample.unlink()
    return folder / ".git"


_Files = tuple[tuple[str, str | bytes], ...]
_ASKED_FOR = set[tuple[_Files, str | None]]()


def _has_been_asked_for(key: tuple[_Files, str | None]) -> bool:
    """Whether a test wanted the same repository before: it is copied then, which takes half of what two runs of git do."""
    was_asked_for = key in _ASKED_FOR
    _ASKED_FOR.add(key)
    return was_asked_for


@cache
def _make_first_commit(files: _Files, day: str | None) -> Path:
    folder = Path(tempfile.mkdtemp(dir=_CACHE_FOLDER))
    shutil.copytree(_make_empty_repository(), folder / ".git")
    commit(folder, dict(files), day)
    return folder


def commit(folder: Path, files: Mapping[str, str | bytes], day: str | None = None, *, author: str | None = None) -> str:
    """Write files, commit everything, and give the hash."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    git(folder, "add", "-A")
    options = () if author is None else (f"--author={author}",)
    git(folder, "commit", "-q", "--allow-empty", "-m", "x", *options, day=day)
    return _read_head(folder) or git(folder, "rev-parse", "HEAD")


def _read_head(folder: Path) -> str:
    """Return the hash of the last commit where it stands in the repository's own files, as it does after most commits."""
    head = folder / ".git" / "HEAD"
    reference = head.read_text("utf-8").removeprefix("ref: ").strip() if head.is_file() else ""
    branch = folder / ".git" / reference
    return branch.read_text("utf-8").strip() if reference.startswith("refs/") and branch.is_file() else ""


def trap(folder: Path) -> tuple[Path, Path]:
    """Make a program that leaves a mark when it is run; give the program and the mark."""
    mark, program = folder / "ran", folder / "trap.sh"
    program.write_text(f"#!/bin/sh\ntouch {mark}\ncat\n", encoding="utf-8")
    program.chmod(0o755)
    return program, mark
