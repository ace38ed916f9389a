"""How a project is held against the robot that exists: against what, which nodes do not count, accepted differences."""

from __future__ import annotations

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass, field


@dataclass(frozen=True, slots=True)
class AcceptedDifference:
    """What the rules may find at an element, by the id that findings name, and why; `until` is the tag that ends it."""

    element: str
    rules: tuple[str, ...]
    reason: str
    until: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ConformSettings:
    """The section `conform`. Paths in `against` are relative to the project's folder; `*` in `ignore` is any characters."""

    against: tuple[str, ...] = ()
    launch: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    accepted: tuple[AcceptedDifference, ...] = ()
