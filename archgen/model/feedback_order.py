"""Order elements so that as little as possible flows back: the order of a matrix in which feedback lies on one side.

Elements that do not lead back to one another are ordered by what leads to what. Those of one loop are ordered exactly up to
`MAX_EXACT` of them, by a search over all subsets; above, by the greedy rule of Eades, Lin and Smyth (A fast and effective
heuristic for the feedback arc set problem, 1993).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import Generic, TypeVar

from archgen.frozen import dataclass
from archgen.model.graph_search import find_strong_components

T = TypeVar("T", bound=Hashable)
MAX_EXACT = 18
"""The longest loop that is ordered exactly: 2 to this power are the subsets that are looked at (about a second)."""


@dataclass(frozen=True, slots=True)
class FeedbackOrder(Generic[T]):
    """Elements in order, and whether no other order has less feedback."""

    elements: tuple[T, ...]
    is_exact: bool


def order_by_feedback(elements: Iterable[T], weights: Mapping[tuple[T, T], int]) -> FeedbackOrder[T]:
    """Order elements so that the weights of the pairs (source, target) that run back are few.

    Of orders that are as good, one near the given order is returned.
    """
    successors: dict[T, list[T]] = {element: [] for element in elements}
    for source, target in weights:
        if source != target and source in successors and target in successors:
            successors[source].append(target)
    ordered: list[T] = []
    is_exact = True
    for loop in _list_loops(successors):
        is_short = len(loop) <= MAX_EXACT
        is_exact = is_exact and is_short
        ordered += _order_exactly(loop, weights) if is_short else _order_greedily(loop, weights)
    return FeedbackOrder(tuple(ordered), is_exact)


def _list_loops(successors: Mapping[T, Sequence[T]]) -> Iterator[tuple[T, ...]]:
    """Yield the strong components, each behind all that lead to it, else in the given order."""
    loops = find_strong_components(successors, successors.__getitem__)
    loop_of = {element: index for index, loop in enumerate(loops) for element in loop}
    followers: list[set[int]] = [set() for _ in loops]
    for source, targets in successors.items():
        followers[loop_of[source]] |= {loop_of[target] for target in targets} - {loop_of[source]}
    open_counts = Counter(follower for loop_followers in followers for follower in loop_followers)
    positions = {element: position for position, element in enumerate(successors)}
    ready = [(positions[loop[0]], index) for index, loop in enumerate(loops) if not open_counts[index]]
    heapify(ready)
    while ready:
        _, index = heappop(ready)
        yield loops[index]
        for follower in followers[index]:
            open_counts[follower] -= 1
            if not open_counts[follower]:
                heappush(ready, (positions[loops[follower][0]], follower))


def _order_exactly(loop: Sequence[T], weights: Mapping[tuple[T, T], int]) -> list[T]:
    """Find the best order: of each subset the least feedback, by which of it comes last."""
    count = len(loop)
    # For each element the weight from it into each subset, which is a number of `count` bits.
    backward: list[list[int]] = []
    for element in loop:
        sums = [0]
        for other in loop:
            weight = weights.get((element, other), 0) if other != element else 0
            sums += [total + weight for total in sums]
        backward.append(sums)
    costs, last_elements = [0] * (1 << count), [0] * (1 << count)
    for subset in range(1, 1 << count):
        best_cost, best_last = -1, 0
        remaining = subset
        while remaining:
            bit = remaining & -remaining
            remaining ^= bit
            index = bit.bit_length() - 1
            cost = costs[subset ^ bit] + backward[index][subset ^ bit]
            # `<=`: of equals the later one comes last, as in the given order.
            if best_cost < 0 or cost <= best_cost:
                best_cost, best_last = cost, index
        costs[subset], last_elements[subset] = best_cost, best_last
    ordered: list[T] = []
    subset = (1 << count) - 1
    while subset:
        ordered.append(loop[last_elements[subset]])
        subset ^= 1 << last_elements[subset]
    return ordered[::-1]


def _order_greedily(loop: Sequence[T], weights: Mapping[tuple[T, T], int]) -> list[T]:
    """Take what feeds nothing more to the end, what nothing feeds to the front, else what feeds most more than it is fed."""
    remaining = dict.fromkeys(loop)
    given: dict[T, dict[T, int]] = {element: {} for element in loop}
    taken: dict[T, dict[T, int]] = {element: {} for element in loop}
    for (source, target), weight in weights.items():
        if source != target and source in given and target in given:
            given[source][target] = taken[target][source] = weight
    front: list[T] = []
    back: list[T] = []

    def remove(element: T, side: list[T]) -> None:
        del remaining[element]
        side.append(element)
        for target in given.pop(element):
            del taken[target][element]
        for source in taken.pop(element):
            del given[source][element]

    while remaining:
        sink = next((element for element in reversed(remaining) if not given[element]), None)
        if sink is not None:
            remove(sink, back)
            continue
        # `max` takes the first of equals, as in the given order.
        remove(max(remaining, key=lambda each: _rank_source(given[each], taken[each])), front)
    return front + back[::-1]


def _rank_source(given_counts: Mapping[T, int], taken_counts: Mapping[T, int]) -> tuple[bool, int]:
    """Return how well an element begins an order: one that nothing feeds before all others."""
    return not taken_counts, sum(given_counts.values()) - sum(taken_counts.values())
