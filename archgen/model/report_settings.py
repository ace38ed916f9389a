"""What a project says of its report beside the chapters: level of detail, first pages, lists, paper."""

from __future__ import annotations

from typing import Literal

from archgen.frozen import dataclass

ReportList = Literal["figures", "tables"]


@dataclass(frozen=True, slots=True)
class HistoryEntry:
    """A version of the document, as its authors list it."""

    version: str = ""
    date: str = ""
    author: str = ""
    change: str = ""


@dataclass(frozen=True, slots=True)
class ReportSettings:
    """The section `report` without its chapters. What is empty is not written.

    `level` is None where the project leaves it open: everything, with the ROS side in an annex. `summary` is CommonMark.
    """

    level: Literal["functional", "implementation"] | None = None
    date: str = ""
    number: str = ""
    authors: tuple[str, ...] = ()
    dissemination: str = ""
    history: tuple[HistoryEntry, ...] = ()
    abbreviations: tuple[tuple[str, str], ...] = ()
    summary: str = ""
    lists: tuple[ReportList, ...] = ()
    has_large_paper: bool = False
