"""What reasons of losses are made of: names in backticks, verbs for one and for several."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.compare.key_phrases import shorten_text
from archgen.compare.sentence_words import tick_names

_MAX_NAMES = 4
"""Maximal number of elements named in one sentence; the rest is counted."""


def tick_name(name: object) -> str:
    """Return a name in backticks, whatever it contains."""
    return f"`{shorten_text(str(name))}`"


def tick_sorted_names(names: Iterable[str]) -> str:
    """Return sorted names in backticks, joined for a sentence: `a`, `b` and `c`; the surplus is counted."""
    return tick_names(sorted(names), _MAX_NAMES)


def decline_verb(verb: str, *, plural: bool) -> str:
    """Return a verb for one or for several."""
    if not plural:
        return verb
    return "are" if verb == "is" else verb.removesuffix("s")
