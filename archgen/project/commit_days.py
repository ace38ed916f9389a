"""The day up to which a project's repository has gone: on it rests whether what is deprecated may still be used."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from archgen.model.architecture import Architecture
    from archgen.syntax.project_files import ProjectFiles


def find_newest_day(files: ProjectFiles, architecture: Architecture) -> str | None:
    """Return the day of the newest commit, as YYYY-MM-DD: of the commit that the files are of, else of HEAD.

    None where nothing in the project ends on a day (then git is not asked), and where git knows none.
    """
    if not _has_last_day(architecture):
        return None
    # Imported here: few projects have a last day.
    from archgen.git import project_revision

    commit = getattr(files, "commit", None)
    day = project_revision.find_commit_day(files.root, commit) if isinstance(commit, str) else None
    # What two branches make together is a tree, and no commit: the day of HEAD has to do.
    return day or project_revision.find_commit_day(files.root)


def _has_last_day(architecture: Architecture) -> bool:
    words = (
        *(output.deprecated for output in architecture.outputs.values()),
        *(output.deprecated for shell in architecture.shells.values() for output in shell.outputs.values()),
        *(each.deprecated for each in architecture.types.values()),
        *(each.deprecated for each in architecture.component_types.values()),
    )
    return any(deprecated is not None and deprecated.until is not None for deprecated in words)
