"""What comes out of merging branches, and what is asked about them from above this room."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import dataclass, field
from archgen.model.project_settings import BreakPolicy
from archgen.pipeline import CheckedProject


@dataclass(frozen=True, slots=True)
class FileConflict:
    """A file of the project that git conflicts in; `problem` is what people have to settle, None for nothing.

    `is_followed`: what it takes is to follow what one side renamed or moved.
    """

    file: str
    problem: str | None = None
    is_followed: bool = False


@dataclass(frozen=True, slots=True)
class JointBreaks:
    """What two sides break only together, as findings: what the second one takes from what the first one brought."""

    by_theirs: tuple[Diagnostic, ...] = ()
    """What breaks where our side is merged first, and then theirs."""
    by_ours: tuple[Diagnostic, ...] = ()
    partners: tuple[str, ...] = ()
    """What people call those who lose something, sorted."""

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """All of them, once each."""
        return tuple(dict.fromkeys((*self.by_theirs, *self.by_ours)))


BreakFinder = Callable[[CheckedProject, CheckedProject, CheckedProject, CheckedProject], JointBreaks]
"""Says what two sides break only together, from what both began with, ours, theirs, and both merged."""


FollowedVersion = tuple[CheckedProject, Mapping[str, bytes | None]]
"""A version with the names and places that the other side gave its elements, and the files that differ for it (None: gone)."""


@dataclass(frozen=True, slots=True)
class FollowedBranches:
    """Three versions in which each element is called and placed as the sides want it; `told` says what that is."""

    base: FollowedVersion
    ours: FollowedVersion
    theirs: FollowedVersion
    told: tuple[str, ...]


BranchFollower = Callable[
    [CheckedProject, CheckedProject, CheckedProject], tuple[FollowedBranches | None, tuple[FileConflict, ...]]
]
"""Follows in each version what a side renamed or moved; of what began with, ours, theirs."""


@dataclass(frozen=True, slots=True)
class BranchJudges:
    """What is asked about branches from above this room."""

    find_breaks: BreakFinder
    follow: BranchFollower


@dataclass(frozen=True, slots=True)
class BranchMerge:
    """What the main line would be with some branches merged into it.

    `new_findings` are those that neither the main line nor a branch (nor fewer of them together) has; they need not
    be wrong in any branch. `checked_project` is None where people have to settle conflicts first, or where the merged
    commit holds no project. `sides` are the branches of what was merged: none of them is the main line.
    """

    sides: tuple[tuple[str, ...], tuple[str, ...]]
    conflicts: tuple[FileConflict, ...] = ()
    new_findings: tuple[Diagnostic, ...] = ()
    checked_project: CheckedProject | None = None
    joint_breaks: JointBreaks = field(default_factory=JointBreaks)
    followed: tuple[str, ...] = ()
    """What one side renamed or moved and the other one followed, in sentences."""

    @property
    def branches(self) -> tuple[str, ...]:
        """All branches that are merged."""
        return self.sides[0] + self.sides[1]

    @property
    def goes_in_no_order(self) -> bool:
        """Whether each side breaks somebody where it is merged second."""
        return bool(self.joint_breaks.by_theirs and self.joint_breaks.by_ours)

    @property
    def order(self) -> tuple[tuple[str, ...], tuple[str, ...]] | None:
        """The sides in the only order in which the second one breaks nobody; None where there is no such order or none
        is needed. Whoever comes second relies on what the first one changed, and has to look.
        """
        if bool(self.joint_breaks.by_theirs) == bool(self.joint_breaks.by_ours):
            return None
        return self.sides if self.joint_breaks.by_ours else self.sides[::-1]

    @property
    def unread_files(self) -> tuple[str, ...]:
        """The files that could not be read: what the merge breaks cannot be judged then."""
        errors = self.checked_project.reading_errors if self.checked_project else ()
        return tuple(sorted({error.span.file for error in errors}))

    @property
    def is_refused(self) -> bool:
        """Whether the project's policy refuses what cannot be judged, as `archgen diff --breaking` does."""
        if self.checked_project is None:
            return True
        policy = self.checked_project.architecture.review.breaking or BreakPolicy()
        return bool(self.unread_files) and policy.gravest is Severity.ERROR

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """All that is wrong with the merged project and with none of its branches."""
        return (*self.joint_breaks.findings, *self.new_findings)

    @property
    def has_news(self) -> bool:
        """Whether the merge brings anything that none of its branches has by itself."""
        return bool(self.conflicts or self.findings)

    @property
    def is_blocked(self) -> bool:
        """Whether people have to settle something before there is a merged project."""
        return any(conflict.problem for conflict in self.conflicts)
