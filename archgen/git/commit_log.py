"""List the line of commits that led to one, and look up the ids of objects in them.

Who wrote the commits between two, by the e-mail addresses in them: anybody may write any address there.
"""

from __future__ import annotations

from collections.abc import Iterable

from archgen.git.git_call import run_git
from archgen.git.git_errors import GitError
from archgen.git.repository_lookup import GitRepository, resolve_revision


def list_author_mails(repository: GitRepository, base: str, head: str, path: str = "") -> frozenset[str]:
    """Return the addresses of the authors of what `head` has and `base` has not, of one path or of all."""
    # Without a mailmap: that is a file of the branch.
    return frozenset(filter(None, _log(repository, "--format=%ae", base, head, path).splitlines()))


def find_last_commit(repository: GitRepository, base: str, head: str, path: str) -> str:
    """Return the last commit that touched a path since `base`; empty if none did."""
    return _log(repository, "--format=%H", base, head, path, "-1").strip()


def find_own_mail(repository: GitRepository) -> str:
    """Return the address that a commit made here would have; empty if git has none."""
    return run_git(repository.top, "config", "user.email").text.strip()


def _log(repository: GitRepository, form: str, base: str, head: str, path: str, *options: str) -> str:
    words = ("--no-mailmap", "--no-show-signature", form, *options, "--end-of-options", head, f"^{base}", "--")
    # A path as it is called: `*` and `:` are signs to git.
    return run_git(repository.top, "--literal-pathspecs", "log", *words, *([path] if path else [])).text


def list_first_parents(repository: GitRepository, revision: str) -> tuple[tuple[str, str], ...]:
    """Return (hash, day by the committer's clock) of a commit and its first parents, oldest first.

    Raises what `resolve_revision` raises. The line of a shallow clone ends where the clone does.
    """
    commit = resolve_revision(repository, revision)
    result = run_git(
        repository.top, "log", "--first-parent", "--reverse", "--format=%H %cs", "--end-of-options", commit
    )
    rows = (line.partition(" ") for line in result.text.splitlines())
    return tuple((commit, day) for commit, _, day in rows)


def find_object_ids(repository: GitRepository, names: Iterable[str]) -> tuple[str, ...]:
    """Return the ids of objects by their names (`COMMIT:path`), empty where there is no such object."""
    # One name a line: a path with a line break would shift all answers behind it.
    safe_names = [name if "\n" not in name else "" for name in names]
    lines = "".join(f"{name}\n" for name in safe_names).encode("utf-8", "surrogateescape")
    result = run_git(repository.top, "cat-file", "--batch-check=%(objectname)", stdin=lines)
    answers = result.text.splitlines()
    if len(answers) != len(safe_names):
        msg = "the history cannot be read: the repository is damaged (`git fsck` says where)"
        raise GitError(msg)
    return tuple("" if line.endswith((" missing", " ambiguous")) else line for line in answers)
