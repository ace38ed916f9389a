"""The progress of a project over time: what is counted at each commit.

`archgen stats --history` and the cache of history write these as JSON (through `asdict`): the names of fields are keys.
"""

from __future__ import annotations

from typing import Literal

from archgen.frozen import dataclass


@dataclass(frozen=True, slots=True)
class FindingCounts:
    """The number of findings by severity."""

    error: int = 0
    warning: int = 0
    note: int = 0


@dataclass(frozen=True, slots=True)
class ProgressRow:
    """The counts of the project, a group or a partner as in `archgen stats`, and the number of its findings."""

    scope: Literal["project", "group", "partner"]
    id: str
    title: str
    components: int
    described: int
    typed: int
    mapped: int
    timed: int
    traced: int
    findings: FindingCounts


@dataclass(frozen=True, slots=True)
class HistoryPoint:
    """A project at one commit. The first row is the whole project's; `day` is the date by the committer's clock."""

    commit: str
    day: str
    groups: int
    nodes: int
    connections: int
    mapped_connections: int
    rows: tuple[ProgressRow, ...]

    @property
    def project_row(self) -> ProgressRow:
        """The row of the whole project."""
        return self.rows[0]


@dataclass(frozen=True, slots=True)
class History:
    """A project over time, oldest first. `whole` is False for a shallow clone, whose history begins later."""

    points: tuple[HistoryPoint, ...] = ()
    by: Literal["revision", "month"] = "revision"
    whole: bool = True
