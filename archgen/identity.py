"""The identity of findings across versions: rule, element and the names in the message, never file or line.

Lines move, files are renamed, figures change with every measurement, messages are reworded. A finding is the same one
as long as its rule, its element and what its message names in backticks are the same (the whole message without
figures, if it names nothing). Findings with the same identity are numbered. docs/decisions/0005-known-findings.md has
the rejected ways: the whole message fails with every figure that changes, the element alone cannot tell one output from
another.
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

# A number, but not a digit within a name or path (`node_2`, `v1.2`) or before a letter.
_FIGURE = re.compile(r"(?<![\w.-])\d[\d.,]*(?!\w)")


class Identity(NamedTuple):
    """What identifies a finding in different versions of a project. `subject` is what remains of its message."""

    rule: str
    element: str
    about: str

    def fingerprint(self, number: int) -> str:
        """Return a hash (32 hex digits) of this identity and the finding's number (from 1) among those that have it.

        SARIF's fingerprints are made of it: another hash here makes every alert a new one.
        """
        text = "\0".join((*self, str(number)))
        return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]


class Known(NamedTuple):
    """A known finding as a baseline lists it: `occurrences` of it are known, and `span` is the entry's place."""

    rule: str
    element: str
    message: str
    times: int
    at: Span

    @property
    def identity(self) -> Identity:
        """The identity that findings are matched with."""
        return _identity(self.rule, self.element, self.message)


class Renames(Protocol):
    """Replaces the old ids of renamed elements by their new ones. `compare` implements it."""

    def words(self, text: str) -> str:
        """Replace old ids anywhere in a text by the new ones."""

    def ticked(self, text: str) -> str:
        """Replace old ids between backticks by the new ones."""


def identity(diagnostic: Diagnostic, renames: Renames | None = None) -> Identity:
    """Return the identity of a finding; with `renamer`, as if its elements had their new ids already."""
    element, message = diagnostic.element or "", diagnostic.message
    if renames is not None:
        element, message = renames.words(element), renames.ticked(message)
    return _identity(diagnostic.rule, element, message)


def numbered(diagnostics: Iterable[Diagnostic]) -> Iterator[tuple[Diagnostic, Identity, int]]:
    """Yield each finding with its identity and its number (from 1) among the findings with the same identity."""
    seen = Counter[Identity]()
    for diagnostic in diagnostics:
        found = identity(diagnostic)
        seen[found] += 1
        yield diagnostic, found, seen[found]


def partners(now: Sequence[Sequence[Hashable]], before: Sequence[Sequence[Hashable]]) -> tuple[int | None, ...]:
    """Match new findings with old ones, and return the index of the old one for each new one, None without a match.

    Each finding is given by its keys, from the strictest to the loosest, and all have the same number of keys. All
    matches by a stricter key are made before any by a looser one, so that of several similar findings the one that
    moved least is taken as the same.
    """
    found: list[int | None] = [None] * len(now)
    # A dictionary as an ordered set: among equal keys the first old finding is matched first.
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
    """Return a text as it comes back from a UTF-8 file: lone surrogates are replaced by question marks.

    Otherwise the identity of a new finding would differ from that of the same finding in a baseline.
    """
    return text.encode("utf-8", "replace").decode("utf-8")


def _about(message: str) -> str:
    """Return the names between backticks in a message; without any, the message with each figure replaced by 0."""
    # Every second part is between backticks. The others are dropped, so that a rule's message may be reworded.
    names = message.split("`")[1::2]
    text = "`".join(names) if any(names) else _FIGURE.sub("0", message)
    return " ".join(text.split())
