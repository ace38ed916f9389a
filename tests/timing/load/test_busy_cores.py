"""How long threads keep several cores busy: m B = pending work + sum of min(work, B)."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import pytest

from archgen.timing.load.busy_windows import divide_among_cores, find_blocked_time


@pytest.mark.parametrize(
    ("works", "pending", "cores", "time"),
    [
        ([2, 2], 0, 2, 2),
        ([7, 2], 0, 2, 2),  # one core is free as soon as the other thread has done its 2
        ([100, 100, 100], 0, 4, 0),  # three threads never keep four cores busy
        ([100, 100, 100], 20, 4, 20),  # what is pending may be any thread's
        ([3, 4, 5], 0, 3, 3),
        ([5, 5, 5, 5], 1, 3, 7),
        ([], 0, 2, 0),
        ([], 3, 2, 2),
    ],
)
def test_no_thread_works_on_two_cores(works: list[int], pending: int, cores: int, time: int) -> None:
    assert divide_among_cores(works, pending, cores) == time


def test_the_blocked_time_is_the_longest_that_the_work_allows() -> None:
    for works in product((0, 1, 4, 9), repeat=4):
        for cores, pending in product((2, 3, 4), (0, 3)):
            numerator, denominator = find_blocked_time(works, pending, cores)
            time = Fraction(numerator, denominator)
            assert cores * time == pending + sum(min(Fraction(work), time) for work in works)
            longer = time + Fraction(1, 7)
            assert cores * longer > pending + sum(min(Fraction(work), longer) for work in works)
