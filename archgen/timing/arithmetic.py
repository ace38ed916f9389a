"""Sums, smallest and largest of figures of which some are not known."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction

from archgen.timing.response import Cause, united
from archgen.timing.value import Value

UNBOUNDED = Value(None, assumptions=("unbounded",))
_NOTHING = Fraction(0)
NEVER = Value(Fraction(0), assumptions=("never fires",))


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
    if all(one.side == "exact" and one.value is not None and not one.assumptions for one in found):
        return Value(sum([one.value for one in found if one.value], _NOTHING))
    reasons = _reasons(found)
    if any(one.value is None and one.complete for one in found):
        return replace(reasons, value=None, complete=True, side="exact")
    known = [one.value for one in found if one.value is not None]
    return replace(reasons, value=sum(known, Fraction(0)) if known or not found else None)


def smallest(values: Iterable[Value]) -> Value:
    """Give the smallest of bounds, any of which holds: one complete bound is enough."""
    found = tuple(values)
    bounds = [one for one in found if one.complete and one.value is not None]
    if bounds:
        return min(bounds, key=_size)
    partial = [one for one in found if one.value is not None]
    if partial:
        return min(partial, key=_size)
    return next((one for one in found if not one.complete), UNBOUNDED)


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
    return Value(value.value * factor, value.complete, value.missing, value.assumptions, value.side)


def _size(value: Value) -> Fraction:
    return value.value or Fraction(0)


def _reasons(values: tuple[Value, ...]) -> Value:
    cause = united(Cause(one.missing, one.assumptions) for one in values)
    complete = all(one.complete for one in values)
    above = any(one.side == "at most" for one in values)
    side = "at least" if not complete else "at most" if above else "exact"
    return Value(None, complete, cause.missing, cause.notes, side)  # type: ignore[arg-type]
