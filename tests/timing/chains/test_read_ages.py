"""Whether what is read is as fresh as its reader demands."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.timing.chains.chain_verdicts import ReadAge
from archgen.timing.figures.timing_values import TimingValue

ARC: Any = SimpleNamespace()


@pytest.mark.parametrize(
    ("age", "state"),
    [
        (TimingValue(Fraction(10)), "kept"),
        (TimingValue(Fraction(9)), "kept"),
        (TimingValue(Fraction(11)), "broken"),
        # What is known of it is too much already, or is not yet.
        (TimingValue(Fraction(11), complete=False, missing=("a",)), "broken"),
        (TimingValue(Fraction(9), complete=False, missing=("a",)), "unknown"),
        (TimingValue(None, complete=False, missing=("a",)), "unknown"),
        # It has no bound at all, or none was found with all figures known.
        (TimingValue(None, assumptions=("unbounded",)), "broken"),
        (TimingValue(None, complete=False, assumptions=("diverged",)), "broken"),
        (TimingValue(None, complete=False, missing=("a",), assumptions=("diverged",)), "unknown"),
    ],
)
def test_nothing_older_than_the_limit_is_read(age: TimingValue, state: str) -> None:
    assert ReadAge(ARC, age, Fraction(10)).state == state
