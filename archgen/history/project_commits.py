"""List the commits to look at: those along the main line's first parents that changed the project's files."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from typing import Literal

from archgen import git
from archgen.frozen import dataclass, replace
from archgen.project import PROJECT_FILE, TrackedProject
from archgen.project.library_reading import list_library_paths
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.project_files import MAX_BYTES, find_path_refusal, find_place_refusal

HistoryInterval = Literal["revision", "month"]


@dataclass(frozen=True, slots=True)
class ProjectCommit:
    """A commit: its hash, its day by the committer's clock (`2026-03-12`), and the id of the project's tree or file in
    it, with those of the libraries that lie elsewhere.
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
    all_commits = [
        ProjectCommit(commit, day, tree_id)
        for (commit, day), tree_id, file_id in zip(first_parents, tree_ids, file_ids, strict=True)
        if tree_id and file_id  # the folder may be older than the project in it
    ]
    if first_file == PROJECT_FILE:
        all_commits = _add_libraries(tracked, folder, all_commits, [each for each in file_ids if each])
    changed = tuple(_changed_commits(all_commits))
    # In a dict the last commit of a month replaces those before it, at the place of the first.
    return (
        changed
        if interval == "revision"
        else tuple({commit_or_path.day[:7]: commit_or_path for commit_or_path in changed}.values())
    )


def _add_libraries(
    tracked: TrackedProject, folder: str, all_commits: list[ProjectCommit], file_ids: Iterable[str]
) -> list[ProjectCommit]:
    """Return the commits with the ids of the libraries that any version of archgen.yaml names, one after the other."""
    library_folders = sorted(
        {
            library_folder
            for file_id in dict.fromkeys(file_ids)
            for library_folder in _list_outer_libraries(tracked, folder, file_id)
        }
    )
    for library_folder in library_folders:
        tree_ids = git.find_object_ids(
            tracked.objects.repository, (f"{commit.id}:{library_folder}" for commit in all_commits)
        )
        all_commits = [
            replace(commit, tree_id=f"{commit.tree_id} {tree_id}")
            for commit, tree_id in zip(all_commits, tree_ids, strict=True)
        ]
    return all_commits


def _list_outer_libraries(tracked: TrackedProject, folder: str, file_id: str) -> Iterator[str]:
    """Yield the folders of libraries outside of the project's own, from the repository's top."""
    size = tracked.objects.blob_size(file_id)
    data = tracked.objects.read_blob(file_id) if size is not None and size <= MAX_BYTES else None
    # Nearly every project has none, and parsing each version of a file takes longer than all else here.
    if data is None or b"libraries" not in data:
        return
    parsed_slice = parse_slice(PROJECT_FILE, data.decode("utf-8", "replace"))
    validated = parsed_slice.validate_once()
    document = parsed_slice.document or validated.settings
    for path in list_library_paths(document.root).values() if document else ():
        library_folder = posixpath.normpath(posixpath.join(folder, path.text))
        is_inside = not folder or library_folder.startswith(f"{folder}/")
        if not is_inside and not find_path_refusal(path.text) and not find_place_refusal(folder, path.text):
            yield library_folder


def _changed_commits(all_commits: Iterable[ProjectCommit]) -> Iterator[ProjectCommit]:
    """Yield the commits at which the tree differs from the one before."""
    last_tree = ""
    for commit in all_commits:
        if commit.tree_id != last_tree:
            yield commit
        last_tree = commit.tree_id
