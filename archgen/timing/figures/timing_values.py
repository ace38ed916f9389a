"""Figures that say what they rest on: exact, a bound from one side, or unknown and why; and how responses are found."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import lcm
from typing import Literal

from archgen.frozen import NamedTuple, dataclass


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
