"""The words in which two texts differ."""

from __future__ import annotations

import pytest

from archgen.compare.text_differences import cut_text, describe_text_difference

LONG = "one two three four five six seven eight nine ten"


@pytest.mark.parametrize(
    ("before", "after", "difference"),
    [
        ("a b", "a c", "`a b` → `a c`"),
        (LONG, LONG.replace("six", "6"), "`… two three four five six seven eight nine ten` → `… two three four five 6 seven eight nine ten`"),
        (LONG, LONG.replace("six", "6").replace("eight", "8"), "`… two three four five six seven eight nine ten` → `… two three four five 6 seven 8 nine ten`"),
        (LONG, f"{LONG} eleven", "`… seven eight nine ten` → `… seven eight nine ten eleven`"),
        (f"zero {LONG}", LONG, "`zero one two three four …` → `one two three four …`"),
        (LONG.replace("ten", "a b c d e"), LONG.replace("one", "1").replace("ten", "a b c d f"), "`one two three four five …` → `1 two three four five …`, `… a b c d e` → `… a b c d f`"),
        ("a `b`", "a `c`", "`a 'b'` → `a 'c'`"),
        ("a\nb", "a b", ""),
        ("x" * 90, "y", f"`{'x' * 60}…` → `y`"),
    ],
)  # fmt: skip
def test_differences(before: str, after: str, difference: str) -> None:
    assert describe_text_difference(before, after) == difference


def test_long_texts_are_cut_and_many_places_are_counted() -> None:
    assert cut_text(f"{'word ' * 30}") == f"{'word ' * 24}…"
    words = [f"w{number}" for number in range(60)]
    other_words = [f"x{number}" if number % 12 == 0 else word for number, word in enumerate(words)]
    assert describe_text_difference(" ".join(words), " ".join(other_words)).endswith(", and 2 more places")
    many = " ".join(f"w{number}" for number in range(700))
    assert describe_text_difference(many, many.replace("w9 ", "x9 ").replace("w650", "x650")).count("→") == 1
