"""Wording that all rooms share: lists of words, changes, shares in percent, and short hashes of commits."""

from __future__ import annotations

from collections.abc import Sequence

_SHORT_HASH_LENGTH = 7
"""As many digits as git prints where they suffice."""


def join_words(words: Sequence[str], conjunction: str = "and") -> str:
    """Join words as a sentence does: "a, b and c"; empty for none."""
    return f" {conjunction} ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else "".join(words)


def shorten_hash(commit: str) -> str:
    """Return the first digits of a commit's hash, enough for people to tell commits apart."""
    return commit[:_SHORT_HASH_LENGTH]


def floor_percent(count: int, total: int) -> int:
    """Return a share in percent, rounded down so that 100 % means all."""
    return 100 * count // total


def format_transition(old_text: str, new_text: str) -> str:
    """Format what changed in a terminal: "old -> new", or one text where both are the same."""
    return old_text if old_text == new_text else f"{old_text} -> {new_text}"
