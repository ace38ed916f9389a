"""Three versions of a sequence, as words: each letter is an item."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from archgen.merge.tree_merge import MergedRun, merge_sequences


def merge(base: str, ours: str, theirs: str) -> str:
    """Merge words; conflicts stand as `<ours|base|theirs>`."""
    return "".join(
        "".join(run.items)
        if isinstance(run, MergedRun)
        else f"<{''.join(run.ours)}|{''.join(run.base)}|{''.join(run.theirs)}>"
        for run in merge_sequences(base, ours, theirs)
    )


@pytest.mark.parametrize(
    ("base", "ours", "theirs", "merged"),
    [
        ("", "", "", ""),
        ("abc", "abc", "abc", "abc"),
        ("abc", "axbc", "abyc", "axbyc"),
        ("abc", "ac", "abc", "ac"),
        ("abc", "abc", "", ""),
        ("abc", "axc", "ayc", "a<x|b|y>c"),
        ("abc", "axc", "axc", "axc"),
        ("abc", "abcx", "abcy", "abc<x||y>"),
        ("abc", "ac", "axc", "a<|b|x>c"),
        ("abcd", "bcd", "abc", "bc"),
        ("", "x", "y", "<x||y>"),
        ("ab", "xab", "aby", "xaby"),
    ],
)
def test_words_are_merged(base: str, ours: str, theirs: str, merged: str) -> None:
    assert merge(base, ours, theirs) == merged


WORDS = st.text("abc", max_size=8)


@given(WORDS, WORDS)
def test_what_one_side_left_alone_is_as_the_other_one_has_it(base: str, changed: str) -> None:
    assert merge(base, base, changed) == merge(base, changed, base) == merge(base, changed, changed) == changed
