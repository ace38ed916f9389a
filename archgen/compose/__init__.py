"""Types and instances: write out what components are made from, and take composed components apart."""

from archgen.compose.expanded_project import ExpandedProject
from archgen.compose.library_types import list_type_entries
from archgen.compose.project_expansion import expand_project

__all__ = ["ExpandedProject", "expand_project", "list_type_entries"]
