"""Whether what is read is as fresh as its reader demands."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.timing.chains.read_ages import ReadAge
from archgen.timing.figures.timing_values import TimingValue

ARC: Any = SimpleNamespace()


@pytest.mark.parametrize(
    ("age", "is_kept"),
    [
        (TimingValue(Fraction(10)), True),
        (TimingValue(Fraction(9)), True),
        (TimingValue(Fraction(11)), False),
        # What is known of it is too much already, or is not yet.
        (TimingValue(Fraction(11), complete=False, missing=("a",)), False),
        (TimingValue(Fraction(9), complete=False, missing=("a",)), None),
        (TimingValue(None, complete=False, missing=("a",)), None),
        # It has no bound at all, or none was found with all figures known.
        (TimingValue(None, assumptions=("unbounded",)), False),
        (TimingValue(None, complete=False, assumptions=("diverged",)), False),
        (TimingValue(None, complete=False, missing=("a",), assumptions=("diverged",)), None),
    ],
)
def test_nothing_older_than_the_limit_is_read(age: TimingValue, is_kept: bool | None) -> None:  # noqa: FBT001
    assert ReadAge(ARC, age, Fraction(10)).is_kept is is_kept
