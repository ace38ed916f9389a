"""Percentiles of samples: exact while there are few values, a little too large beyond that, never too small."""

from __future__ import annotations

import random

import pytest

from archgen.timing.chains.sample_statistics import PERCENTILES, SampleCounter


def _count(*values: int) -> SampleCounter:
    counter = SampleCounter()
    for value in values:
        counter.add_sample(value)
    return counter


def _rank(values: list[int], percent: int) -> int:
    """Return the least value that so many per cent of all do not exceed."""
    return sorted(values)[-(-percent * len(values) // 100) - 1]


@pytest.mark.parametrize("count", [1, 2, 10, 99, 100, 101, 4000])
def test_percentiles_of_few_values_are_exact(count: int) -> None:
    values = [random.Random(count).randrange(10**8) for _ in range(count)]  # noqa: S311 - no secret
    statistics = _count(*values).summarise()
    assert statistics.percentiles == {name: _rank(values, percent) for name, percent in PERCENTILES.items()}
    assert (statistics.count, statistics.least, statistics.largest, statistics.total, statistics.is_stepped) == (
        count,
        min(values),
        max(values),
        sum(values),
        False,
    )


def test_of_a_hundred_values_each_percentile_is_that_of_its_name() -> None:
    assert _count(*range(1, 101)).summarise().percentiles == {"p50": 50, "p90": 90, "p95": 95, "p99": 99}


@pytest.mark.parametrize("scale", [10**4, 10**7, 10**12])
def test_percentiles_of_many_values_are_at_most_a_step_too_large(scale: int) -> None:
    values = [random.Random(7 * n).randrange(scale) for n in range(20_000)]  # noqa: S311 - no secret
    counter = _count(*values)
    statistics = counter.summarise()
    assert statistics.is_stepped
    for name, percent in PERCENTILES.items():
        exact = _rank(values, percent)
        assert exact <= statistics.percentiles[name] <= exact * 1.008
    assert (statistics.least, statistics.largest, statistics.total) == (min(values), max(values), sum(values))
    # Whatever comes, the room that it takes is bounded.
    assert len(counter._counts) < 128 * 41  # noqa: SLF001 - what is bounded


def test_samples_of_two_recordings_count_together() -> None:
    first, second = _count(5, 9), _count(3)
    first.add_samples(second)
    first.add_samples(SampleCounter())
    statistics = first.summarise()
    assert (statistics.count, statistics.least, statistics.largest, statistics.percentiles["p50"]) == (3, 3, 9, 5)
    empty = SampleCounter()
    empty.add_samples(second)
    assert empty.summarise().least == 3


def test_a_step_is_at_its_upper_end() -> None:
    counter = _count(*range(1, 5000))
    assert counter.summarise().percentiles["p50"] == 2512  # 2500, in steps of 2^11 / 2^7 = 16
    counter.add_sample(1_000_001)
    assert counter.summarise().largest == 1_000_001


def test_small_values_are_exact_whatever_comes_beside_them() -> None:
    """Below 256 each value is a step of its own: half of the samples are 3."""
    counter = _count(*range(1_000, 6_000))
    for _ in range(5_001):
        counter.add_sample(3)
    statistics = counter.summarise()
    assert (statistics.is_stepped, statistics.least, statistics.percentiles["p50"]) == (True, 3, 3)
