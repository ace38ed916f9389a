"""What the owner of an interface says of its future: what readers may count on, and what is going away."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.quantity import Quantity

FIGURE_KEYS = ("rate", "max_gap", "max_age")
"""The promised figures of timing."""
PROMISE_KEYS = (*FIGURE_KEYS, "unit", "frame", "range")


@dataclass(frozen=True, slots=True)
class Promise:
    """What readers of an output may count on: rate in Hz, durations in ns; None is not promised.

    `max_age` is how old what a reader uses may be, since it was sent. `range` is the least and the greatest value, in
    `unit`.
    """

    rate: Quantity | None = None
    max_gap: Quantity | None = None
    max_age: Quantity | None = None
    unit: str | None = None
    frame: str | None = None
    range: tuple[float, float] | None = None
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """Where each of them is written, by key."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    def list_kept(self) -> Iterator[tuple[str, object]]:
        """Yield what is promised, by key, in the order of the keys."""
        for key in PROMISE_KEYS:
            value = getattr(self, key)
            if value is not None:
                yield key, value


@dataclass(frozen=True, slots=True)
class Deprecation:
    """That something is going away. `until` is the last day on which it may be used, as YYYY-MM-DD.

    `use` is what replaces it, as written; `target` the complete id of that output, or the name of that type, None while
    it is not known.
    """

    until: str | None = None
    use: str | None = None
    target: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    use_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    def is_past(self, day: str | None) -> bool:
        """Whether the last day is over on a day (YYYY-MM-DD); on no known day anything is."""
        return day is not None and self.until is not None and day > self.until


def describe_deprecation(deprecated: Deprecation) -> str:
    """Return in words until when something may be used, and what replaces it: `until 2027-03-01, use cloud instead`."""
    until = f"until {deprecated.until}" if deprecated.until else "no day named"
    return f"{until}, use {deprecated.use} instead" if deprecated.use else until


def format_range(limits: tuple[float, float], unit: str | None = None) -> str:
    """Return the least and the greatest value as people read them: `0 to 30 m`."""
    least, greatest = (format_limit(limit) for limit in limits)
    return f"{least} to {greatest}{f' {unit}' if unit else ''}"


def format_limit(limit: float) -> str:
    """Return a limit as people read it."""
    if limit in {float("inf"), float("-inf")}:
        return "no limit" if limit > 0 else "no lower limit"
    return str(limit).removesuffix(".0")
