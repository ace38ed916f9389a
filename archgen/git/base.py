"""Find where a branch left its main line: what a diff compares with by default."""

from __future__ import annotations

from typing import NamedTuple

from archgen.git.call import call
from archgen.git.errors import GitError, ShallowError
from archgen.git.repository import UNSHALLOW, Repository, look_up, resolve

_MAIN_LINES = ("main", "master", "origin/main", "origin/master")
"""Tried in this order, after the branch that the remote names."""


class Base(NamedTuple):
    """A commit and a description of it for people."""

    commit: str
    name: str


def base(found: Repository, setting: str | None = None) -> Base:
    """Return the commit at which HEAD left the main line; HEAD itself on the main line, or where there is no other
    line.

    `setting` is the main line that the project names. Raises `NoCommitsError`, `UnknownRevisionError` where there is no
    such branch, `ShallowError` where the clone does not reach back that far, `GitError` for unrelated lines.
    """
    head = resolve(found, "HEAD")
    main = _main_line(found, setting)
    branch = call(found.top, "symbolic-ref", "--quiet", "--short", "HEAD").text.strip()
    # On the main line itself the work tree is compared with the last commit.
    if branch and main in {branch, f"origin/{branch}"}:
        return Base(head, "HEAD")
    if not main and found.shallow:
        msg = f"this shallow clone holds no main line to compare with: {UNSHALLOW}"
        raise ShallowError(msg)
    commit = fork(found, main, "HEAD").commit if main else head
    return Base(commit, "HEAD" if commit == head else f"where this branch left {main}")


def fork(found: Repository, left: str, right: str) -> Base:
    """Return the newest commit that two revisions have in common. Raise ShallowError or GitError."""
    done = call(found.top, "merge-base", "--end-of-options", resolve(found, left), resolve(found, right))
    commit = done.text.split("\n")[0]
    if commit:
        return Base(commit, f"where {right} left {left}")
    if found.shallow:
        msg = f"the commit at which `{right}` left `{left}` is not in this shallow clone: {UNSHALLOW}"
        raise ShallowError(msg)
    msg = f"`{left}` and `{right}` have no commit in common: name the revision to compare with"
    raise GitError(msg)


def _main_line(found: Repository, setting: str | None) -> str:
    """Return the name of the main line, empty where none is known."""
    if setting:
        named = next((name for name in (setting, f"origin/{setting}") if look_up(found, name)), "")
        return named if named or found.shallow else resolve(found, setting)
    remote = call(found.top, "symbolic-ref", "--quiet", "--short", "refs/remotes/origin/HEAD").text.strip()
    names = (remote, *_MAIN_LINES) if remote else _MAIN_LINES
    return next((name for name in names if look_up(found, name)), "")
