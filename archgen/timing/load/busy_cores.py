"""How long threads can keep several cores busy: each works on one core at a time."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeVar

_Amount = TypeVar("_Amount", int, Fraction)


def divide_among_cores(lane_works: Sequence[int], pending_work: int, core_count: int) -> int:
    """Return the longest time for which threads can keep all cores busy, rounded up."""
    # The plain quotient is the answer where no thread has more work than it.
    quotient = -(-(sum(lane_works) + pending_work) // core_count)
    if not lane_works or max(lane_works) <= quotient:
        return quotient
    numerator, denominator = find_blocked_time(lane_works, pending_work, core_count)
    return -(-numerator // denominator)


def find_blocked_time(lane_works: Sequence[_Amount], pending_work: _Amount, core_count: int) -> tuple[_Amount, int]:
    """Return the longest time B for which threads can keep all cores busy, as numerator and denominator.

    m B = pending work + sum of min(work, B): no thread works longer than that time.
    """
    rest = sum(lane_works, start=pending_work)
    # A whole sort: of a few dozen numbers it takes less than a tenth of `heapq.nlargest`.
    largest_works = sorted(lane_works, reverse=True)[: core_count - 1]
    # The k threads with the most work are busy all the time: what is left fills the other m - k cores.
    for busy_count, work in enumerate(largest_works):
        if work * (core_count - busy_count) <= rest:
            return rest, core_count - busy_count
        rest -= work
    return rest, core_count - len(largest_works)
