"""Quantities with three significant digits."""

from __future__ import annotations

import pytest

from archgen.views.short_figures import shorten_text, split_figures, write_comparisons


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("7223.333 ms", "7.23 s"),
        (">= 32.098 s of 60 s", ">= 32 s of 60 s"),
        ("<= 10.004 Hz", "<= 10.1 Hz"),
        ("1234 Hz and 2500 B", "1234 Hz and 2500 B"),
        ("up to 7000.4 ms, after 7000.1 ms", "up to 7000.4 ms, after 7000.1 ms"),
        ("223.333 ms of 7223.333 ms", "224 ms of 7.23 s"),
        ("version 2.1 of 10.0.0.1 ms", "version 2.1 of 10.0.0.1 ms"),
    ],
)
def test_bounds_stay_true_and_what_differs_stays_apart(text: str, shown: str) -> None:
    assert "".join(short or part for part, short in split_figures(text)) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("104.667 ms", "105 ms"),
        ("104.2 ms", "105 ms"),
        ("<= 1234.56 ms", "<= 1.24 s"),
        (">= 1234.56 ms", ">= 1.23 s"),
        ("at most 8.1 s", "at most 8.1 s"),
        ("not proven (0.012345 s)", "not proven (0.0124 s)"),
        ("not proven", "not proven"),
        ("took ~104.2 ms", "took ~104 ms"),
    ],
)
def test_upper_bounds_are_rounded_up(text: str, shown: str) -> None:
    assert shorten_text(text) == shown


def test_what_is_at_least_so_much_is_rounded_down() -> None:
    assert split_figures("124.9999 ms", is_lower=True) == [("", ""), ("124.9999 ms", "124 ms"), ("", "")]
    # What was seen, and by how much that is too long: the margin beside it says `seen +1.82 s`.
    run = "In a run it took 1832.4 ms, 1827.4 ms longer than its deadline of 5 ms allows"
    assert shorten_text(run) == "In a run it took 1.83 s, 1.82 s longer than its deadline of 5 ms allows"
    assert shorten_text(run.replace("took", "may take")) == run.replace("took", "may take").replace(
        "1832.4 ms, 1827.4 ms", "1.84 s, 1.83 s"
    )


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("<= 15 Hz, at least >= 2 ms", "≤ 15 Hz, at least ≥ 2 ms"),
        ("<=\u00a095\u00a0%", "≤ 95\u00a0%"),
        ("<= +24.2 ms", "≤ +24.2 ms"),
        ("a <= b", "a <= b"),
        ("x<=5", "x<=5"),
    ],
)
def test_signs_before_figures_are_real_ones(text: str, shown: str) -> None:
    assert write_comparisons(text) == shown


def test_pictures_show_short_figures() -> None:
    assert shorten_text("0.24 Hz · 4166.667 ms") == "0.24 Hz · 4.17 s"
