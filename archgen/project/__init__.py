"""Project: find a project and read its files, archgen.yaml first, then what `sources` names."""

from archgen.project.find import MARKER, ProjectNotFoundError
from archgen.project.loaded import Loaded, load
from archgen.project.rules import RULES

__all__ = ["MARKER", "RULES", "Loaded", "ProjectNotFoundError", "load"]
