"""Wording that all rooms share: lists of words, changes, shares in percent, and short hashes of commits."""

from __future__ import annotations

from collections.abc import Sequence

_SHORT_HASH_LENGTH = 7
"""As many digits as git prints where they suffice."""


def join_words(words: Sequence[str], conjunction: str = "and") -> str:
    """Join words as a sentence does: "a, b and c"; empty for none."""
    return f" {conjunction} ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else "".join(words)


def keep_first(items: Sequence[str], count: int, rest: str = "{} more") -> list[str]:
    """Return the first items and, where there are others, how many these are."""
    return [*items[:count], *([rest.format(len(items) - count)] if len(items) > count else [])]


def fit_lines(lines: Sequence[str], limit: int, rest: str = "and {} more") -> list[str]:
    """Return no more lines than a limit: where there are more, the last one counts those that are left out."""
    return [*lines] if len(lines) <= limit else keep_first(lines, limit - 1, rest)


def join_first(names: Sequence[str], limit: int = 6) -> str:
    """Write the first names separated by commas, and count the others."""
    return ", ".join(names[:limit]) + (f" and {len(names) - limit} more" if len(names) > limit else "")


def shorten_hash(commit: str) -> str:
    """Return the first digits of a commit's hash, enough for people to tell commits apart."""
    return commit[:_SHORT_HASH_LENGTH]


def floor_percent(count: int, total: int) -> int:
    """Return a share in percent, rounded down so that 100 % means all."""
    return 100 * count // total


def format_transition(old_text: str, new_text: str) -> str:
    """Format what changed in a terminal: "old -> new", or one text where both are the same."""
    return old_text if old_text == new_text else f"{old_text} -> {new_text}"
