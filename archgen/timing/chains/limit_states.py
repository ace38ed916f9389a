"""Whether a figure keeps a limit, breaks it, or nobody can say since it rests on figures that are missing."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Literal

from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound, is_unfound

LimitState = Literal["kept", "broken", "unknown"]


def judge_upper_limit(bound: TimingValue, limit: Fraction) -> LimitState:
    """Return whether a duration stays within a limit; one without a bound, though no figure is missing, does not."""
    if bound.value is not None and bound.value > limit:
        return "broken"
    if is_known_bound(bound):
        return "kept"
    is_without_bound = (is_unfound(bound) or (bound.value is None and bound.complete)) and not bound.missing
    return "broken" if is_boundless(bound) or is_without_bound else "unknown"


def judge_lower_limit(rate: TimingValue, limit: Fraction) -> LimitState:
    """Return whether a rate is at least as high as a limit."""
    if rate.value is None or not (rate.complete or rate.side != "exact"):
        return "unknown"
    is_kept = rate.value >= limit
    # What is only known from the other side may be more, or less.
    return "unknown" if rate.side == ("at most" if is_kept else "at least") else "kept" if is_kept else "broken"


def find_worst_state(states: Iterable[LimitState]) -> LimitState:
    """Return the state of a limit that several figures have to keep: one that breaks it is enough."""
    found = set(states)
    return "broken" if "broken" in found else "unknown" if "unknown" in found else "kept"
