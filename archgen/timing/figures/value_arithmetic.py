"""Sums, minima and maxima of figures that may be unknown: what is known adds up, and what is missing stays named."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Literal

from archgen.frozen import replace
from archgen.timing.figures.timing_values import TimingValue, UnknownCause, sum_fractions, unite_causes

UNBOUNDED_VALUE = TimingValue(None, assumptions=("unbounded",))
NEVER_FIRES = TimingValue(Fraction(0), assumptions=("never fires",))
"""The rate of what never fires: a known zero, unlike a rate that nobody wrote."""
BOUNDLESS_WORDS = ("overload", "unbounded")
"""Assumptions of values that grow beyond any bound. `diverged` is none of them: there the search was given up."""
UNLINKED_NOTE = "no link joins their hosts"
"""The note of what is unknown because the hosts of two elements are not joined."""
NO_MATCH_NOTE = "no sure match"
"""What the note begins with of what is not bounded because inputs are matched by time and nothing promises a match."""
NO_USE_NOTE = "no sure use"
"""What the note begins with of what is not bounded because each message may be among those that are forgotten."""
SATURATED_NOTE = "saturated link"
"""What the note begins with of what has no bound because more is sent over a link than it carries; its name follows."""
REPLACED_WORDS = "may take the place of"
"""What such a note says of the messages of several sources in one memory."""
_CAUSE_WORDS = (*BOUNDLESS_WORDS, "diverged", UNLINKED_NOTE, NO_MATCH_NOTE, NO_USE_NOTE, SATURATED_NOTE)


def unknown_value(*missing: str) -> TimingValue:
    """Return the value of a figure that is unknown because these elements' figures are missing."""
    return TimingValue(None, complete=False, missing=missing)


def value_of_cause(cause: UnknownCause) -> TimingValue:
    """Return the value for a cause: complete (nothing to fill in) where only notes say why, else missing figures."""
    return TimingValue(None, complete=not cause.missing, missing=cause.missing, assumptions=cause.notes)


def add_values(values: Iterable[TimingValue]) -> TimingValue:
    """Return the sum; one unbounded term makes it unbounded.

    Unknown terms are left out, and make the sum a bound from below.
    """
    value_list = tuple(values)
    if len(value_list) == 1:
        return value_list[0]
    # Fast path: nearly all sums are of exact figures without assumptions, and need no merging of reasons.
    exact_terms: list[Fraction] = []
    for value in value_list:
        if value.value is None or value.assumptions or value.side != "exact":
            break
        exact_terms.append(value.value)
    else:
        return TimingValue(sum_fractions(exact_terms))
    combined = _combine_reasons(value_list)
    # An unbounded term outweighs the unknown ones, which stay named in `missing`.
    if any(value.value is None and (value.complete or is_boundless(value)) for value in value_list):
        return replace(combined, value=None, side="exact")
    known_terms = [value.value for value in value_list if value.value is not None]
    return replace(combined, value=sum_fractions(known_terms) if known_terms or not value_list else None)


def smallest_value(values: Iterable[TimingValue]) -> TimingValue:
    """Return the smallest of several bounds of which any one suffices.

    A complete bound counts even where others are unknown. A figure known only from below may turn out larger, so that
    it counts only where no complete bound is there.
    """
    value_list = tuple(values)
    bounds = [value for value in value_list if is_known_bound(value)]
    if bounds:
        return min(bounds, key=_figure_or_zero)
    unsure_values = tuple(value for value in value_list if not is_boundless(value))
    if not unsure_values:
        return next(iter(value_list), UNBOUNDED_VALUE)
    combined = _combine_reasons(unsure_values)
    if any(value.value is None for value in unsure_values):
        return replace(combined, value=None, side="exact")
    return replace(combined, value=min(map(_figure_or_zero, unsure_values)))


