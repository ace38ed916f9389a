"""Who wrote the commits between two, by the e-mail addresses in them: anybody may write any address there."""

from __future__ import annotations

from archgen.git.git_call import run_git
from archgen.git.repository_lookup import GitRepository


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
