"""What describing and judging changes needs to look up in both versions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from archgen.compare.elements import Element, Key
from archgen.compare.wiring import Wires


@dataclass(frozen=True, slots=True)
class Told:
    """Elements and connections of both versions by common ids (those of the second version for all that is in both)."""

    old: Wires
    new: Wires
    before: Mapping[Key, Element]
    after: Mapping[Key, Element]
    serving: tuple[Mapping[str, frozenset[str]], Mapping[str, frozenset[str]]]
    """For each requirement the components that name it, before and after."""

    lost: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """Keys of what could not be read, before and after: whether that was added or removed is unknown."""

    unnamed: frozenset[str] = frozenset()
    """Outputs whose topic, service or action is called after them, since no node names it otherwise."""

    def unknown(self, key: Key) -> bool:
        """Whether an element that is missing in one version may be in a part of it that could not be read."""
        # The version in which it is missing: the first one for an added element, the second one for a removed element.
        lost = self.lost[0 if key in self.after else 1]
        # Any part of the path may be the lost key; ports of nodes have ids with a use in them.
        return bool(lost) and not lost.isdisjoint(
            word for part in key[1].split(".") for word in (part, part.rpartition(" ")[2])
        )

    def unread(self, key: Key, before: object, after: object) -> bool:
        """Whether a value missing in one version may be in a part of it that could not be read."""
        if isinstance(before, list) or isinstance(after, list):
            return any(self.lost) and self._unlisted(before, after)
        lost = self.lost[0] if before is None else self.lost[1] if after is None else frozenset()
        there = after if before is None else before
        named = there.split(".") if isinstance(there, str) else []  # what a reference names may be what is not there
        return bool(lost) and (key[0] in {"project", "group"} or not lost.isdisjoint([*key[1].split("."), *named]))

    def _unlisted(self, before: object, after: object) -> bool:
        """Whether all that a list gained and lost are references to what could not be read."""
        old, new = (each if isinstance(each, list) else [] for each in (before, after))
        sides = (new, old, self.lost[0]), (old, new, self.lost[1])
        other = [(item, lost) for here, there, lost in sides for item in here if item not in there]
        return bool(other) and all(not lost.isdisjoint(str(item).split(".")) for item, lost in other)

    def using(self, sort: str, key: str, value: str) -> list[str]:
        """Return the sorted ids of the elements of the second version that have a value at a key."""
        return sorted(name for (kind, name), e in self.after.items() if kind == sort and e.values.get(key) == value)

    def gone(self, sort: str, name: str) -> bool:
        """Whether an element was removed."""
        return (sort, name) in self.before and (sort, name) not in self.after

    def come(self, sort: str, name: str) -> bool:
        """Whether an element was added."""
        return (sort, name) in self.after and (sort, name) not in self.before
