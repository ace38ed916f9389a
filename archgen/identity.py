"""Which finding is which: by its rule, its element and the names in its message, never by where it stands.

Lines move, files are renamed and reordered, figures change with every measurement, titles and messages are reworded. A finding
is the same one as long as its rule, its element and what its message names in backticks are (the whole message, without
figures, where it names nothing); where several are alike, they are told apart by their number.
"""

from __future__ import annotations

import hashlib
import re
from collections import Counter, defaultdict, deque
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator, Sequence

    from archgen.diagnostic import Diagnostic
    from archgen.source import Span

_FIGURE = re.compile(r"(?<![\w.-])\d[\d.,]*(?!\w)")


class Identity(NamedTuple):
    """What makes a finding the same one wherever it stands. `about` is what is left of its message."""

    rule: str
    element: str
    about: str

    def fingerprint(self, number: int) -> str:
        """Give the hash of the finding with this identity that is the `number`th (from 1) of those alike."""
        text = "\0".join((*self, str(number)))
        return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]


class Known(NamedTuple):
    """A finding that was known before, as a baseline lists it: `times` alike, written at `at`."""

    rule: str
    element: str
    message: str
    times: int
    at: Span

    @property
    def identity(self) -> Identity:
        """Give what it is matched by."""
        return _identity(self.rule, self.element, self.message)


class Renames(Protocol):
    """Knows the ids that elements have now, by those that they had."""

    def words(self, text: str) -> str:
        """Put the ids of now into a text."""

    def ticked(self, text: str) -> str:
        """Put the ids of now into what stands between backticks."""


def identity(diagnostic: Diagnostic, renames: Renames | None = None) -> Identity:
    """Give a finding's identity, with the ids that elements have now where `renames` knows them."""
    element, message = diagnostic.element or "", diagnostic.message
    if renames is not None:
        element, message = renames.words(element), renames.ticked(message)
    return _identity(diagnostic.rule, element, message)


def numbered(diagnostics: Iterable[Diagnostic]) -> Iterator[tuple[Diagnostic, Identity, int]]:
    """Give each finding with its identity and its number (from 1) among those alike."""
    seen = Counter[Identity]()
    for diagnostic in diagnostics:
        found = identity(diagnostic)
        seen[found] += 1
        yield diagnostic, found, seen[found]


def partners(now: Sequence[Sequence[Hashable]], before: Sequence[Sequence[Hashable]]) -> tuple[int | None, ...]:
    """Match each of `now` with one of `before`; give the position of each one's partner, None for what has none.

    Each has its keys, the strictest first: what agrees in the first key is matched before anything else is.
    """
    found: list[int | None] = [None] * len(now)
    free = dict.fromkeys(range(len(before)))
    for level in range(len(now[0]) if now else 0):
        offers = defaultdict[object, deque[int]](deque)
        for place in free:
            offers[before[place][level]].append(place)
        for place, keys in enumerate(now):
            offer = offers.get(keys[level])
            if found[place] is None and offer:
                found[place] = partner = offer.popleft()
                del free[partner]
    return tuple(found)


def _identity(rule: str, element: str, message: str) -> Identity:
    return Identity(rule, _storable(element), _about(_storable(message)))


def _storable(text: str) -> str:
    """Give text as a file gives it back: lone surrogates cannot stand in one."""
    return text.encode("utf-8", "replace").decode("utf-8")


def _about(message: str) -> str:
    """Give what a message names, else its words without what changes and leaves the fault the same: figures, blanks."""
    names = message.split("`")[1::2]
    text = "`".join(names) if any(names) else _FIGURE.sub("0", message)
    return " ".join(text.split())
