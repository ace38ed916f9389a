"""What was seen of one figure: its samples counted in bounded memory, and the percentiles that people ask for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from fractions import Fraction

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, field, replace

PERCENTILES = {"p50": 50, "p90": 90, "p95": 95, "p99": 99}
"""The percentiles that are given, by the name that the language has for them."""
_EXACT_VALUES = 4096
"""So many different values are kept as they are; more are put together in steps."""
_STEP_BITS = 7
"""A step is at most 2^-7 of its value (0.8 %): 128 steps for each doubling, hence a few thousand for any recording."""


@dataclass(frozen=True, slots=True)
class SampleStatistics:
    """Samples of one figure, in ns. Count, least, largest and total are exact.

    A percentile is the least value that so many per cent of the samples do not exceed; where `is_stepped`, it is rounded
    up by at most 0.8 %.
    """

    count: int
    least: int
    largest: int
    total: int
    percentiles: Mapping[str, int]
    is_stepped: bool
    counts: tuple[tuple[int, int], ...] = field(default=(), repr=False)
    """How often each value was seen, the smallest first; steps where there were too many."""

    def find_percentile(self, share: Fraction) -> int:
        """Return the least value that a share of the samples does not exceed."""
        reached = 0
        for value, count in self.counts:
            reached += count
            if reached >= share * self.count:
                return min(value, self.largest)
        return self.largest


@dataclass(frozen=True, slots=True)
class UnmappedSamples:
    """How much was recorded of something that the design does not have, or that may be several things in it."""

    name: str
    count: int
    why: str
    at: Span


class SampleCounter:
    """Counts samples (whole ns) of one figure, of which a recording may have any number."""

    __slots__ = ("_counts", "_is_stepped", "_largest", "_least", "_total")

    def __init__(self) -> None:
        """Start without samples."""
        self._counts: Counter[int] = Counter()
        self._is_stepped = False
        self._least = self._largest = self._total = 0

    @property
    def count(self) -> int:
        """How many samples were counted."""
        return self._counts.total()

    def add_sample(self, value: int) -> None:
        """Count one sample, which is at least 0."""
        self._least = min(self._least, value) if self._counts else value
        self._largest = max(self._largest, value)
        self._total += value
        self._counts[_round_up(value) if self._is_stepped else value] += 1
        if not self._is_stepped and len(self._counts) > _EXACT_VALUES:
            self._put_in_steps()

    def add_samples(self, other: SampleCounter) -> None:
        """Count all samples of another counter as well."""
        if not other._counts:
            return
        self._least = min(self._least, other._least) if self._counts else other._least
        self._largest = max(self._largest, other._largest)
        self._total += other._total
        self._counts += other._counts
        if self._is_stepped or other._is_stepped or len(self._counts) > _EXACT_VALUES:
            self._put_in_steps()

    def summarise(self) -> SampleStatistics:
        """Return the statistics of what was counted, which must be one sample at least."""
        counts = tuple(sorted(self._counts.items()))
        known = SampleStatistics(
            self.count, self._least, self._largest, self._total, {}, is_stepped=self._is_stepped, counts=counts
        )
        percentiles = {name: known.find_percentile(Fraction(percent, 100)) for name, percent in PERCENTILES.items()}
        return replace(known, percentiles=percentiles)

    def _put_in_steps(self) -> None:
        self._is_stepped = True
        stepped_counts: Counter[int] = Counter()
        for value, count in self._counts.items():
            stepped_counts[_round_up(value)] += count
        self._counts = stepped_counts


def _round_up(value: int) -> int:
    """Return the largest value of the step that a value is in, so that no percentile comes out too small."""
    shift = max(0, value.bit_length() - _STEP_BITS - 1)
    return (value >> shift) + 1 << shift if shift and value & (1 << shift) - 1 else value
