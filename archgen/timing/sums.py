"""Sums, smallest and largest of figures that may not be known: what is known adds up, and what is missing stays named."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from archgen.timing.value import Cause, Value, added, united

UNBOUNDED = Value(None, assumptions=("unbounded",))
NEVER = Value(Fraction(0), assumptions=("never fires",))
BOUNDLESS = ("overload", "unbounded")
"""The assumptions of values that grow beyond any bound (a value that merely diverged, or is missing, is not known)."""


def unknown(*missing: str) -> Value:
    """Give what is not known for want of some elements' figures."""
    return Value(None, complete=False, missing=missing)


def because(cause: Cause) -> Value:
    """Give what is not known for a cause: unbounded (complete, as nothing is missing), or missing figures."""
    return Value(None, complete=not cause.missing, missing=cause.missing, assumptions=cause.notes)


def total(values: Iterable[Value]) -> Value:
    """Add up. What is not known is left out, and the sum is at least what the rest gives; one unbounded makes it so."""
    found = tuple(values)
    if len(found) == 1:
        return found[0]
    exact: list[Fraction] = []
    for one in found:
        if one.value is None or one.assumptions or one.side != "exact":
            break
        exact.append(one.value)
    else:
        return Value(added(exact))
    reasons = _reasons(found)
    if any(one.value is None and (one.complete or boundless(one)) for one in found):
        return replace(reasons, value=None, side="exact")
    known = [one.value for one in found if one.value is not None]
    return replace(reasons, value=added(known) if known or not found else None)


def smallest(values: Iterable[Value]) -> Value:
    """Give the smallest of bounds, any of which holds: one complete bound is enough.

    What is only known from below may be smaller than it seems once all is known, so that it counts where all others are.
    """
    found = tuple(values)
    bounds = [one for one in found if known(one)]
    if bounds:
        return min(bounds, key=_size)
    unsure = tuple(one for one in found if not boundless(one))
    if not unsure:
        return next(iter(found), UNBOUNDED)
    reasons = _reasons(unsure)
    if any(one.value is None for one in unsure):
        return replace(reasons, value=None, side="exact")
    return replace(reasons, value=min(map(_size, unsure)))


def largest(values: Iterable[Value]) -> Value:
    """Give the largest of bounds, all of which are needed."""
    found = tuple(values)
    reasons = _reasons(found)
    if any(one.value is None for one in found):
        return replace(reasons, value=None, side="exact")
    return replace(reasons, value=max((one.value for one in found if one.value is not None), default=Fraction(0)))


def times(value: Value, factor: Fraction | int) -> Value:
    """Multiply, keeping what it rests on."""
    if value.value is None or factor == 1:
        return value
    return kept(value, value.value * factor)


def kept(value: Value, figure: Fraction) -> Value:
    """Give another figure that rests on the same."""
    return Value(figure, value.complete, value.missing, value.assumptions, value.side)


def bounded(values: Iterable[Value], side: Literal["at least", "at most"] = "at most") -> Value:
    """Add figures up, as a bound from the side that is asked for, which is stricter than `total`.

    Where a part has no bound of that side the sum is incomplete: it holds what is known, and is a bound from below. Where
    nothing but zeros is known it is None, since zero says nothing. One boundless part makes the sum boundless.
    """
    parts = tuple(values)
    missing = tuple(dict.fromkeys(name for part in parts for name in part.missing))
    assumptions = tuple(dict.fromkeys(text for part in parts for text in part.assumptions))
    if any(boundless(part) for part in parts):
        return Value(None, all(known(part, side) or boundless(part) for part in parts), missing, assumptions)
    known_sum = added(part.value for part in parts if part.value is not None)
    if all(known(part, side) for part in parts):
        exact = all(part.side == "exact" for part in parts)
        return Value(
            known_sum, complete=True, missing=missing, assumptions=assumptions, side="exact" if exact else side
        )
    return Value(known_sum or None, complete=False, missing=missing, assumptions=assumptions, side="at least")


def known(value: Value, side: Literal["at least", "at most"] = "at most") -> bool:
    """Tell whether a figure is a bound from a side: complete, or incomplete on the harmless side."""
    return value.value is not None and (value.complete or value.side == side)


def boundless(value: Value) -> bool:
    """Tell whether a figure grows beyond any bound, which is more than that it is not known."""
    return value.value is None and any(text.split(":")[0].strip() in BOUNDLESS for text in value.assumptions)


def nameless(value: Value, element: str) -> Value:
    """Name an element where a figure that is not known names none."""
    if known(value) or value.missing or boundless(value):
        return value
    return replace(value, complete=False, missing=(element,))


def _size(value: Value) -> Fraction:
    return value.value or Fraction(0)


def _reasons(values: tuple[Value, ...]) -> Value:
    cause = united(Cause(one.missing, one.assumptions) for one in values)
    complete = all(one.complete for one in values)
    above = any(one.side == "at most" for one in values)
    side = "at least" if not complete else "at most" if above else "exact"
    return Value(None, complete, cause.missing, cause.notes, side)  # type: ignore[arg-type]
