"""List the line of commits that led to one, and look up the ids of objects in them.

Who wrote the commits between two, by the e-mail addresses in them: anybody may write any address there.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from archgen.frozen import dataclass
from archgen.git.git_call import GitError, run_git
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
        raise GitError("the history cannot be read: the repository is damaged (`git fsck` says where)")
    return tuple("" if line.endswith((" missing", " ambiguous")) else line for line in answers)


_FIELDS = ("refname:strip=2", "creatordate:short", "taggername", "contents:subject", "*objectname", "objectname")
"""`*objectname` is the commit that an annotated tag stands at; a light one has only an object name."""


@dataclass(frozen=True, slots=True)
class NamedTag:
    """A tag: its name, the day of it (of a light one that of its commit), who set it, its first line, its commit."""

    name: str
    date: str
    tagger: str
    subject: str
    commit: str


def has_tag(folder: Path, name: str) -> bool:
    """Whether the repository around a folder has a tag of this name; not outside of one."""
    return not run_git(folder, "rev-parse", "--quiet", "--verify", f"refs/tags/{name}").status


def list_tags_below(folder: Path, prefixes: Iterable[str]) -> tuple[NamedTag, ...]:
    """Return the tags below any of these prefixes (`signed/a-b`) that lie in the history of HEAD, newest first.

    None outside a repository, and before the first commit.
    """
    patterns = [f"refs/tags/{prefix}/" for prefix in prefixes]
    form = "%00".join(f"%({name})" for name in _FIELDS)
    # Tags of other branches, and those that are newer than what is checked out, say nothing of its past.
    result = run_git(
        folder, "for-each-ref", "--merged=HEAD", "--sort=-refname", "--sort=-creatordate", f"--format={form}", *patterns
    )
    if result.status:
        return ()
    rows = (line.split("\0") for line in result.output.decode("utf-8", "replace").split("\n"))
    return tuple(
        NamedTag(name, date, tagger, subject if tagger else "", commit or own_object)
        for name, date, tagger, subject, commit, own_object in (row for row in rows if len(row) == len(_FIELDS))
    )
