"""Figures that say what they rest on: exact, or a bound of one side, or unknown, and why."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import lcm
from typing import Literal, NamedTuple

from archgen.frozen import dataclass


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
MOST_NAMED = 12


def added(parts: Iterable[Fraction]) -> Fraction:
    """Add up over one denominator: to bring each partial sum to lowest terms takes most of the time of all analyses."""
    found = list(parts)
    if 0 < len(found) <= 2:  # noqa: PLR2004 - nothing is laid together twice
        return found[0] if len(found) == 1 else found[0] + found[1]
    return Fraction(*summed([part.as_integer_ratio() for part in found]))


def summed(parts: Iterable[tuple[int, int]]) -> tuple[int, int]:
    """Add up what is given as numerator and denominator; the sum is not in lowest terms."""
    found: dict[int, int] = {}
    for above, below in parts:
        found[below] = found.get(below, 0) + above
    if len(found) == 1:
        return next((above, below) for below, above in found.items())
    whole = lcm(*found)
    return sum([above * (whole // below) for below, above in found.items()]), whole


class Cause(NamedTuple):
    """Why something cannot be said: the elements whose figures are missing, or a word for it."""

    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def united(causes: Iterable[Cause]) -> Cause:
    """Lay causes together. The first dozen of what is missing is named; more would only grow along a chain."""
    found = tuple(causes)
    missing = tuple(dict.fromkeys(one for cause in found for one in cause.missing))
    notes = tuple(dict.fromkeys(note for cause in found for note in cause.notes))
    if len(missing) > MOST_NAMED:
        missing, notes = missing[:MOST_NAMED], tuple(dict.fromkeys((*notes, "more figures are missing")))
    return Cause(missing, notes)


def alike(one: Cause, other: Cause) -> bool:
    """Say whether two causes name the same. Round a loop the order of names turns for ever, and so does which dozen is named."""
    if set(one.notes) != set(other.notes):
        return False
    return set(one.missing) == set(other.missing) or len(one.missing) == len(other.missing) == MOST_NAMED
