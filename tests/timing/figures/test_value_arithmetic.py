"""Sums, minima and maxima of figures of which some are unknown."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction

import pytest

from archgen.timing.figures.timing_values import (
    UNBOUNDED_VALUE,
    UNKNOWN_VALUE,
    TimingValue,
    UnknownCause,
    add_values,
    is_boundless,
    is_known_bound,
    largest_value,
    multiply_value,
    name_missing_element,
    replace_figure,
    smallest_value,
    sum_bounds,
    unknown_value,
    value_of_cause,
)
from tests.timing.printed import show


def _exact(number: int, *assumptions: str) -> TimingValue:
    return TimingValue(Fraction(number), assumptions=assumptions)


TWO, THREE, ZERO = _exact(2), _exact(3), _exact(0)
ASSUMED = _exact(5, "a guess")
AT_LEAST = TimingValue(Fraction(7), complete=False, missing=("x",), side="at least")
AT_MOST = TimingValue(Fraction(4), side="at most")
OPEN_AT_MOST = TimingValue(Fraction(4), complete=False, missing=("z",), side="at most")
GONE = unknown_value("y")
OVERLOAD = TimingValue(None, assumptions=("overload",))
HALF_BOUNDLESS = TimingValue(None, complete=False, missing=("w",), assumptions=("unbounded: for ever",))
DIVERGED = TimingValue(None, assumptions=("diverged",))

Function = Callable[[Iterable[TimingValue]], TimingValue]


def _sum_from_below(values: Iterable[TimingValue]) -> TimingValue:
    return sum_bounds(values, "at least")


@pytest.mark.parametrize(
    ("function", "values", "expected"),
    [
        (add_values, (), "0"),
        (add_values, (GONE,), "none ?y"),
        (add_values, (TWO, THREE), "5"),
        (add_values, (TWO, THREE, THREE), "8"),
        (add_values, (TWO, ASSUMED), "7 [a guess]"),
        (add_values, (TWO, AT_MOST), "<= 6"),
        (add_values, (TWO, AT_LEAST), ">= 9 ?x"),
        (add_values, (AT_MOST, AT_LEAST), ">= 11 ?x"),
        (add_values, (TWO, GONE), ">= 2 ?y"),
        (add_values, (GONE, UNKNOWN_VALUE), ">= none ?y"),
        (add_values, (TWO, UNBOUNDED_VALUE), "none [unbounded]"),
        (add_values, (GONE, OVERLOAD, ASSUMED), "none ?y [overload; a guess]"),
        (add_values, (TWO, HALF_BOUNDLESS), "none ?w [unbounded: for ever]"),
        (add_values, (TWO, DIVERGED), "none [diverged]"),
        (smallest_value, (), "none [unbounded]"),
        (smallest_value, (THREE, TWO, ASSUMED), "2"),
        (smallest_value, (THREE, GONE), "3"),
        (smallest_value, (THREE, ZERO), "0"),
        (smallest_value, (ASSUMED, AT_MOST), "<= 4"),
        (smallest_value, (ASSUMED, OPEN_AT_MOST), "<= 4 ?z"),
        (smallest_value, (AT_LEAST, _exact(9)), "9"),
        (smallest_value, (AT_LEAST, OVERLOAD), ">= 7 ?x"),
        (smallest_value, (AT_LEAST, replace_figure(AT_LEAST, Fraction(3))), ">= 3 ?x"),
        (smallest_value, (AT_LEAST, GONE), "none ?x,y"),
        (smallest_value, (OVERLOAD, UNBOUNDED_VALUE), "none [overload]"),
        (largest_value, (), "0"),
        (largest_value, (TWO, THREE, ASSUMED), "5 [a guess]"),
        (largest_value, (TWO, AT_MOST), "<= 4"),
        (largest_value, (TWO, AT_LEAST), ">= 7 ?x"),
        (largest_value, (TWO, GONE), "none ?y"),
        (largest_value, (TWO, OVERLOAD), "none [overload]"),
        (sum_bounds, (), "0"),
        (sum_bounds, (TWO, THREE), "5"),
        (sum_bounds, (TWO, ASSUMED, ASSUMED), "12 [a guess]"),
        (sum_bounds, (TWO, AT_MOST), "<= 6"),
        (sum_bounds, (TWO, OPEN_AT_MOST), "<= 6 ?z"),
        (sum_bounds, (TWO, AT_LEAST), ">= 9 ?x"),
        (sum_bounds, (TWO, GONE, GONE), ">= 2 ?y"),
        (sum_bounds, (ZERO, GONE), ">= none ?y"),
        (sum_bounds, (TWO, OVERLOAD), "none [overload]"),
        (sum_bounds, (TWO, GONE, OVERLOAD), "none ?y [overload]"),
        (sum_bounds, (OPEN_AT_MOST, OVERLOAD), "none ?z [overload]"),
        (sum_bounds, (TWO, DIVERGED), ">= 2 ? [diverged]"),
        (_sum_from_below, (TWO, AT_LEAST), ">= 9 ?x"),
        (_sum_from_below, (TWO, OPEN_AT_MOST), ">= 6 ?z"),
    ],
)
def test_what_is_known_counts_and_what_is_missing_stays_named(
    function: Function, values: tuple[TimingValue, ...], expected: str
) -> None:
    assert show(function(values)) == expected


def test_a_bound_from_the_wanted_side_is_complete() -> None:
    assert sum_bounds((TWO, AT_LEAST), "at least").complete
    assert not sum_bounds((TWO, AT_LEAST)).complete
    assert not sum_bounds((GONE, OVERLOAD)).complete
    assert sum_bounds((OPEN_AT_MOST, OVERLOAD)).complete
    assert sum_bounds((TWO, OVERLOAD)).complete
    assert largest_value((TWO, GONE)).side == "exact"
    assert not largest_value((TWO, GONE)).complete


@pytest.mark.parametrize(
    ("value", "from_above", "from_below", "boundless"),
    [
        (TWO, True, True, False),
        (AT_LEAST, False, True, False),
        (OPEN_AT_MOST, True, False, False),
        (GONE, False, False, False),
        (OVERLOAD, False, False, True),
        (HALF_BOUNDLESS, False, False, True),
        (DIVERGED, False, False, False),
        (_exact(1, "overload"), True, True, False),
    ],
)
def test_a_figure_bounds_from_one_side_or_both(
    value: TimingValue,
    from_above: object,
    from_below: object,
    boundless: object,
) -> None:
    assert (is_known_bound(value), is_known_bound(value, "at least")) == (from_above, from_below)
    assert is_boundless(value) is boundless


def test_a_factor_leaves_what_a_figure_rests_on() -> None:
    assert show(multiply_value(AT_LEAST, 3)) == ">= 21 ?x"
    assert show(multiply_value(ASSUMED, Fraction(1, 2))) == "5/2 [a guess]"
    assert multiply_value(ASSUMED, 1) is ASSUMED
    assert multiply_value(GONE, 3) is GONE
    assert show(multiply_value(TWO, 0)) == "0"


def test_a_cause_without_missing_figures_is_complete() -> None:
    assert value_of_cause(UnknownCause(("a",), ("overload",))) == TimingValue(
        None, complete=False, missing=("a",), assumptions=("overload",)
    )
    assert value_of_cause(UnknownCause((), ("overload",))) == OVERLOAD


def test_an_element_is_named_where_a_figure_names_nothing() -> None:
    assert show(name_missing_element(UNKNOWN_VALUE, "a")) == "none ?a"
    assert not name_missing_element(TimingValue(None), "a").complete
    assert name_missing_element(DIVERGED, "a") is DIVERGED  # all of its figures were there
    for value in (TWO, GONE, OVERLOAD, AT_LEAST, OPEN_AT_MOST):
        assert name_missing_element(value, "a") is value


def test_the_smallest_may_be_nothing() -> None:
    """Of bounds 0 is less than 1/2; of figures that may be larger the least is all that is known."""
    bounds = (TimingValue(Fraction(1, 2)), TimingValue(Fraction(0)))
    assert smallest_value(bounds).value == smallest_value(bounds[::-1]).value == 0
    unsure = tuple(TimingValue(Fraction(figure), complete=False, side="at least") for figure in (5, 0))
    assert smallest_value(unsure).value == 0
