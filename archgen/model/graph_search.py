"""The searches on graphs that the whole package shares: what can be reached, strong components, rings, parts.

Plain dictionaries and functions instead of networkx, whose import alone takes a third of a whole `archgen check`
(docs/decisions/0009-graphs.md).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


def find_reachable(
    neighbours: Mapping[T, Collection[T]],
    starts: Iterable[T],
    max_steps: int | None = None,
    enough: int | None = None,
) -> dict[T, int]:
    """Return all elements that can be reached, the starts included, nearest first, each with its least number of steps.

    `max_steps` limits the number of steps, and after the step with which `enough` elements are reached there is no other;
    None is no limit.
    """
    distances = dict.fromkeys(starts, 0)
    frontier, distance = list(distances), 0
    while frontier and (max_steps is None or distance < max_steps) and (enough is None or len(distances) < enough):
        distance += 1
        next_frontier: list[T] = []
        for element in frontier:
            for neighbour in neighbours.get(element, ()):
                if neighbour not in distances:
                    distances[neighbour] = distance
                    next_frontier.append(neighbour)
        frontier = next_frontier
    return distances


def find_strong_components(elements: Iterable[T], successors: Callable[[T], Iterable[T]]) -> list[tuple[T, ...]]:
    """Return the strong components, each behind all that lead to it; members are in the order of `elements`.

    Where each element is a successor of its successors, these are the connected parts.
    """
    order = list(elements)
    position = {element: index for index, element in enumerate(order)}
    search = _TarjanSearch(successors)
    for element in order:
        if element not in search.numbers:
            search.search_from(element)
    # Tarjan closes a component only after all that it leads to, so that the reverse is a topological order.
    return [
        tuple(sorted(component, key=lambda one: position.get(one, len(position))))
        for component in reversed(search.components)
    ]


def find_reach_masks(neighbours: Mapping[T, Collection[T]]) -> dict[T, int]:
    """Return what can be reached from each element, itself included, as a set of bits: each element has one.

    All together in the time of one search for each 64 elements or so, where a search from each takes the square.
    """
    elements = dict.fromkeys((*neighbours, *(each for targets in neighbours.values() for each in targets)))
    masks: dict[T, int] = {}
    for members in reversed(find_strong_components(elements, lambda element: neighbours.get(element, ()))):
        mask = 0
        for bit, member in enumerate(members, len(masks)):
            mask |= 1 << bit
            for neighbour in neighbours.get(member, ()):
                mask |= masks.get(neighbour, 0)
        masks.update(dict.fromkeys(members, mask))
    return masks


def find_rings(successors: Mapping[T, Sequence[T]]) -> list[tuple[T, ...]]:
    """Return the components that hold a loop, in order of appearance."""
    all_components = find_strong_components(successors, lambda element: successors.get(element, ()))
    position = {element: index for index, element in enumerate(successors)}
    rings = (component for component in all_components if is_ring(component, successors))
    return sorted(rings, key=lambda ring: position[ring[0]])


def is_ring(component: Sequence[T], successors: Mapping[T, Sequence[T]]) -> bool:
    """Return whether a strong component holds a loop: several members, or one that is its own successor."""
    return len(component) > 1 or component[0] in successors.get(component[0], ())


class _TarjanSearch(Generic[T]):
    """One depth-first search (R. Tarjan, 1972), with an explicit stack instead of recursion."""

    def __init__(self, successors: Callable[[T], Iterable[T]]) -> None:
        self.numbers: dict[T, int] = {}
        self.components: list[list[T]] = []
        self._successors = successors
        self._low_links: dict[T, int] = {}
        self._open_stack: list[T] = []
        self._on_stack: set[T] = set()

    def search_from(self, start: T) -> None:
        # Recursion would end at Python's limit: paths through an architecture can be thousands of activities long.
        """Search everything that can be reached from an element and has not been searched yet."""
        path: list[tuple[T, Iterator[T]]] = [self._enter_element(start)]
        while path:
            current, successors = path[-1]
            for successor in successors:
                if successor not in self.numbers:
                    path.append(self._enter_element(successor))
                    break
                if successor in self._on_stack:
                    self._low_links[current] = min(self._low_links[current], self.numbers[successor])
            else:
                path.pop()
                if path:
                    parent = path[-1][0]
                    self._low_links[parent] = min(self._low_links[parent], self._low_links[current])
                if self._low_links[current] == self.numbers[current]:
                    self._close_component(current)

    def _enter_element(self, element: T) -> tuple[T, Iterator[T]]:
        """Assign the next number to an element, and put it on the stack."""
        self._low_links[element] = self.numbers[element] = len(self.numbers)
        self._open_stack.append(element)
        self._on_stack.add(element)
        return element, iter(self._successors(element))

    def _close_component(self, root: T) -> None:
        """Take a complete component, whose root is the given element, off the stack."""
        members: list[T] = []
        while not members or members[-1] != root:
            members.append(self._open_stack.pop())
        self._on_stack.difference_update(members)
        self.components.append(members)
