"""Strongly connected components and loops, without recursion (R. Tarjan, 1972, with an explicit stack)."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


def components(elements: Iterable[T], after: Callable[[T], Iterable[T]]) -> list[tuple[T, ...]]:
    """Return the strong components, each behind all that lead to it; members are in the order of `elements`."""
    order = list(elements)
    place = {element: number for number, element in enumerate(order)}
    search = _Search(after)
    for element in order:
        if element not in search.number:
            search.run(element)
    # Tarjan closes a component only after all that it leads to, so that the reverse is a topological order.
    return [tuple(sorted(found, key=lambda one: place.get(one, len(place)))) for found in reversed(search.found)]


def rings(after: Mapping[T, Sequence[T]]) -> list[tuple[T, ...]]:
    """Return the components that hold a loop, in order of appearance."""
    found = components(after, lambda element: after.get(element, ()))
    place = {element: number for number, element in enumerate(after)}
    looped = (ring for ring in found if len(ring) > 1 or ring[0] in after.get(ring[0], ()))
    return sorted(looped, key=lambda ring: place[ring[0]])


class _Search(Generic[T]):
    """One depth-first search."""

    def __init__(self, after: Callable[[T], Iterable[T]]) -> None:
        self.number: dict[T, int] = {}
        self.found: list[list[T]] = []
        self._after = after
        self._low: dict[T, int] = {}
        self._open: list[T] = []
        self._is_open: set[T] = set()

    def run(self, start: T) -> None:
        # Recursion would end at Python's limit: paths through an architecture can be thousands of activities long.
        """Search everything that can be reached from an element and has not been searched yet."""
        path: list[tuple[T, Iterator[T]]] = [self._enter(start)]
        while path:
            here, following = path[-1]
            for there in following:
                if there not in self.number:
                    path.append(self._enter(there))
                    break
                if there in self._is_open:
                    self._low[here] = min(self._low[here], self.number[there])
            else:
                path.pop()
                if path:
                    before = path[-1][0]
                    self._low[before] = min(self._low[before], self._low[here])
                if self._low[here] == self.number[here]:
                    self._close(here)

    def _enter(self, element: T) -> tuple[T, Iterator[T]]:
        """Assign the next number to an element, and put it on the stack."""
        self._low[element] = self.number[element] = len(self.number)
        self._open.append(element)
        self._is_open.add(element)
        return element, iter(self._after(element))

    def _close(self, root: T) -> None:
        """Take a complete component, whose root is the given element, off the stack."""
        members: list[T] = []
        while not members or members[-1] != root:
            members.append(self._open.pop())
        self._is_open.difference_update(members)
        self.found.append(members)
