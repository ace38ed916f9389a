"""What a mistyped word means."""

from __future__ import annotations

import random

import pytest

from archgen.diagnostics import suggestions
from archgen.diagnostics.suggestions import did_you_mean, find_closest


@pytest.mark.parametrize(
    ("word", "candidates", "closest"),
    [
        ("imgae", ["image", "range"], "image"),  # a swap is one slip
        ("image", ["imagee"], "imagee"),
        ("Camera-Front", ["camera_front", "camera_rear"], "camera_front"),
        ("lidr", ["lidar"], "lidar"),
        ("abc", ["xyz"], None),
        ("abc", ["abxy"], None),  # two slips in three letters
        ("abcdef", ["abcdxy"], "abcdxy"),  # two slips in six
        ("a", ["b"], "b"),  # one slip is always allowed
        ("ab", [], None),
        ("cat", ["rat", "bat"], "bat"),  # equally close: the first by the alphabet
        ("cat", ["bat", "rat"], "bat"),
    ],
)
def test_the_closest_candidate_wins_within_one_slip_for_three_letters(
    word: str, candidates: list[str], closest: str | None
) -> None:
    assert find_closest(word, candidates) == closest


def test_words_longer_than_any_name_are_only_compared_as_a_whole() -> None:
    long = "a" * 201
    assert find_closest(long, [f"{long}b"]) is None
    assert find_closest(long.upper(), [long]) == long
    assert find_closest("a" * 200, ["a" * 199]) == "a" * 199


@pytest.mark.parametrize(
    ("word", "line"),
    [("imgae", "did you mean `image`?"), ("image", None), ("screen", None), ("IMAGE", "did you mean `image`?")],
)
def test_a_help_line_never_proposes_the_word_itself(word: str, line: str | None) -> None:
    assert did_you_mean(word, ["image"]) == line


def test_looking_at_the_letters_first_changes_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    draw = random.Random(7)  # noqa: S311 - drawn anew each time would fail anew
    words = ["".join(draw.choices("abc_", k=draw.randint(1, 9))) for _ in range(400)]
    cases = [(word, draw.choices(words, k=draw.randint(0, 4))) for word in words]
    answers = [find_closest(*case) for case in cases]
    monkeypatch.setattr(suggestions, "_FEW_NAMES", -1)
    assert [find_closest(*case) for case in cases] == answers
    assert len(set(answers)) > 20
