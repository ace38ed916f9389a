"""Compare all projects of a repository: which of them a change touches, and through which library."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from pathlib import Path

from archgen import git
from archgen.compare.review_facts import ReviewFacts
from archgen.diagnostics import join_words
from archgen.frozen import NamedTuple
from archgen.pipeline import CheckedProject
from archgen.products.compared_versions import ProjectVersion, compare_named_versions, read_versions, split_range
from archgen.products.comparison_documents import describe_versions
from archgen.project import PROJECT_FILE, ProjectNotFoundError
from archgen.project.project_search import find_project
from archgen.syntax.file_patterns import OUTPUT_FOLDER
from archgen.syntax.folder_files import FolderFiles


class ProjectComparison(NamedTuple):
    """What changed in one project of a repository, by its folder from where one asks."""

    folder: str
    summary: str
    has_changes: bool
    is_refused: bool = False


class ComparedProject(NamedTuple):
    """A project of a repository, by its folder from where one asks, and in which of two versions it is."""

    folder: str
    is_before: bool
    is_after: bool


def list_projects_below(path: Path | None, revision: str | None) -> tuple[str, ...]:
    """Return the folders of the projects that a revision (None: the disk) holds below a folder.

    Nothing where there is a project at the folder or around it. Raise `git.GitError`.
    """
    try:
        find_project(path)
    except ProjectNotFoundError:
        pass
    else:
        return ()
    repository = git.find_repository(path or Path.cwd())
    if revision is None:
        return tuple(sorted(_list_projects_on_disk(repository.folder)))
    tree = git.GitObjects(repository).list_tree(git.resolve_revision(repository, revision), repository.prefix) or {}
    return tuple(posixpath.dirname(file) for file in tree if posixpath.basename(file) == PROJECT_FILE)


def _list_projects_on_disk(top: Path) -> Iterator[str]:
    for folder, folders, file_names in FolderFiles(top).walk_folders(""):
        folders[:] = [name for name in folders if name[0] != "." and name != OUTPUT_FOLDER]
        if PROJECT_FILE in file_names:
            yield folder


def list_compared_projects(path: Path | None, first: str | None, second: str | None) -> tuple[ComparedProject, ...]:
    """Return the projects of both versions below a folder without a project of its own, sorted by folder.

    `first` and `second` are revisions, as for `read_versions`. Raise `git.GitError`, also for what is none.
    """
    revisions = _find_revisions(path, first, second)
    before, after = (list_projects_below(path, revision) for revision in revisions)
    return tuple(ComparedProject(each, each in before, each in after) for each in sorted({*before, *after}))


def _find_revisions(path: Path | None, first: str | None, second: str | None) -> tuple[str, str | None]:
    """Return the revisions that two versions name; None is the working tree."""
    repository = git.find_repository(path or Path.cwd())
    if first is None:
        return git.find_branch_base(repository).commit_id, None
    old_revision, dots, new_revision = split_range(first) if second is None else (first, "", second)
    if dots == "...":
        old_revision = git.find_common_commit(repository, old_revision, new_revision).commit_id
    return old_revision, None if new_revision in {"", "."} else new_revision


def compare_projects_below(
    path: Path | None,
    projects: Iterable[ComparedProject],
    first: str | None,
    second: str | None,
    forge_facts: ReviewFacts | None = None,
) -> Iterator[ProjectComparison]:
    """Yield what changed in each project. `first` and `second` are the versions, as for `read_versions`.

    A project in another folder than before counts as gone there and new here. Raise `git.GitError`.
    """
    for project in projects:
        if project.is_before and project.is_after:
            folder = (path or Path()) / project.folder
            yield _compare_project(project.folder, *read_versions(first, second, folder), forge_facts)
        else:
            summary = "not there before" if project.is_after else "not there any more"
            yield ProjectComparison(project.folder, summary, has_changes=True)


def _compare_project(
    folder: str, old_version: ProjectVersion, new_version: ProjectVersion, forge_facts: ReviewFacts | None
) -> ProjectComparison:
    comparison = compare_named_versions(old_version, new_version, forge_facts=forge_facts)
    if comparison.is_empty:
        return ProjectComparison(folder, "nothing changed", has_changes=False)
    document = describe_versions(comparison, old_version, new_version)
    libraries = [
        f"`{name}`" for name in _list_changed_libraries(old_version.checked_project, new_version.checked_project)
    ]
    noun = "library" if len(libraries) == 1 else "libraries"
    parts = [
        document.counts,
        f"the {noun} {join_words(libraries)} changed" if libraries else "",
        f"breaks {join_words(document.broken_partners)}" if document.broken_partners else "",
        document.obstacle,
    ]
    return ProjectComparison(folder, "; ".join(filter(None, parts)), has_changes=True, is_refused=comparison.is_refused)


def _list_changed_libraries(before: CheckedProject, after: CheckedProject) -> list[str]:
    old_texts, new_texts = (_read_library_texts(each) for each in (before, after))
    return [name for name in dict.fromkeys((*old_texts, *new_texts)) if old_texts.get(name) != new_texts.get(name)]


def _read_library_texts(checked_project: CheckedProject) -> dict[str, list[tuple[str, str | None]]]:
    """Return the texts of the files of each library, by the library's id."""
    return {
        library.id: [(document.file, checked_project.sources.text_of(document.file)) for document in library.documents]
        for library in checked_project.loaded_project.libraries
        if not library.is_shipped
    }
