"""Find where a branch left its main line: what a diff compares with by default."""

from __future__ import annotations

from archgen.frozen import NamedTuple
from archgen.git.git_call import GitError, ShallowError, run_git
from archgen.git.repository_lookup import UNSHALLOW_HINT, GitRepository, look_up_commit, resolve_revision

_MAIN_LINES = ("main", "master", "origin/main", "origin/master")
"""Tried in this order, after the branch that the remote names."""


class BaseCommit(NamedTuple):
    """A commit and a description of it for people."""

    commit_id: str
    description: str


def find_branch_base(repository: GitRepository, setting: str | None = None) -> BaseCommit:
    """Return the commit at which HEAD left the main line; HEAD itself on the main line, or where there is no other
    line.

    `setting` is the main line that the project names. Raises `NoCommitsError`, `UnknownRevisionError` where there is no
    such branch, `ShallowError` where the clone does not reach back that far, `GitError` for unrelated lines.
    """
    head_commit = resolve_revision(repository, "HEAD")
    main_line = _find_main_line(repository, setting)
    branch = run_git(repository.top, "symbolic-ref", "--quiet", "--short", "HEAD").text.strip()
    # On the main line itself the work tree is compared with the last commit.
    if branch and main_line in {branch, f"origin/{branch}"}:
        return BaseCommit(head_commit, "HEAD")
    if not main_line and repository.is_shallow:
        raise ShallowError(f"this shallow clone holds no main line to compare with: {UNSHALLOW_HINT}")
    commit = find_common_commit(repository, main_line, "HEAD").commit_id if main_line else head_commit
    return BaseCommit(commit, "HEAD" if commit == head_commit else f"where this branch left {main_line}")


def find_unpushed_base(repository: GitRepository) -> BaseCommit | None:
    """Return the commit at which HEAD left the main line of the remote `origin`; None where this clone knows of none.

    Raise what `find_common_commit` raises.
    """
    remote_lines = [name for name in _list_main_lines(repository) if name.startswith("origin/")]
    main_line = next((name for name in remote_lines if look_up_commit(repository, name)), None)
    return find_common_commit(repository, main_line, "HEAD") if main_line else None


def find_common_commit(repository: GitRepository, left: str, right: str) -> BaseCommit:
    """Return the newest commit that two revisions have in common. Raise ShallowError or GitError."""
    commits = list_common_commits(repository, left, right)
    if commits:
        return BaseCommit(commits[0], f"where {right} left {left}")
    if repository.is_shallow:
        msg = f"the commit at which `{right}` left `{left}` is not in this shallow clone: {UNSHALLOW_HINT}"
        raise ShallowError(msg)
    raise GitError(f"`{left}` and `{right}` have no commit in common: name the revision to compare with")


def list_common_commits(repository: GitRepository, left: str, right: str) -> list[str]:
    """Return the newest commits that two revisions have in common: several where lines were merged crosswise."""
    revisions = (resolve_revision(repository, name) for name in (left, right))
    return run_git(repository.top, "merge-base", "--all", "--end-of-options", *revisions).text.split()


def _find_main_line(repository: GitRepository, setting: str | None) -> str:
    """Return the name of the main line, empty where none is known."""
    if setting:
        setting_name = next((name for name in (setting, f"origin/{setting}") if look_up_commit(repository, name)), "")
        return setting_name if setting_name or repository.is_shallow else resolve_revision(repository, setting)
    return next((name for name in _list_main_lines(repository) if look_up_commit(repository, name)), "")


def _list_main_lines(repository: GitRepository) -> tuple[str, ...]:
    """Return the names that the main line may have, the likeliest first."""
    remote_default = run_git(
        repository.top, "symbolic-ref", "--quiet", "--short", "refs/remotes/origin/HEAD"
    ).text.strip()
    return (remote_default, *_MAIN_LINES) if remote_default else _MAIN_LINES
