"""What documents consist of beside the architecture: the chapters that archgen writes, and those of the project."""

from __future__ import annotations

from archgen.frozen import dataclass

GENERATED = (
    "overview",
    "groups",
    "deployment",
    "timing",
    "chains",
    "views",
    "types",
    "connections",
    "requirements",
    "open_points",
    "statistics",
)
"""The chapters that archgen writes, by the names that `report.chapters` uses, in their order where nobody says otherwise."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """A chapter that the project wrote: its path in the project, and its CommonMark."""

    path: str
    text: str

    @property
    def folder(self) -> str:
        """Give the folder that the chapter's pictures are found from."""
        return self.path.rpartition("/")[0]
