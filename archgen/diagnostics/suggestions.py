"""Guess what a mistyped word means: the same word but for case and separators, else the one with the fewest slips."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


_MAX_WORD_LENGTH = 200
"""The length of the longest possible name (a type's) in characters. Comparing longer words only takes time."""


def find_closest(word: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that `word` most likely means, or None if none is similar enough.

    One slip is allowed for every three letters, and at least one. Of equally good candidates the alphabetically first
    one wins, so that the answer does not depend on their order.
    """
    names = sorted(set(candidates))
    folded_word = _fold_word(word)
    for name in names:
        if _fold_word(name) == folded_word:
            return name
    if len(word) > _MAX_WORD_LENGTH:
        return None
    limit = max(1, len(word) // 3)
    best_match: tuple[int, str] | None = None
    for name in names:
        if abs(len(name) - len(word)) > limit:
            continue  # the difference of lengths is a lower bound of the distance, and much cheaper
        distance = _edit_distance(word, name, limit)
        if distance <= limit and (best_match is None or distance < best_match[0]):
            best_match = (distance, name)
    return best_match[1] if best_match else None


def did_you_mean(word: str, candidates: Iterable[str]) -> str | None:
    """Return a help line with the closest candidate, or None if there is none, or none but the word itself."""
    name = find_closest(word, candidates)
    return f"did you mean `{name}`?" if name is not None and name != word else None


def _fold_word(word: str) -> str:
    return word.casefold().replace("-", "").replace("_", "").replace(" ", "")


def _edit_distance(first: str, second: str, limit: int) -> int:
    """Count the slips between two words; above `limit` return `limit + 1`.

    This is the optimal string alignment distance: Levenshtein's, where a swap of adjacent letters counts as one slip.
    """
    # Three rows of the table of distances between prefixes are kept: a swap looks back two of them.
    previous_row: list[int] = []
    row = list(range(len(second) + 1))
    for i, x in enumerate(first, 1):
        row_before_previous, previous_row, row = previous_row, row, [i] + [0] * len(second)
        for j, y in enumerate(second, 1):
            row[j] = min(previous_row[j] + 1, row[j - 1] + 1, previous_row[j - 1] + (x != y))
            if i > 1 and j > 1 and x == second[j - 2] and first[i - 2] == y:
                row[j] = min(row[j], row_before_previous[j - 2] + 1)
        # No row can be below its predecessor's minimum, except by a swap, which builds on the row before that one. That
        # row's minimum is at least `limit` here (it is at most 1 less than this one's), and the swap adds 1.
        if min(row) > limit:
            return limit + 1
    return row[-1]
