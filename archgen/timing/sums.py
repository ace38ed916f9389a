"""Sums, minima and maxima of figures that may be unknown: what is known adds up, and what is missing stays named."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from archgen.timing.value import Cause, Value, added, united

UNBOUNDED = Value(None, assumptions=("unbounded",))
NEVER = Value(Fraction(0), assumptions=("never fires",))
"""The rate of what never fires: a known zero, unlike a rate that nobody wrote."""
BOUNDLESS = ("overload", "unbounded")
"""Assumptions of values that grow beyond any bound. `diverged` is none of them: there the search was given up."""


def unknown(*missing: str) -> Value:
    """Return the value of a figure that is unknown because these elements' figures are missing."""
    return Value(None, complete=False, missing=missing)


def because(cause: Cause) -> Value:
    """Return the value for a cause: complete (nothing to fill in) where only notes say why, else missing figures."""
    return Value(None, complete=not cause.missing, missing=cause.missing, assumptions=cause.notes)


def total(values: Iterable[Value]) -> Value:
    """Return the sum; one unbounded term makes it unbounded.

    Unknown terms are left out, and make the sum a bound from below.
    """
    found = tuple(values)
    if len(found) == 1:
        return found[0]
    # Fast path: nearly all sums are of exact figures without assumptions, and need no merging of reasons.
    exact: list[Fraction] = []
    for one in found:
        if one.value is None or one.assumptions or one.side != "exact":
            break
        exact.append(one.value)
    else:
        return Value(added(exact))
    reasons = _reasons(found)
    # An unbounded term outweighs the unknown ones, which stay named in `missing`.
    if any(one.value is None and (one.complete or boundless(one)) for one in found):
        return replace(reasons, value=None, side="exact")
    known = [one.value for one in found if one.value is not None]
    return replace(reasons, value=added(known) if known or not found else None)


def smallest(values: Iterable[Value]) -> Value:
    """Return the smallest of several bounds of which any one suffices.

    A complete bound counts even where others are unknown. A figure known only from below may turn out larger, so that
    it counts only where no complete bound is there.
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
    """Return the largest of several bounds, all of which are needed: one unknown makes the result unknown."""
    found = tuple(values)
    reasons = _reasons(found)
    if any(one.value is None for one in found):
        return replace(reasons, value=None, side="exact")
    return replace(reasons, value=max((one.value for one in found if one.value is not None), default=Fraction(0)))


def times(value: Value, factor: Fraction | int) -> Value:
    """Return the value times a factor, resting on the same assumptions."""
    if value.value is None or factor == 1:
        return value
    return kept(value, value.value * factor)


def kept(value: Value, figure: Fraction) -> Value:
    """Return another figure with the same completeness, missing elements, assumptions and side."""
    return Value(figure, value.complete, value.missing, value.assumptions, value.side)


def bounded(values: Iterable[Value], side: Literal["at least", "at most"] = "at most") -> Value:
    """Return the sum as a bound from the given side; stricter than `add_values`, which accepts terms of either side.

    Where a term has no bound from that side the sum is incomplete and holds what is known, as a bound from below. It is
    None where nothing but zeros is known, since zero says nothing. One boundless term makes the sum boundless.
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
    # `or None`: a sum of zero would be printed as ">= 0 ms".
    return Value(known_sum or None, complete=False, missing=missing, assumptions=assumptions, side="at least")


def known(value: Value, side: Literal["at least", "at most"] = "at most") -> bool:
    """Whether a figure is a bound from a side: complete, or incomplete on the harmless side."""
    return value.value is not None and (value.complete or value.side == side)


def boundless(value: Value) -> bool:
    """Whether a figure grows beyond any bound, which is more than being unknown."""
    # An assumption may go on after a colon; only the word before it is compared.
    return value.value is None and any(text.split(":")[0].strip() in BOUNDLESS for text in value.assumptions)


def nameless(value: Value, element: str) -> Value:
    """Return the value, with `element` as what is missing if it is unknown and names nothing itself."""
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
