"""Figures that say what they rest on: exact, a bound from one side, or unknown and why; and how responses are found.

Sums, minima and maxima of such figures: what is known adds up, and what is missing stays named.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import lcm
from typing import Literal

from archgen.frozen import NamedTuple, dataclass, replace


@dataclass(frozen=True, slots=True)
class TimingValue:
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


ResponseTier = Literal[
    "declared",
    "dedicated",
    "host",
    "fair",
    "non_preemptive",
    "fifo",
    "ros2_executor",
    "edf",
    "priorities",
    "executor",
    "cores",
    "whole host",
    "whole way",
    "unknown",
]
"""How a response time was found (docs/timing.md, "Response times"): `declared`; `dedicated`, assuming a core
of its own; `host`, any work-conserving scheduler of one core; `priorities`, fixed ones; `fair`, threads that Linux
shares the cores among; `executor`, single-threaded; `cores`, several; `whole host`, several taken as one; `whole way`,
over hosts and links; the words of an order (`non_preemptive`, `fifo`,
`edf`, `ros2_executor`): one thread or core that keeps to it.
"""
UNKNOWN_VALUE = TimingValue(None, complete=False)
ZERO_VALUE = TimingValue(Fraction(0))
MAX_NAMED_MISSING = 12


def sum_fractions(fractions: Iterable[Fraction]) -> Fraction:
    """Return the sum of fractions over one common denominator."""
    # Reducing each partial sum to lowest terms, as Fraction.__add__ does, took most of the time of a whole analysis.
    terms = list(fractions)
    if 0 < len(terms) <= 2:  # noqa: PLR2004 - two terms need no grouping
        return terms[0] if len(terms) == 1 else terms[0] + terms[1]
    return Fraction(*sum_ratios([term.as_integer_ratio() for term in terms]))


def sum_ratios(ratios: Iterable[tuple[int, int]]) -> tuple[int, int]:
    """Return the sum of (numerator, denominator) pairs as such a pair, not in lowest terms."""
    # Terms of equal denominator first: in practice there are few distinct periods, so the lcm below stays small.
    numerators: dict[int, int] = {}
    for numerator, denominator in ratios:
        numerators[denominator] = numerators.get(denominator, 0) + numerator
    if len(numerators) == 1:
        return next((numerator, denominator) for denominator, numerator in numerators.items())
    common_denominator = lcm(*numerators)
    return sum(
        [numerator * (common_denominator // denominator) for denominator, numerator in numerators.items()]
    ), common_denominator


class UnknownCause(NamedTuple):
    """Why there is no figure: the elements whose figures are missing, or a word for it (such as `overload`)."""

    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def unite_causes(causes: Iterable[UnknownCause]) -> UnknownCause:
    """Merge causes, keeping the order of first mention.

    At most `MAX_NAMED_MISSING` elements are named: more would only grow along a chain.
    """
    cause_list = tuple(causes)
    missing = tuple(dict.fromkeys(element for cause in cause_list for element in cause.missing))
    notes = tuple(dict.fromkeys(note for cause in cause_list for note in cause.notes))
    if len(missing) > MAX_NAMED_MISSING:
        missing, notes = missing[:MAX_NAMED_MISSING], tuple(dict.fromkeys((*notes, "more figures are missing")))
    return UnknownCause(missing, notes)


def is_same_cause(first: UnknownCause, second: UnknownCause) -> bool:
    """Whether two causes name the same elements and notes, in any order."""
    # Compared as sets: the fixed point in event_propagation asks this round a loop, where the order of names rotates
    # for ever. Two causes that are both cut at the cap count as equal, since which dozen survives rotates as well.
    if set(first.notes) != set(second.notes):
        return False
    return set(first.missing) == set(second.missing) or len(first.missing) == len(second.missing) == MAX_NAMED_MISSING


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
