"""Guess what a mistyped word means: the same word but for case and separators, else the one with the fewest slips."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


NAMES_HELP = "`archgen list` gives the names of all elements"
"""What to do about a name that nothing has, and that resembles none."""
_MAX_WORD_LENGTH = 200
"""The length of the longest possible name (a type's) in characters. Comparing longer words only takes time."""
_FEW_NAMES = 20
"""So many names are looked at by their letters first: where none can be meant, nothing needs to be loaded."""


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
    most_slips = max(1, len(word) // 3)
    if len(names) <= _FEW_NAMES and not any(_may_be_near(word, name, most_slips) for name in names):
        return None
    # Imported here: it takes as long as a tenth of a check, and a project without a slip needs no guess. It is a hundred
    # times as fast as the same in Python, which took 2 ms for two words of 58 letters: minutes for a hostile project.
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    # Optimal string alignment: Levenshtein's distance, where a swap of adjacent letters counts as one slip, too. The
    # first of several equally good names is returned, and they are sorted.
    best_match = process.extractOne(word, names, scorer=OSA.distance, score_cutoff=most_slips)
    return best_match[0] if best_match else None


def _may_be_near(word: str, name: str, most_slips: int) -> bool:
    """Whether so few slips can make a word of a name: each one adds a letter, takes one away, or does both."""
    letters, other_letters = Counter(word), Counter(name)
    return max((letters - other_letters).total(), (other_letters - letters).total()) <= most_slips


def count_slips(word: str, name: str) -> int:
    """Return how many slips make `word` of `name`: 0 where only case and separators differ."""
    if _fold_word(word) == _fold_word(name):
        return 0
    if max(len(word), len(name)) > _MAX_WORD_LENGTH:
        return _MAX_WORD_LENGTH
    from rapidfuzz.distance import OSA

    return OSA.distance(word, name)


def did_you_mean(word: str, candidates: Iterable[str]) -> str | None:
    """Return a help line with the closest candidate, or None if there is none, or none but the word itself."""
    name = find_closest(word, candidates)
    return f"did you mean `{name}`?" if name is not None and name != word else None


_MIN_ABBREVIATION = 4
"""The length of the shortest word, in letters, that is taken for the beginning of a longer one."""


def did_you_shorten(word: str, candidates: Iterable[str]) -> str | None:
    """Return a help line with the one candidate that a word begins: `prio` is more slips away from `priority` than a slip."""
    if len(word) < _MIN_ABBREVIATION:
        return None
    longer_names = [name for name in candidates if _fold_word(name).startswith(_fold_word(word))]
    return f"did you mean `{longer_names[0]}`?" if len(longer_names) == 1 else None


@lru_cache(maxsize=50_000)  # each name is compared with many words
def _fold_word(word: str) -> str:
    return word.casefold().replace("-", "").replace("_", "").replace(" ", "")
