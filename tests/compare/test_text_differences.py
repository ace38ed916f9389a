"""The words in which two texts differ."""

from __future__ import annotations

import pytest

from archgen.compare.text_meaning import cut_text, describe_text_difference

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


def _number_words(count: int, *changed: int) -> str:
    return " ".join(f"{'x' if number in changed else 'w'}{number}" for number in range(count))


@pytest.mark.parametrize(
    ("count", "changed", "difference"),
    [
        # Six hundred words are compared word by word, more of them from both ends alone.
        (600, (9, 590), ["`… w5 w6 w7 w8 w9 w10 w11 w12 w13 …` → `… w5 w6 w7 w8 x9 w10 w11 w12 w13 …`", "`… w586 w587 w588 w589 w590 w591 w592 w593 w594 …` → `… w586 w587 w588 w589 x590 w591 w592 w593 w594 …`"]),
        (601, (300,), ["`… w296 w297 w298 w299 w300 w301 w302 w303 w304 …` → `… w296 w297 w298 w299 x300 w301 w302 w303 w304 …`"]),
        (601, (300, 302), ["`… w296 w297 w298 w299 w300 w301 w302 w303 w304 w305 w306 …` → `… w296 w297 w298 w299 x300 w301 x302 w303 w304 w305 w306 …`"]),
    ],
)  # fmt: skip
def test_long_texts_show_what_is_between_the_ends_that_are_alike(
    count: int, changed: tuple[int, ...], difference: list[str]
) -> None:
    assert describe_text_difference(_number_words(count), _number_words(count, *changed)) == ", ".join(difference)


@pytest.mark.parametrize(
    ("changed", "rest"),
    [((5, 15, 25), ""), ((5, 15, 25, 35), ", and 1 more place"), ((5, 15, 25, 35, 45), ", and 2 more places")],
)
def test_three_places_are_quoted_and_the_others_counted(changed: tuple[int, ...], rest: str) -> None:
    told = describe_text_difference(_number_words(50), _number_words(50, *changed))
    assert (told.count("→"), told.rpartition("`")[2]) == (3, rest)


@pytest.mark.parametrize(("length", "quoted"), [(60, "x" * 60), (61, f"{'x' * 60}…")])
def test_sixty_letters_of_a_word_are_quoted(length: int, quoted: str) -> None:
    assert describe_text_difference("x" * length, "y") == f"`{quoted}` → `y`"


@pytest.mark.parametrize(("count", "is_cut"), [(24, False), (25, True)])
def test_twenty_four_words_are_quoted(count: int, is_cut: bool) -> None:  # noqa: FBT001
    assert cut_text("word " * count).endswith("…") == is_cut
