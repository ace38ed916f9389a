"""List the commits to look at: those along the main line's first parents that changed the project's files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from archgen import git
from archgen.project import MARKER, Tracked

By = Literal["revision", "month"]


@dataclass(frozen=True, slots=True)
class Commit:
    """A commit: its hash, its day by the committer's clock (`2026-03-12`), and the id of the project's tree or file in
    it.
    """

    id: str
    day: str
    tree: str


def commits(tracked: Tracked, by: By) -> tuple[Commit, ...]:
    """Return the commits of HEAD's line that changed the project, oldest first; by month, the last one of each month.

    Raises what `git.resolve_revision` raises.
    """
    repository = tracked.objects.repository
    folder, first = tracked.places[0]
    file = "/".join(filter(None, (folder, first)))
    # A project with archgen.yaml is its whole folder; one without is a single file.
    place = folder if first == MARKER else file
    lines = git.first_parents(repository, "HEAD")
    trees, files = (git.ids(repository, (f"{commit}:{one}" for commit, _ in lines)) for one in (place, file))
    every = (
        Commit(commit, day, tree)
        for (commit, day), tree, there in zip(lines, trees, files, strict=True)
        if tree and there  # the folder may be older than the project in it
    )
    changed = tuple(_changed(every))
    # In a dict the last commit of a month replaces those before it, at the place of the first.
    return changed if by == "revision" else tuple({one.day[:7]: one for one in changed}.values())


def _changed(every: Iterable[Commit]) -> Iterator[Commit]:
    """Yield the commits at which the tree differs from the one before."""
    last = ""
    for one in every:
        if one.tree != last:
            yield one
        last = one.tree
