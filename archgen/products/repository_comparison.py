"""Compare all projects of a repository: which of them a change touches, and through which library."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from archgen import git
from archgen.diagnostics.common_wording import join_words
from archgen.pipeline import CheckedProject
from archgen.products.compared_versions import ProjectVersion, compare_named_versions, read_versions
from archgen.products.comparison_documents import describe_versions
from archgen.project import PROJECT_FILE, NotAtRevisionError, ProjectNotFoundError
from archgen.project.project_search import find_project


class ProjectComparison(NamedTuple):
    """What changed in one project of a repository, by its folder from where one asks."""

    folder: str
    summary: str
    has_changes: bool
    is_refused: bool = False


def list_projects_below(path: Path | None, revision: str | None) -> tuple[str, ...]:
    """Return the folders of the projects that a revision (None: HEAD) holds below a folder without a project of its own.

    Nothing where there is a project at the folder or around it. Raise `git.GitError`.
    """
    try:
        find_project(path)
    except ProjectNotFoundError:
        pass
    else:
        return ()
    repository = git.find_repository(path or Path.cwd())
    objects = git.GitObjects(repository)
    tree = objects.list_tree(git.resolve_revision(repository, revision or "HEAD"), repository.prefix) or {}
    return tuple(posixpath.dirname(file) for file in tree if posixpath.basename(file) == PROJECT_FILE)


def compare_projects_below(
    path: Path | None, folders: tuple[str, ...], first: str | None, second: str | None
) -> Iterator[ProjectComparison]:
    """Yield what changed in each project. `first` and `second` are the versions, as for `read_versions`.

    Raise `git.GitError`.
    """
    for folder in folders:
        project = (path or Path()) / folder
        try:
            yield _compare_project(folder, *read_versions(first, second, project))
        except NotAtRevisionError:
            yield ProjectComparison(folder, "not there before", has_changes=True)
        except ProjectNotFoundError:
            yield ProjectComparison(folder, "not there any more", has_changes=True)


def _compare_project(folder: str, old_version: ProjectVersion, new_version: ProjectVersion) -> ProjectComparison:
    comparison = compare_named_versions(old_version, new_version)
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
