"""Which search entries some words find, the best first: names before keys, keys before texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.views.search.search_entry import SearchEntry

_QUESTION_WORDS = (
    "a an and are at by does do for from give gives has have how i in into is it my of on or read reads send sends run runs "
    "takes the to use uses what when where which who whom whose why with"
)
QUESTION_WORDS = tuple(_QUESTION_WORDS.split())
"""Left out where other words stand beside them, on the site and here: "who reads the odometry" asks for the odometry."""
_NO_MATCH = 6
"""Behind an id or title as it is, its end, its beginning, a part of it, a key, and a text."""


def rank_entries(entries: Iterable[SearchEntry], words: Sequence[str]) -> list[SearchEntry]:
    """Return the entries in which each word that asks for something stands, in any case of letters, the best first."""
    said = [word.casefold() for word in words if word.strip()]
    folded = [word for word in said if word not in QUESTION_WORDS] or said
    ranked = []
    for number, entry in enumerate(entries):
        ranks = [_rank(entry, word) for word in folded]
        if ranks and max(ranks) < _NO_MATCH:
            ranked.append((sum(ranks), number, entry))
    return [entry for *_, entry in sorted(ranked, key=lambda each: each[:2])]


def _rank(entry: SearchEntry, word: str) -> int:
    name, title = entry.name.casefold(), entry.title.casefold()
    if word in {name, title}:
        return 0
    if name.endswith((f".{word}", f"/{word}")):
        return 1
    if any(part.startswith(word) for part in (*title.split(), name.rpartition(".")[2])):
        return 2
    if word in name or word in title:
        return 3
    if any(word in key.casefold() for key in entry.keys):
        return 4
    return 5 if word in entry.line.casefold() or word in entry.text.casefold() else _NO_MATCH
