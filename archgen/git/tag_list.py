"""The tags of a repository below a path of names, with who set them and when."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from archgen.frozen import dataclass
from archgen.git.git_call import run_git

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
