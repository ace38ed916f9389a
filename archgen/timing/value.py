"""Figures that say what they rest on: exact, a bound from one side, or unknown and why."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import lcm
from typing import Literal, NamedTuple

from archgen.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Value:
    """A figure: durations in ns, rates in Hz, sizes in B, traffic in B/s, shares without a unit; always exact.

    `value` None means unknown or unbounded: then an assumption says `overload`, `unbounded` or `diverged`, or `missing`
    names the elements whose figures are not written. With `complete` False, `value` is the sum of what is known, a
    bound from the side that `side` names.
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
    """Return the sum of fractions over one common denominator."""
    # Reducing each partial sum to lowest terms, as Fraction.__add__ does, took most of the time of a whole analysis.
    found = list(parts)
    if 0 < len(found) <= 2:  # noqa: PLR2004 - two terms need no grouping
        return found[0] if len(found) == 1 else found[0] + found[1]
    return Fraction(*summed([part.as_integer_ratio() for part in found]))


def summed(parts: Iterable[tuple[int, int]]) -> tuple[int, int]:
    """Return the sum of (numerator, denominator) pairs as such a pair, not in lowest terms."""
    # Terms of equal denominator first: in practice there are few distinct periods, so the lcm below stays small.
    found: dict[int, int] = {}
    for above, below in parts:
        found[below] = found.get(below, 0) + above
    if len(found) == 1:
        return next((above, below) for below, above in found.items())
    whole = lcm(*found)
    return sum([above * (whole // below) for below, above in found.items()]), whole


class Cause(NamedTuple):
    """Why there is no figure: the elements whose figures are missing, or a word for it (such as `overload`)."""

    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def united(causes: Iterable[Cause]) -> Cause:
    """Merge causes, keeping the order of first mention.

    At most `MAX_NAMED_MISSING` elements are named: more would only grow along a chain.
    """
    found = tuple(causes)
    missing = tuple(dict.fromkeys(one for cause in found for one in cause.missing))
    notes = tuple(dict.fromkeys(note for cause in found for note in cause.notes))
    if len(missing) > MOST_NAMED:
        missing, notes = missing[:MOST_NAMED], tuple(dict.fromkeys((*notes, "more figures are missing")))
    return Cause(missing, notes)


def alike(one: Cause, other: Cause) -> bool:
    """Whether two causes name the same elements and notes, in any order."""
    # Compared as sets: the fixed point in event_propagation asks this round a loop, where the order of names rotates
    # for ever. Two causes that are both cut at the cap count as equal, since which dozen survives rotates as well.
    if set(one.notes) != set(other.notes):
        return False
    return set(one.missing) == set(other.missing) or len(one.missing) == len(other.missing) == MOST_NAMED
