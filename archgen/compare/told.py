"""What sentences and judgements look up of both versions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from archgen.compare.elements import Element, Key
from archgen.compare.wiring import Wires


@dataclass(frozen=True, slots=True)
class Told:
    """The elements and wires of both versions, by their common names (those of the second version, where it has them)."""

    old: Wires
    new: Wires
    before: Mapping[Key, Element]
    after: Mapping[Key, Element]
    serving: tuple[Mapping[str, frozenset[str]], Mapping[str, frozenset[str]]]
    """The components that name a requirement, before and after."""

    lost: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """The keys of what could not be read, before and after: nobody knows whether that came or went."""

    unnamed: frozenset[str] = frozenset()
    """Outputs that stand on topics, services or actions that are called after them, since no node says otherwise."""

    def unknown(self, key: Key) -> bool:
        """Say whether what is missing in one version may stand in a part of it that could not be read."""
        lost = self.lost[0 if key in self.after else 1]
        return bool(lost) and not lost.isdisjoint(
            word for part in key[1].split(".") for word in (part, part.rpartition(" ")[2])
        )

    def unread(self, key: Key, before: object, after: object) -> bool:
        """Say whether a value that is missing in one version may stand in a part of it that could not be read."""
        if isinstance(before, list) or isinstance(after, list):
            return any(self.lost) and self._unlisted(before, after)
        lost = self.lost[0] if before is None else self.lost[1] if after is None else frozenset()
        there = after if before is None else before
        named = there.split(".") if isinstance(there, str) else []  # what a reference names may be what is not there
        return bool(lost) and (key[0] in {"project", "group"} or not lost.isdisjoint([*key[1].split("."), *named]))

    def _unlisted(self, before: object, after: object) -> bool:
        """Say whether all that a list gained and lost are references to what could not be read."""
        old, new = (each if isinstance(each, list) else [] for each in (before, after))
        sides = (new, old, self.lost[0]), (old, new, self.lost[1])
        other = [(item, lost) for here, there, lost in sides for item in here if item not in there]
        return bool(other) and all(not lost.isdisjoint(str(item).split(".")) for item, lost in other)

    def using(self, sort: str, key: str, value: str) -> list[str]:
        """Name the elements of the second version that have a value at a key."""
        return sorted(name for (kind, name), e in self.after.items() if kind == sort and e.values.get(key) == value)

    def gone(self, sort: str, name: str) -> bool:
        """Say whether an element was removed."""
        return (sort, name) in self.before and (sort, name) not in self.after

    def come(self, sort: str, name: str) -> bool:
        """Say whether an element was added."""
        return (sort, name) in self.after and (sort, name) not in self.before
