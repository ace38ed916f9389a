"""The chapters of documents: those that archgen generates, and those that the project writes."""

from __future__ import annotations

from archgen.frozen import dataclass

GENERATED_CHAPTERS = (
    *("overview", "between_partners", "use_cases", "groups", "frames", "variants", "deployment", "start_up", "timing"),
    *("chains", "views", "types", "connections", "requirements", "properties", "open_points", "statistics", "glossary"),
)
"""The generated chapters by their names in `report.chapters`, in their default order."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """A chapter that the project wrote: its path relative to the project's folder, and its CommonMark text."""

    path: str
    text: str

    @property
    def folder(self) -> str:
        """The folder of the chapter, which the paths of its pictures are relative to."""
        return self.path.rpartition("/")[0]
