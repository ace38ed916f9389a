"""Exact sums over a common denominator, and the causes of unknown figures."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.figures.timing_values import (
    TimingValue,
    UnknownCause,
    is_same_cause,
    sum_fractions,
    sum_ratios,
    unite_causes,
)


@pytest.mark.parametrize(
    "terms",
    ["", "1/3", "1/3 1/6", "1/3 1/6 1/2", "1/7 2/7 3/7", "1/2 1/3 1/5 1/7 1/2"],
)
def test_sums_are_those_of_fractions(terms: str) -> None:
    fractions = [Fraction(term) for term in terms.split()]
    assert sum_fractions(fractions) == sum(fractions, Fraction(0))


def test_ratios_of_one_denominator_keep_it() -> None:
    assert sum_ratios([(1, 6), (2, 6)]) == (3, 6)
    assert sum_ratios([(1, 6), (1, 4)]) == (5, 12)
    assert sum_ratios([]) == (0, 1)


def test_a_figure_is_complete_and_exact_unless_it_says_otherwise() -> None:
    value = TimingValue(Fraction(1))
    assert (value.complete, value.missing, value.assumptions, value.side) == (True, (), (), "exact")


def test_causes_are_named_once_in_order() -> None:
    causes = [UnknownCause(("b", "a"), ("late",)), UnknownCause(("a", "c"), ("late", "overload"))]
    assert unite_causes(causes) == (("b", "a", "c"), ("late", "overload"))


def test_no_more_than_twelve_elements_are_named() -> None:
    names = tuple("abcdefghijklm")
    assert unite_causes([UnknownCause(names[:12])]) == (names[:12], ())
    cut = unite_causes([UnknownCause(names, ("late",))])
    assert cut == (names[:12], ("late", "more figures are missing"))


def test_causes_are_the_same_in_any_order() -> None:
    assert is_same_cause(UnknownCause(("a", "b"), ("x", "y")), UnknownCause(("b", "a"), ("y", "x")))
    assert not is_same_cause(UnknownCause(("a",)), UnknownCause(("b",)))
    assert not is_same_cause(UnknownCause(("a",), ("x",)), UnknownCause(("a",)))
    twelve, others = tuple("abcdefghijkl"), tuple("bcdefghijklm")
    assert is_same_cause(UnknownCause(twelve), UnknownCause(others))
    assert not is_same_cause(UnknownCause(twelve[:11]), UnknownCause(others[:11]))
    assert not is_same_cause(UnknownCause(twelve, ("x",)), UnknownCause(others))
    assert not is_same_cause(UnknownCause(twelve), UnknownCause(others[:11]))
