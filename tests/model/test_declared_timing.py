"""What is written of timing, as text."""

from __future__ import annotations

from fractions import Fraction

from archgen.model.declared_timing import ASSUMED_SLICE, FairScheduling, list_fair_figures


def test_the_figures_of_a_fair_order_that_are_written_are_listed() -> None:
    assert list_fair_figures(None) == list_fair_figures(FairScheduling()) == []
    fair = FairScheduling(slice=ASSUMED_SLICE, lead=3, other_load=Fraction(1, 8))
    assert list_fair_figures(fair) == [("slice", "3 ms"), ("lead", "3"), ("other_load", "12.5 %")]
