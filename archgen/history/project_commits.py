"""List the commits to look at: those along the main line's first parents that changed the project's files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from archgen import git
from archgen.project import PROJECT_FILE, TrackedProject

HistoryInterval = Literal["revision", "month"]


@dataclass(frozen=True, slots=True)
class ProjectCommit:
    """A commit: its hash, its day by the committer's clock (`2026-03-12`), and the id of the project's tree or file in
    it.
    """

    id: str
    day: str
    tree_id: str


def list_commits(tracked: TrackedProject, interval: HistoryInterval) -> tuple[ProjectCommit, ...]:
    """Return the commits of HEAD's line that changed the project, oldest first; by month, the last one of each month.

    Raises what `git.resolve_revision` raises.
    """
    repository = tracked.objects.repository
    folder, first_file = tracked.locations[0]
    file = "/".join(filter(None, (folder, first_file)))
    # A project with archgen.yaml is its whole folder; one without is a single file.
    place = folder if first_file == PROJECT_FILE else file
    first_parents = git.list_first_parents(repository, "HEAD")
    tree_ids, file_ids = (
        git.find_object_ids(repository, (f"{commit}:{commit_or_path}" for commit, _ in first_parents))
        for commit_or_path in (place, file)
    )
    all_commits = (
        ProjectCommit(commit, day, tree_id)
        for (commit, day), tree_id, file_id in zip(first_parents, tree_ids, file_ids, strict=True)
        if tree_id and file_id  # the folder may be older than the project in it
    )
    changed = tuple(_changed_commits(all_commits))
    # In a dict the last commit of a month replaces those before it, at the place of the first.
    return (
        changed
        if interval == "revision"
        else tuple({commit_or_path.day[:7]: commit_or_path for commit_or_path in changed}.values())
    )


def _changed_commits(all_commits: Iterable[ProjectCommit]) -> Iterator[ProjectCommit]:
    """Yield the commits at which the tree differs from the one before."""
    last_tree = ""
    for commit in all_commits:
        if commit.tree_id != last_tree:
            yield commit
        last_tree = commit.tree_id
