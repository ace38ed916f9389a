"""Promises and deprecations in words, and when a last day is over."""

from __future__ import annotations

import pytest

from archgen.model.promise import (
    Deprecation,
    Promise,
    describe_deprecation,
    format_limit,
    format_range,
)
from archgen.model.quantity import parse_quantity

NO_LIMIT = float("inf")


@pytest.mark.parametrize(
    ("until", "day", "is_past"),
    [
        ("2027-03-01", "2027-03-01", False),
        ("2027-03-01", "2027-03-02", True),
        ("2027-03-01", "2026-12-31", False),
        ("2027-03-01", None, False),
        (None, "2027-03-02", False),
    ],
)
def test_the_last_day_itself_is_not_over(until: str | None, day: str | None, is_past: bool) -> None:  # noqa: FBT001 - a case
    assert Deprecation(until).is_past(day) is is_past


@pytest.mark.parametrize(
    ("limits", "unit", "words"),
    [
        ((0, 30), "m", "0 to 30 m"),
        ((0.0, 1.5), None, "0 to 1.5"),
        ((-NO_LIMIT, NO_LIMIT), None, "no lower limit to no limit"),
        ((1e-7, 1e20), "m", "1e-07 to 1e+20 m"),
    ],
)
def test_ranges_in_words(limits: tuple[float, float], unit: str | None, words: str) -> None:
    assert format_range(limits, unit) == words


def test_what_is_kept_is_listed_in_the_order_of_the_keys() -> None:
    rate = parse_quantity("10 Hz", "frequency")
    assert dict(Promise(range=(0, 1), rate=rate).list_kept()) == {"rate": rate, "range": (0, 1)}
    assert format_limit(5.0) == "5"


def test_deprecations_in_words() -> None:
    assert describe_deprecation(Deprecation()) == "no day named"
    assert describe_deprecation(Deprecation("2027-03-01", "rows")) == "until 2027-03-01, use rows instead"
