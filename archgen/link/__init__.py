"""Link: merge the slices, declare the elements, resolve the references, and return the architecture."""

from archgen.link.project_linking import link_project

__all__ = ["link_project"]