def largest_value(values: Iterable[TimingValue]) -> TimingValue:
    """Return the largest of several bounds, all of which are needed: one unknown makes the result unknown."""
    value_list = tuple(values)
    combined = _combine_reasons(value_list)
    if any(value.value is None for value in value_list):
        return replace(combined, value=None, side="exact")
    return replace(
        combined, value=max((value.value for value in value_list if value.value is not None), default=Fraction(0))
    )


def multiply_value(value: TimingValue, factor: Fraction | int) -> TimingValue:
    """Return the value times a factor, resting on the same assumptions."""
    if value.value is None or factor == 1:
        return value
    return replace_figure(value, value.value * factor)


def replace_figure(value: TimingValue, figure: Fraction) -> TimingValue:
    """Return another figure with the same completeness, missing elements, assumptions and side."""
    return TimingValue(figure, value.complete, value.missing, value.assumptions, value.side)


def sum_bounds(values: Iterable[TimingValue], side: Literal["at least", "at most"] = "at most") -> TimingValue:
    """Return the sum as a bound from the given side; stricter than `add_values`, which accepts terms of either side.

    Where a term has no bound from that side the sum is incomplete and holds what is known, as a bound from below. It is
    None where nothing but zeros is known, since zero says nothing. One boundless term makes the sum boundless.
    """
    value_list = tuple(values)
    missing = tuple(dict.fromkeys(element for value in value_list for element in value.missing))
    assumptions = tuple(dict.fromkeys(assumption for value in value_list for assumption in value.assumptions))
    if any(is_boundless(value) for value in value_list):
        return TimingValue(
            None, all(is_known_bound(value, side) or is_boundless(value) for value in value_list), missing, assumptions
        )
    known_sum = sum_fractions(value.value for value in value_list if value.value is not None)
    if all(is_known_bound(value, side) for value in value_list):
        is_exact = all(value.side == "exact" for value in value_list)
        return TimingValue(
            known_sum, complete=True, missing=missing, assumptions=assumptions, side="exact" if is_exact else side
        )
    # `or None`: a sum of zero would be printed as ">= 0 ms".
    return TimingValue(known_sum or None, complete=False, missing=missing, assumptions=assumptions, side="at least")


def is_known_bound(value: TimingValue, side: Literal["at least", "at most"] = "at most") -> bool:
    """Whether a figure is a bound from a side: complete, or incomplete on the harmless side."""
    return value.value is not None and (value.complete or value.side == side)


def is_boundless(value: TimingValue) -> bool:
    """Whether a figure grows beyond any bound, which is more than being unknown."""
    # An assumption may go on after a colon; only the word before it is compared.
    return value.value is None and any(
        assumption.split(":")[0].strip() in BOUNDLESS_WORDS for assumption in value.assumptions
    )


def list_assumptions(value: TimingValue) -> tuple[str, ...]:
    """Return what a figure rests on, without the words that only say why there is none."""
    return tuple(text for text in value.assumptions if text.split(":")[0].strip() not in _CAUSE_WORDS)


def is_unfound(value: TimingValue) -> bool:
    """Whether the search found no bound for a figure, or for a part of it; `missing` then names nobody for that part."""
    return not is_known_bound(value) and "diverged" in value.assumptions


def name_missing_element(value: TimingValue, element: str) -> TimingValue:
    """Return the value, with `element` as what is missing if it is unknown and names nothing itself."""
    # A search that found nothing had all figures of the element: nobody is to measure what is written.
    if is_known_bound(value) or value.missing or is_boundless(value) or is_unfound(value):
        return value
    return replace(value, complete=False, missing=(element,))


def _figure_or_zero(value: TimingValue) -> Fraction:
    return value.value or Fraction(0)


def _combine_reasons(values: tuple[TimingValue, ...]) -> TimingValue:
    cause = unite_causes(UnknownCause(value.missing, value.assumptions) for value in values)
    complete = all(value.complete for value in values)
    is_upper_bound = any(value.side == "at most" for value in values)
    side = "at least" if not complete else "at most" if is_upper_bound else "exact"
    return TimingValue(None, complete, cause.missing, cause.notes, side)  # type: ignore[arg-type]
