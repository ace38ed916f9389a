"""Figures as people write them: which unit, how many decimals, when `~`."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.figures.figure_wording import (
    describe_timing_value,
    format_compared,
    format_duration,
    format_number,
    format_rate,
    format_share,
    format_size,
    name_unknown_reason,
)
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue


@pytest.mark.parametrize(
    ("ns", "text"),
    [
        (0, "0 ms"),
        (1, "1 ns"),
        (999, "999 ns"),
        (1000, "1 us"),
        (1500, "1.5 us"),
        (999_999, "999.999 us"),
        (10**6, "1 ms"),
        (10**9, "1000 ms"),
        (10**10 - 10**6, "9999 ms"),
        (10**10, "10 s"),
        (90 * 10**9, "90 s"),
        (-2 * 10**6, "-2 ms"),
        (-5, "-5 ns"),
        (Fraction(1, 2), "0.5 ns"),
        (Fraction(10**9, 30), "~33.333 ms"),
    ],
)
def test_a_duration_has_the_unit_in_which_it_is_short(ns: Fraction | int, text: str) -> None:
    assert format_duration(Fraction(ns)) == text


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0, "0"),
        (5, "5"),
        (Fraction(5, 4), "1.25"),
        (Fraction(-5, 4), "-1.25"),
        (Fraction(1, 3), "~0.333"),
        (Fraction(2, 3), "~0.667"),
        (Fraction(1, 10), "0.1"),
        (Fraction(1, 100), "0.01"),
        (Fraction(12_345, 100_000), "~0.123"),  # 123 thousandths are three digits that count
        (Fraction(98_765, 1_000_000), "~0.0988"),  # 98 are only two, so there is a fourth decimal
        (Fraction(42_345, 10**8), "~0.000423"),
        (Fraction(1, 10**11), "0.00000000001"),
        (Fraction(1, 10**12), "0.000000000001"),
        (Fraction(15, 10**13), "~0.000000000002"),  # twelve decimals at most
        (Fraction(1, 10**15), "~1e-15"),
        (Fraction(-3, 10**15), "~-3e-15"),
        (Fraction(100_001, 1_000_000), "~0.1"),
    ],
)
def test_a_number_has_three_decimals_or_three_digits(number: Fraction | int, text: str) -> None:
    assert format_number(Fraction(number)) == text


@pytest.mark.parametrize(
    ("byte_count", "text"),
    [
        (0, "0 B"),
        (999, "999 B"),
        (1000, "1 kB"),
        (999_999, "999.999 kB"),
        (10**6, "1 MB"),
        (25 * 10**8, "2.5 GB"),
        (10**9, "1 GB"),
    ],
)
def test_a_size_counts_in_thousands(byte_count: int, text: str) -> None:
    assert format_size(Fraction(byte_count)) == text


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0, "0 %"),
        (1, "100 %"),
        (Fraction(1, 3), "33.3 %"),
        (Fraction(1, 2000), "0.05 %"),
        (Fraction(3, 2000), "0.2 %"),
        (Fraction(1, 10**5), "0.001 %"),
    ],
)
def test_a_share_has_tenths_of_a_per_cent_and_more_where_it_is_small(share: Fraction | int, text: str) -> None:
    assert format_share(Fraction(share)) == text


def test_a_rate_is_in_hertz() -> None:
    assert format_rate(Fraction(15, 2)) == "7.5 Hz"


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (TimingValue(Fraction(1)), ""),
        (TimingValue(Fraction(1), assumptions=("overload",)), ""),
        (UNKNOWN_VALUE, "unknown"),
        (TimingValue(None, assumptions=("overload",)), "overload"),
        (TimingValue(None, assumptions=("a guess", "unbounded: for ever")), "unbounded"),
        (TimingValue(None, assumptions=("diverged",)), "no bound found"),
        (TimingValue(None, assumptions=("diverged", "overload")), "overload"),
        (TimingValue(None, assumptions=("something else",)), "unknown"),
    ],
)
def test_why_a_figure_is_unknown_is_one_word(value: TimingValue, reason: str) -> None:
    assert name_unknown_reason(value) == reason


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (TimingValue(Fraction(50)), "Hz", "50 Hz"),
        (TimingValue(Fraction(50)), "ns", "50 ns"),
        (TimingValue(Fraction(50), complete=False, side="at least"), "Hz", "at least 50 Hz"),
        (TimingValue(Fraction(50), side="at most"), "Hz", "at most 50 Hz"),
        (UNKNOWN_VALUE, "Hz", "unknown"),
        (TimingValue(None, assumptions=("unbounded", "more")), "Hz", "unbounded"),
        (TimingValue(None), "Hz", "unknown"),
        (TimingValue(None, complete=False, assumptions=("a ring",)), "Hz", "unknown"),
    ],
)
def test_a_figure_is_told_with_its_side(value: TimingValue, unit: str, text: str) -> None:
    assert describe_timing_value(value, unit) == text


@pytest.mark.parametrize(
    ("values", "limit", "upwards", "texts"),
    [
        ([651_367_000], None, True, ["~652 ms"]),
        ([651_367_000], None, False, ["~651 ms"]),
        ([120_000_000, 175_000_000], 130_000_000, True, ["120 ms", "175 ms"]),
        ([651_367_000, 651_900_000], None, True, ["~651.4 ms", "651.9 ms"]),  # as many as tell them apart
        ([16_650_000], 16_667_000, True, ["16.65 ms"]),  # what is kept does not look broken
        ([130_010_000], 130_000_000, True, ["~131 ms"]),
        ([1_234_567_000_000], None, True, ["~1240 s"]),
        ([0], None, True, ["0 ms"]),
    ],
)
def test_compared_figures_have_the_digits_that_inputs_carry(
    values: list[int], limit: int | None, *, upwards: bool, texts: list[str]
) -> None:
    figures = [Fraction(value) for value in values]
    edge = None if limit is None else Fraction(limit)
    assert format_compared(figures, format_duration, upwards=upwards, limit=edge) == texts
