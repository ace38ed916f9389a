"""Strongly connected components, without recursion (Tarjan 1972, with a stack of its own)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator


def components(elements: Iterable[str], after: Callable[[str], Iterable[str]]) -> list[tuple[str, ...]]:
    """Give the components, each behind all that lead to it. Within one, elements stand in the order of `elements`."""
    order = list(elements)
    place = {element: number for number, element in enumerate(order)}
    search = _Search(after)
    for element in order:
        if element not in search.number:
            search.run(element)
    return [tuple(sorted(found, key=place.__getitem__)) for found in reversed(search.found)]


class _Search:
    """One depth-first search."""

    def __init__(self, after: Callable[[str], Iterable[str]]) -> None:
        self.number: dict[str, int] = {}
        self.found: list[list[str]] = []
        self._after = after
        self._low: dict[str, int] = {}
        self._open: list[str] = []
        self._is_open: set[str] = set()

    def run(self, start: str) -> None:
        path: list[tuple[str, Iterator[str]]] = [self._enter(start)]
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

    def _enter(self, element: str) -> tuple[str, Iterator[str]]:
        self._low[element] = self.number[element] = len(self.number)
        self._open.append(element)
        self._is_open.add(element)
        return element, iter(self._after(element))

    def _close(self, root: str) -> None:
        members: list[str] = []
        while not members or members[-1] != root:
            members.append(self._open.pop())
        self._is_open.difference_update(members)
        self.found.append(members)
