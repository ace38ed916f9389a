"""Whether a figure keeps a limit: the figure, the limit, what is known."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.chains.chain_verdicts import LimitState, find_worst_state, judge_lower_limit, judge_upper_limit
from archgen.timing.figures.timing_values import UNBOUNDED_VALUE, UNKNOWN_VALUE, TimingValue, unknown_value

AT_LEAST, AT_MOST = (
    TimingValue(Fraction(10), complete=False, missing=("x",), side="at least"),
    TimingValue(Fraction(10), side="at most"),
)


@pytest.mark.parametrize(
    ("bound", "limit", "state"),
    [
        (TimingValue(Fraction(10)), 10, "kept"),
        (TimingValue(Fraction(10)), 9, "broken"),
        (AT_MOST, 10, "kept"),
        (AT_LEAST, 10, "unknown"),
        (AT_LEAST, 9, "broken"),  # what is known is too much already
        (unknown_value("x"), 9, "unknown"),
        (UNKNOWN_VALUE, 9, "unknown"),
        (UNBOUNDED_VALUE, 9, "broken"),
        (TimingValue(None, assumptions=("diverged",)), 9, "broken"),
        (TimingValue(None, complete=False, missing=("x",), assumptions=("diverged",)), 9, "unknown"),
    ],
)
def test_a_duration_is_held_against_a_limit(bound: TimingValue, limit: int, state: LimitState) -> None:
    assert judge_upper_limit(bound, Fraction(limit)) == state


@pytest.mark.parametrize(
    ("rate", "limit", "state"),
    [
        (TimingValue(Fraction(10)), 10, "kept"),
        (TimingValue(Fraction(10)), 11, "broken"),
        (AT_MOST, 10, "unknown"),
        (AT_MOST, 11, "broken"),
        (AT_LEAST, 10, "kept"),
        (AT_LEAST, 11, "unknown"),
        (UNKNOWN_VALUE, 1, "unknown"),
        (TimingValue(Fraction(10), complete=False), 1, "unknown"),
    ],
)
def test_a_rate_is_held_against_a_limit(rate: TimingValue, limit: int, state: LimitState) -> None:
    assert judge_lower_limit(rate, Fraction(limit)) == state


def test_one_figure_that_breaks_a_limit_is_enough() -> None:
    assert find_worst_state(["kept", "unknown", "broken"]) == "broken"
    assert find_worst_state(["kept", "unknown"]) == "unknown"
    assert find_worst_state(["kept"]) == find_worst_state([]) == "kept"
