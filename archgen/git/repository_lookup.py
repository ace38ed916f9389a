"""Find the repository around a path, and the commit that a revision names."""

from __future__ import annotations

import os
from pathlib import Path

from archgen.diagnostics import did_you_mean
from archgen.frozen import dataclass
from archgen.git.git_call import NoCommitsError, NoRepositoryError, ShallowError, UnknownRevisionError, run_git

UNSHALLOW_HINT = "fetch what is missing with `git fetch --unshallow` (in a workflow: `fetch-depth: 0`)"


@dataclass(frozen=True, slots=True)
class GitRepository:
    """A repository.

    `top` is the root of its work tree (a bare repository's own folder); `prefix` is the path from there to the
    requested folder, with `/`, empty for the root. A shallow one lacks the older commits.
    """

    top: Path
    prefix: str = ""
    is_bare: bool = False
    is_shallow: bool = False

    @property
    def folder(self) -> Path:
        """The requested folder; it need not exist on disk."""
        return self.top / self.prefix


def find_repository(path: Path) -> GitRepository:
    """Find the repository around a folder, which may be gone from the disk or exist in a bare repository only.

    Raises `NoRepositoryError`.
    """
    existing_folder = Path(os.path.realpath(path))
    # git is called in the nearest folder that exists; what is missing is added to the prefix below.
    while not existing_folder.is_dir() and existing_folder != existing_folder.parent:
        existing_folder = existing_folder.parent
    missing_path = os.path.relpath(os.path.realpath(path), existing_folder).replace(os.sep, "/").removeprefix(".")
    questions = ("--is-bare-repository", "--is-shallow-repository", "--is-inside-git-dir", "--show-prefix")
    result = run_git(existing_folder, "rev-parse", *questions)
    if result.status:
        raise NoRepositoryError(_explain_refusal(path, result.error_text))
    bare, shallow, in_git_folder, prefix = result.text.split("\n", 3)
    prefix = prefix.removesuffix("\n").removesuffix("/")
    top = existing_folder
    if bare == "true" or in_git_folder == "true":
        top = Path(run_git(existing_folder, "rev-parse", "--absolute-git-dir").text.removesuffix("\n"))
        missing_path = os.path.relpath(os.path.realpath(path), top).replace(os.sep, "/").removeprefix(".")
    else:
        for _ in filter(None, prefix.split("/")):
            top = top.parent
        # Below another top all paths would mean other files.
        if not os.path.lexists(top / ".git"):
            msg = f"the repository around {path} has its files elsewhere (`core.worktree`): archgen compares those beside `.git`"
            raise NoRepositoryError(msg)
    return GitRepository(top, "/".join(filter(None, (prefix, missing_path))), bare == "true", shallow == "true")


def _explain_refusal(path: Path, error_text: str) -> str:
    """Return a message for users from git's own."""
    first_line = error_text.removeprefix("fatal: ").split("\n")[0]
    if first_line.startswith("not a git repository"):
        return f"{path} is not in a git repository: run `git init` first"
    if first_line.startswith("detected dubious ownership"):
        return f"the repository around {path} belongs to somebody else: `git config --global --add safe.directory` allows it"
    return f"the repository around {path} cannot be read: {first_line}"


def list_cut_commits(repository: GitRepository) -> tuple[str, ...]:
    """Return the hashes of the commits at which a shallow clone is cut off, sorted; none in a whole one."""
    if not repository.is_shallow:
        return ()
    path = run_git(repository.top, "rev-parse", "--git-path", "shallow").text.removesuffix("\n")
    try:
        return tuple(sorted((repository.top / path).read_text("ascii", "replace").split()))
    except OSError:  # completed by another process since the flag was read
        return ()


def resolve_revision(repository: GitRepository, revision: str) -> str:
    """Return the full hash of the commit that a revision names (branch, tag, hash, `HEAD~3`, ...).

    Raises `NoCommitsError`, `ShallowError` or `UnknownRevisionError`.
    """
    commit = look_up_commit(repository, revision)
    if commit:
        return commit
    names = run_git(
        repository.top, "for-each-ref", "--format=%(refname:short)", "refs/heads", "refs/tags", "refs/remotes"
    )
    known_names = names.text.split()
    if not known_names and not look_up_commit(repository, "HEAD"):
        msg = "nothing was committed in this repository yet: commit once, then there is something to compare with"
        raise NoCommitsError(msg)
    if repository.is_shallow:
        raise ShallowError(f"there is no revision `{revision}` in this shallow clone: {UNSHALLOW_HINT}")
    suggestion = did_you_mean(revision, known_names) or "branches, tags and hashes are revisions"
    raise UnknownRevisionError(f"there is no revision `{revision}`: {suggestion}")


def look_up_commit(repository: GitRepository, revision: str) -> str:
    """Return the full hash of a commit, empty where there is none."""
    return _look_up_object(repository, revision, "commit")


def look_up_tree(repository: GitRepository, name: str) -> str:
    """Return the full hash of a tree that is named by itself or by a commit, empty where there is none."""
    return _look_up_object(repository, name, "tree")


def _look_up_object(repository: GitRepository, name: str, kind: str) -> str:
    if not name or "\0" in name:
        return ""
    # `--end-of-options`: a name that users type may begin with a hyphen.
    result = run_git(repository.top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{{kind}}}")
    return "" if result.status else result.text.strip()
