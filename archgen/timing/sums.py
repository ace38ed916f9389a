"""Sums of figures that may not be known: what is known adds up, and what is missing stays named."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from archgen.timing.value import Value

BOUNDLESS = ("overload", "unbounded")
"""The assumptions of values that grow beyond any bound (a value that merely diverged, or is missing, is not known)."""


def total(values: Iterable[Value], side: Literal["at least", "at most"] = "at most") -> Value:
    """Add figures up, as a bound from the side that is asked for.

    Where a part has no bound of that side the sum is incomplete: it holds what is known, and is a bound from below. Where
    nothing but zeros is known it is None, since zero says nothing. One boundless part makes the sum boundless.
    """
    parts = tuple(values)
    missing = tuple(dict.fromkeys(name for part in parts for name in part.missing))
    assumptions = tuple(dict.fromkeys(text for part in parts for text in part.assumptions))
    if any(boundless(part) for part in parts):
        return Value(None, all(known(part, side) or boundless(part) for part in parts), missing, assumptions)
    known_sum = sum((part.value for part in parts if part.value is not None), Fraction(0))
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
