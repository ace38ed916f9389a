"""Parts of several versions of one project, by id: what a version shares with another is not made anew for it."""

from __future__ import annotations

from typing import Generic, TypeVar

_Part = TypeVar("_Part")


class KnownParts(Generic[_Part]):
    """The parts of the first version and of the one that had them last: variants differ from the project, or from another."""

    __slots__ = ("_first", "_last")

    def __init__(self) -> None:
        """Start empty."""
        self._first: dict[str, _Part] = {}
        self._last: dict[str, _Part] = {}

    def list_known(self, part_id: str) -> tuple[_Part, ...]:
        """Return what is known by an id, none to two parts."""
        first = self._first.get(part_id)
        if first is None:
            return ()
        last = self._last.get(part_id)
        return (first,) if last is None else (first, last)

    def keep_part(self, part_id: str, part: _Part) -> None:
        """Remember a part."""
        (self._last if part_id in self._first else self._first)[part_id] = part
