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
from typing import TYPE_CHECKING, Protocol

from archgen.diagnostics.text_columns import replace_surrogates
from archgen.frozen import NamedTuple

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator, Sequence

    from archgen.diagnostics.diagnostic import Diagnostic
    from archgen.diagnostics.source_span import Span

# A number, but not a digit within a name or path (`node_2`, `v1.2`) or before a letter.
_FIGURE_PATTERN = re.compile(r"(?<![\w.-])\d[\d.,]*(?!\w)")


class FindingIdentity(NamedTuple):
    """What identifies a finding in different versions of a project. `subject` is what remains of its message."""

    rule: str
    element: str
    subject: str

    def fingerprint(self, number: int) -> str:
        """Return a hash (32 hex digits) of this identity and the finding's number (from 1) among those that have it.

        SARIF's fingerprints are made of it: another hash here makes every alert a new one.
        """
        text = "\0".join((*self, str(number)))
        return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]


class BaselineEntry(NamedTuple):
    """A known finding as a baseline lists it: `occurrences` of it are known, and `span` is the entry's place."""

    rule: str
    element: str
    message: str
    occurrences: int
    span: Span

    @property
    def identity(self) -> FindingIdentity:
        """The identity that findings are matched with."""
        return _make_identity(self.rule, self.element, self.message)


class IdRenamer(Protocol):
    """Replaces the old ids of renamed elements by their new ones. `compare` implements it."""

    def rename_in_text(self, text: str) -> str:
        """Replace old ids anywhere in a text by the new ones."""

    def rename_in_backticks(self, text: str) -> str:
        """Replace old ids between backticks by the new ones."""


def identify_finding(diagnostic: Diagnostic, renamer: IdRenamer | None = None) -> FindingIdentity:
    """Return the identity of a finding; with `renamer`, as if its elements had their new ids already."""
    element, message = diagnostic.element or "", diagnostic.message
    if renamer is not None:
        element, message = renamer.rename_in_text(element), renamer.rename_in_backticks(message)
    return _make_identity(diagnostic.rule, element, message)


def number_findings(diagnostics: Iterable[Diagnostic]) -> Iterator[tuple[Diagnostic, FindingIdentity, int]]:
    """Yield each finding with its identity and its number (from 1) among the findings with the same identity."""
    identity_counts = Counter[FindingIdentity]()
    for diagnostic in diagnostics:
        finding_identity = identify_finding(diagnostic)
        identity_counts[finding_identity] += 1
        yield diagnostic, finding_identity, identity_counts[finding_identity]


def match_findings(
    new_keys: Sequence[Sequence[Hashable]], old_keys: Sequence[Sequence[Hashable]]
) -> tuple[int | None, ...]:
    """Match new findings with old ones, and return the index of the old one for each new one, None without a match.

    Each finding is given by its keys, from the strictest to the loosest, and all have the same number of keys. All
    matches by a stricter key are made before any by a looser one, so that of several similar findings the one that
    moved least is taken as the same.
    """
    partner_indices: list[int | None] = [None] * len(new_keys)
    # A dictionary as an ordered set: among equal keys the first old finding is matched first.
    free_indices = dict.fromkeys(range(len(old_keys)))
    for level in range(len(new_keys[0]) if new_keys else 0):
        indices_by_key = defaultdict[object, deque[int]](deque)
        for index in free_indices:
            indices_by_key[old_keys[index][level]].append(index)
        for index, keys in enumerate(new_keys):
            candidate_indices = indices_by_key.get(keys[level])
            if partner_indices[index] is None and candidate_indices:
                partner_indices[index] = old_index = candidate_indices.popleft()
                del free_indices[old_index]
    return tuple(partner_indices)


def _make_identity(rule: str, element: str, message: str) -> FindingIdentity:
    # Otherwise the identity of a new finding would differ from that of the same finding in a baseline.
    return FindingIdentity(rule, replace_surrogates(element), _message_subject(replace_surrogates(message)))


def _message_subject(message: str) -> str:
    """Return the names between backticks in a message; without any, the message with each figure replaced by 0."""
    # Every second part is between backticks. The others are dropped, so that a rule's message may be reworded.
    names = message.split("`")[1::2]
    text = "`".join(names) if any(names) else _FIGURE_PATTERN.sub("0", message)
    return " ".join(text.split())
