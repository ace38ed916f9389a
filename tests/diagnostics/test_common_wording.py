"""Wording that all rooms share."""

from __future__ import annotations

import pytest

from archgen.diagnostics.common_wording import (
    fit_lines,
    floor_percent,
    format_transition,
    join_first,
    join_words,
    keep_first,
    shorten_hash,
)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [((), ""), (("a",), "a"), (("a", "b"), "a and b"), (("a", "b", "c"), "a, b and c")],
)
def test_words_are_joined_as_in_a_sentence(words: tuple[str, ...], sentence: str) -> None:
    assert join_words(words) == sentence
    assert join_words(words, "or") == sentence.replace("and", "or")


def test_a_short_hash_has_seven_digits() -> None:
    assert shorten_hash("0123456789abcdef") == "0123456"
    assert not shorten_hash("")


def test_a_hundred_percent_means_all() -> None:
    assert [floor_percent(count, 1000) for count in (0, 9, 10, 999, 1000)] == [0, 0, 1, 99, 100]


def test_what_did_not_change_is_written_once() -> None:
    assert format_transition("late", "late") == "late"
    assert format_transition("late", "met") == "late -> met"


def test_the_first_six_names_are_written_and_the_others_counted() -> None:
    assert join_first(("a",)) == "a"
    assert join_first(tuple("abcdef")) == "a, b, c, d, e, f"
    assert join_first(tuple("abcdefgh")) == "a, b, c, d, e, f and 2 more"
    assert join_first(("a", "b"), 1) == "a and 1 more"


def test_the_first_items_are_kept_and_the_others_counted() -> None:
    assert keep_first(["a", "b"], 2) == ["a", "b"]
    assert keep_first(["a", "b", "c"], 2) == ["a", "b", "1 more"]
    assert keep_first(["a", "b", "c"], 1, "and {} more such effects") == ["a", "and 2 more such effects"]


def test_lines_fit_a_limit_with_the_count_of_the_others() -> None:
    assert fit_lines(["a", "b"], 2) == ["a", "b"]
    assert fit_lines(["a", "b", "c"], 2) == ["a", "and 2 more"]
