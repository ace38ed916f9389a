"""Project: find a project and read its files, archgen.yaml first, then what `sources` names.

The files come from the disk, or from a commit of the repository that the project is in.
"""

from typing import TYPE_CHECKING

from archgen.project.project_loading import LoadedProject, load_project
from archgen.project.project_search import PROJECT_FILE, ProjectNotFoundError
from archgen.project.slice_parsing import ParsedSlices
from archgen.project.source_reading import PASS_FOLDER

if TYPE_CHECKING:
    from archgen.project.project_tracking import (
        NotAtRevisionError,
        TrackedProject,
        find_moved_project,
        find_tracked_project,
        load_at_commit,
        load_at_revision,
    )

__all__ = ["PASS_FOLDER", "PROJECT_FILE", "LoadedProject", "NotAtRevisionError", "ParsedSlices"]
__all__ += ["ProjectNotFoundError", "TrackedProject", "find_moved_project", "find_tracked_project", "load_at_commit"]
__all__ += ["load_at_revision", "load_project"]


def __getattr__(name: str) -> object:
    """Load what reads other revisions, and git with it, once it is asked for: a check of files does without."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from archgen.project import project_tracking

    return getattr(project_tracking, name)
