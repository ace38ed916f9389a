"""Threads of one core by falling priority, with what the first of them demand together."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from fractions import Fraction
from itertools import accumulate
from math import lcm

from archgen.timing.figures.timing_values import UnknownCause, unite_causes
from archgen.timing.load.busy_windows import (
    DemandFunction,
    GrowingLoad,
    SearchBudget,
    longest_busy_period,
)
from archgen.timing.load.thread_work import (
    ThreadWork,
)


class RankedThreads:
    """Threads by falling priority, and what the first of them demand together.

    Any count may be asked for at any time. Growing counts are cheap, since each builds on the one before; a smaller one
    begins anew.
    """

    def __init__(self, threads: Iterable[ThreadWork]) -> None:
        """Rank the threads; those without a priority are left out."""
        self.threads = sorted((t for t in threads if t.highest_priority is not None), key=_rank_key)
        pairs = [thread.share.as_integer_ratio() for thread in self.threads]
        self._common_denominator = lcm(*[denominator for _, denominator in pairs])
        self._cumulated_shares = tuple(
            accumulate(
                (numerator * (self._common_denominator // own_denominator) for numerator, own_denominator in pairs),
                initial=0,
            )
        )
        self._load, self._loaded_count = GrowingLoad(), 0
        self._busy_period, self._searched_count = 0, 0
        self._cause: UnknownCause | None = None
        self._cause_count = 0

    def count_down_to(self, priority: int) -> int:
        """Return how many threads may have this priority or a higher one."""
        return bisect_right(self.threads, -priority, key=_rank_key)

    def share_of_first(self, count: int) -> Fraction:
        """Return the share of a core that the first threads take."""
        return Fraction(self._cumulated_shares[count], self._common_denominator)

    def cause_of_first(self, count: int) -> UnknownCause | None:
        """Return what is missing of the first threads, None where nothing is."""
        if count < self._cause_count:
            self._cause, self._cause_count = None, 0
        new_causes = [thread.cause for thread in self.threads[self._cause_count : count] if thread.cause]
        if new_causes:
            self._cause = unite_causes((*filter(None, (self._cause,)), *new_causes))
        self._cause_count = count
        return self._cause

    def demand_of_first(self, count: int) -> DemandFunction:
        """Return the demand of the first threads; it is good until another count is asked for."""
        if count < self._loaded_count:
            self._load, self._loaded_count = GrowingLoad(), 0
        for thread in self.threads[self._loaded_count : count]:
            self._load.add_work(thread.works)
        self._loaded_count = count
        return self._load.demand_function()

    def busy_period_of_first(self, count: int, budget: SearchBudget) -> int:
        """Return the busy period of the first threads; that of fewer is a lower bound, where the search begins."""
        if count != self._searched_count:
            lower_bound = self._busy_period if self._searched_count < count else 0
            self._busy_period = longest_busy_period(self.demand_of_first(count), budget, lower_bound)
            # Only now: a search that ended with `DivergedError` has found nothing for this count.
            self._searched_count = count
        return self._busy_period


def _rank_key(thread: ThreadWork) -> int:
    """Sort key: threads by falling greatest priority."""
    return -(thread.highest_priority or 0)
