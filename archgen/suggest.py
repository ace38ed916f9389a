"""One guess at what a mistyped word meant: fold case and separators first, then edit distance."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


_LONGEST = 200
"""Characters of the longest name there can be (a type's). Comparing longer words takes time and finds nothing."""


def closest(word: str, candidates: Iterable[str]) -> str | None:
    """Give the candidate that `word` most likely stands for, or None where none is near enough.

    Near enough is one slip for every three letters. Ties go to the alphabetically first, so that the answer never
    depends on order.
    """
    names = sorted(set(candidates))
    folded = _fold(word)
    for name in names:
        if _fold(name) == folded:
            return name
    if len(word) > _LONGEST:
        return None
    limit = max(1, len(word) // 3)
    best: tuple[int, str] | None = None
    for name in names:
        if abs(len(name) - len(word)) > limit:
            continue
        distance = _distance(word, name, limit)
        if distance <= limit and (best is None or distance < best[0]):
            best = (distance, name)
    return best[1] if best else None


def did_you_mean(word: str, candidates: Iterable[str]) -> str | None:
    """Phrase the guess as a help line, or None where there is no guess."""
    name = closest(word, candidates)
    return f"did you mean `{name}`?" if name is not None and name != word else None


def _fold(word: str) -> str:
    return word.casefold().replace("-", "").replace("_", "").replace(" ", "")


def _distance(a: str, b: str, limit: int) -> int:
    """Count the slips between two words (Damerau-Levenshtein with adjacent swaps), giving up above `limit`."""
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        older, before, row = before, row, [i] + [0] * len(b)
        for j, y in enumerate(b, 1):
            row[j] = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                row[j] = min(row[j], older[j - 2] + 1)
        if min(row) > limit:
            return limit + 1
    return row[-1]
