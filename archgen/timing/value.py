"""Figures that say what they rest on: exact, or a bound of one side, or unknown, and why."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal


@dataclass(frozen=True, slots=True)
class Value:
    """A figure: durations in ns, rates in Hz, sizes in B, traffic in B/s, shares without unit; always exact.

    `value` None is unknown or unbounded; then an assumption says `overload`, `unbounded` or `diverged`, or `missing`
    names the elements whose figures are not known. With `complete` False a value is a sum of what is known: a bound
    from the side that `side` names.
    """

    value: Fraction | None
    complete: bool = True
    missing: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    side: Literal["exact", "at least", "at most"] = "exact"


UNKNOWN = Value(None, complete=False)
ZERO = Value(Fraction(0))
