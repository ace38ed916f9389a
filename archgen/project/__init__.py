"""Project: find a project and read its files, archgen.yaml first, then what `sources` names.

The files come from the disk, or from a commit of the repository that the project is in.
"""

from archgen.project.find import MARKER, ProjectNotFoundError
from archgen.project.loaded import Loaded, load
from archgen.project.rules import RULES
from archgen.project.slices import Slices
from archgen.project.tracked import NotAtRevisionError, Tracked, load_at, load_commit, tracked

__all__ = [
    "MARKER",
    "RULES",
    "Loaded",
    "NotAtRevisionError",
    "ProjectNotFoundError",
    "Slices",
    "Tracked",
    "load",
    "load_at",
    "load_commit",
    "tracked",
]
