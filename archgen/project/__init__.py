"""Project: find a project and read its files, archgen.yaml first, then what `sources` names.

The files come from the disk, or from a commit of the repository that the project is in.
"""

from archgen.project.project_loading import LoadedProject, load_project
from archgen.project.project_search import PROJECT_FILE, ProjectNotFoundError
from archgen.project.project_tracking import (
    NotAtRevisionError,
    TrackedProject,
    find_moved_project,
    find_tracked_project,
    load_at_commit,
    load_at_revision,
)
from archgen.project.slice_parsing import ParsedSlices
from archgen.project.source_reading import PASS_FOLDER
from archgen.project.source_rules import RULES

__all__ = [
    "PASS_FOLDER",
    "PROJECT_FILE",
    "RULES",
    "LoadedProject",
    "NotAtRevisionError",
    "ParsedSlices",
    "ProjectNotFoundError",
    "TrackedProject",
    "find_moved_project",
    "find_tracked_project",
    "load_at_commit",
    "load_at_revision",
    "load_project",
]
