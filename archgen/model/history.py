"""How far a project was at one commit: what is counted over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Findings:
    """Findings by severity."""

    error: int = 0
    warning: int = 0
    note: int = 0


@dataclass(frozen=True, slots=True)
class Row:
    """The counts of the whole project, of a group or of a partner, as `archgen stats` has them, and its findings."""

    scope: Literal["project", "group", "partner"]
    id: str
    title: str
    components: int
    described: int
    typed: int
    mapped: int
    timed: int
    traced: int
    findings: Findings


@dataclass(frozen=True, slots=True)
class Point:
    """A project at one commit; the first row is the whole. `day` is that of the committer's clock."""

    commit: str
    day: str
    groups: int
    nodes: int
    connections: int
    mapped_connections: int
    rows: tuple[Row, ...]

    @property
    def whole(self) -> Row:
        """Give the row of the whole project."""
        return self.rows[0]


@dataclass(frozen=True, slots=True)
class History:
    """A project over time, oldest first. A shallow clone's is not whole: it begins where the clone does."""

    points: tuple[Point, ...] = ()
    by: Literal["revision", "month"] = "revision"
    whole: bool = True
