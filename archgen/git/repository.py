"""Find the repository around a path, and the commit that a revision names."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from archgen.git.call import call
from archgen.git.errors import NoCommitsError, NoRepositoryError, ShallowError, UnknownRevisionError
from archgen.suggest import did_you_mean

UNSHALLOW = "fetch what is missing with `git fetch --unshallow` (in a workflow: `fetch-depth: 0`)"


@dataclass(frozen=True, slots=True)
class Repository:
    """A repository.

    `top` is the root of its work tree (a bare repository's own folder); `prefix` is the path from there to the
    requested folder, with `/`, empty for the root. A shallow one lacks the older commits.
    """

    top: Path
    prefix: str = ""
    bare: bool = False
    shallow: bool = False

    @property
    def folder(self) -> Path:
        """The requested folder; it need not exist on disk."""
        return self.top / self.prefix


def repository(path: Path) -> Repository:
    """Find the repository around a folder, which may be gone from the disk or exist in a bare repository only.

    Raises `NoRepositoryError`.
    """
    here = Path(os.path.realpath(path))
    # git is called in the nearest folder that exists; what is missing is added to the prefix below.
    while not here.is_dir() and here != here.parent:
        here = here.parent
    rest = os.path.relpath(os.path.realpath(path), here).replace(os.sep, "/").removeprefix(".")
    asked = ("--is-bare-repository", "--is-shallow-repository", "--is-inside-git-dir", "--show-prefix")
    done = call(here, "rev-parse", *asked)
    if done.status:
        raise NoRepositoryError(_refused(path, done.said))
    bare, shallow, inside, prefix = done.text.split("\n", 3)
    prefix = prefix.removesuffix("\n").removesuffix("/")
    top = here
    if bare == "true" or inside == "true":
        top = _git_folder(here)
        rest = os.path.relpath(os.path.realpath(path), top).replace(os.sep, "/").removeprefix(".")
    else:
        for _ in filter(None, prefix.split("/")):
            top = top.parent
    return Repository(top, "/".join(filter(None, (prefix, rest))), bare == "true", shallow == "true")


def _git_folder(here: Path) -> Path:
    return Path(call(here, "rev-parse", "--absolute-git-dir").text.removesuffix("\n"))


def _refused(path: Path, said: str) -> str:
    """Return a message for users from git's own."""
    first = said.removeprefix("fatal: ").split("\n")[0]
    if first.startswith("not a git repository"):
        return f"{path} is not in a git repository: name two folders or files to compare, or run `git init` first"
    if first.startswith("detected dubious ownership"):
        return f"the repository around {path} belongs to somebody else: `git config --global --add safe.directory` allows it"
    return f"the repository around {path} cannot be read: {first}"


def resolve(found: Repository, revision: str) -> str:
    """Return the full hash of the commit that a revision names (branch, tag, hash, `HEAD~3`, ...).

    Raises `NoCommitsError`, `ShallowError` or `UnknownRevisionError`.
    """
    commit = look_up(found, revision)
    if commit:
        return commit
    names = call(found.top, "for-each-ref", "--format=%(refname:short)", "refs/heads", "refs/tags", "refs/remotes")
    known = names.text.split()
    if not known and not look_up(found, "HEAD"):
        msg = "nothing was committed in this repository yet: commit once, then there is something to compare with"
        raise NoCommitsError(msg)
    if found.shallow:
        msg = f"there is no revision `{revision}` in this shallow clone: {UNSHALLOW}"
        raise ShallowError(msg)
    guess = did_you_mean(revision, known) or "branches, tags and hashes are revisions"
    msg = f"there is no revision `{revision}`: {guess}"
    raise UnknownRevisionError(msg)


def look_up(found: Repository, revision: str) -> str:
    """Return the full hash of a commit, empty where there is none."""
    if not revision or "\0" in revision:
        return ""
    # `--end-of-options`: a revision that users type may begin with a hyphen.
    done = call(found.top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    return "" if done.status else done.text.strip()
