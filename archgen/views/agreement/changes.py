"""What an agreement gained, lost and changed since an earlier revision, term by term.

A comparison of its own beside `archgen.compare`: it knows nothing of matched ids.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from archgen.views.agreement.interfaces import Interface
from archgen.views.agreement.terms import Terms

SIGNS = {"added": "+ added", "removed": "\u2212 removed", "changed": "~ changed"}
"""A sign and a word for each kind of change, so that nothing depends on colour."""
_SORTS = {"end": "who gives and takes", "field": "fields", "chain": "chains", "requirement": "requirements"}
Plain = Mapping[str, tuple[str, str]]
Key = tuple[str, tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Held:
    """An interface of one revision with its terms as plain text."""

    terms: Terms
    plain: Plain

    @property
    def key(self) -> Key:
        """Return what identifies an interface: what flows, and between whom."""
        return self.terms.interface.key, self.terms.interface.pair


@dataclass(frozen=True, slots=True)
class Change:
    """A term that was added (`before` is None), removed (`after` is None) or changed."""

    key: str
    name: str
    before: str | None
    after: str | None

    @property
    def sort(self) -> str:
        """Return the kind of the term in a word or two."""
        return _SORTS.get(self.key.partition(" ")[0]) or (
            self.name if self.name.startswith("QoS") else self.name.lower()
        )

    @property
    def kind(self) -> Literal["added", "removed", "changed"]:
        """Return what happened to the term."""
        return "added" if self.before is None else "removed" if self.after is None else "changed"


@dataclass(frozen=True, slots=True)
class Changes:
    """`added_keys` are of the later revision, `removed_records` of the earlier one; `changes_by_key` are of interfaces
    in both.
    """

    since: str
    added: frozenset[Key] = frozenset()
    removed: tuple[Held, ...] = ()
    changed: Mapping[Key, tuple[Change, ...]] | None = None

    def of(self, key: Key) -> tuple[Change, ...]:
        """Return the changes of an interface that is in both revisions."""
        return (self.changed or {}).get(key, ())

    def mark(self, key: Key) -> Literal["added", "changed", ""]:
        """Return what happened to an interface of the later revision, empty for nothing."""
        return "added" if key in self.added else "changed" if self.of(key) else ""

    @property
    def some(self) -> bool:
        """Whether anything changed."""
        return bool(self.added or self.removed or self.changed)


def compare(since: str, before: Sequence[Held], after: Sequence[Held]) -> Changes:
    """Compare two revisions. A renamed interface is the same if its topics and message stayed."""
    old = {held.key: held for held in before}
    new = {held.key: held for held in after}
    lost = {key: held for key, held in old.items() if key not in new}
    pairs: dict[Key, Held] = {key: old[key] for key in new if key in old}
    for key in [key for key in new if key not in old]:
        same = [each for each, held in lost.items() if _carrier(held) == _carrier(new[key]) and _carrier(held)]
        # With several candidates it is open which one was renamed; then all count as added and removed.
        if len(same) == 1:
            pairs[key] = lost.pop(same[0])
    changed = {key: found for key, held in pairs.items() if (found := tuple(_changes(held.plain, new[key].plain)))}
    return Changes(since, frozenset(key for key in new if key not in pairs), tuple(lost.values()), changed)


def _carrier(held: Held) -> tuple[object, ...]:
    """Return what identifies an interface besides its name, nothing if no topic carries it."""
    found: Interface = held.terms.interface
    return (found.pair, found.flow, found.names, found.message) if found.names else ()


def _changes(before: Plain, after: Plain) -> list[Change]:
    found = []
    # In the order of the later document, what is gone last.
    for key in (*after, *(key for key in before if key not in after)):
        was, now = before.get(key), after.get(key)
        # Names of terms hold titles; a new title alone changes no term.
        if (was and was[1]) != (now and now[1]):
            found.append(Change(key, (now or was or ("", ""))[0], was and was[1], now and now[1]))
    return found
