"""Find where a text first mentions the terms of the glossary, so that reports and sites can lead there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache

from archgen.frozen import NamedTuple
from archgen.views.shapes import split_anchor

TERM_KIND = "term"
"""Begins the anchors of terms."""


class TermMention(NamedTuple):
    """A place in a text, and the anchor of the term that it mentions."""

    start: int
    end: int
    anchor: str


class MentionFinder:
    """Finds terms in the parts of one text, in their order: of each term only the first mention counts."""

    def __init__(self, pattern: re.Pattern[str], anchors: tuple[str, ...]) -> None:
        """Take a pattern with a group for each anchor."""
        self._pattern = pattern
        self._anchors = anchors
        self._seen_anchors: set[str] = set()

    def find_mentions(self, text: str) -> Iterator[TermMention]:
        """Yield the first mentions in the next part of the text."""
        for match in self._pattern.finditer(text):
            anchor = self._anchors[(match.lastindex or 1) - 1]
            if anchor not in self._seen_anchors:
                self._seen_anchors.add(anchor)
                yield TermMention(match.start(), match.end(), anchor)


def begin_text(anchors: Iterable[str]) -> MentionFinder | None:
    """Return a finder for one text, of the terms among all anchors of a document; None where there is no term."""
    term_anchors = tuple(anchor for anchor in anchors if split_anchor(anchor)[0] == TERM_KIND)
    if not term_anchors:
        return None
    # The longest first: `fallen object` is not `object`.
    sorted_anchors = tuple(sorted(term_anchors, key=lambda anchor: (-len(anchor), anchor)))
    return MentionFinder(_compile_terms(sorted_anchors), sorted_anchors)


@lru_cache(4)
def _compile_terms(anchors: tuple[str, ...]) -> re.Pattern[str]:
    terms = "|".join(f"({_write_pattern(split_anchor(anchor)[1])})" for anchor in anchors)
    return re.compile(rf"(?<!\w)(?:{terms})(?!\w)")


def _write_pattern(term: str) -> str:
    """Return the pattern of a term: any blanks between its words, and a first letter of any case where it has no capital behind."""
    first, rest = term[:1], r"\s+".join(map(re.escape, term[1:].split(" ")))
    if term[1:] != term[1:].lower():
        return re.escape(first) + rest
    cases = sorted({first.lower(), first.upper(), first})
    return f"(?:{'|'.join(map(re.escape, cases))}){rest}"
