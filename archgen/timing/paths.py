"""Worst, best and k worst ways through a graph of costs, and their number, without listing them.

A route is a row of regions (sets of vertices): a way begins in the first, ends in the last, moves inside a region along
its arcs and on to the next. The states (region, vertex) that lie on a way make a graph; where it has no loops, the
longest way to the end is found by dynamic programming in time linear in arcs. With these exact remainders, a best-first
search gives ways in their order, each at the cost of its length (the search never enters a state in vain). Where loops
are left, states also carry the set of vertices of the loop that were visited, so that exactly the ways that visit
nothing twice remain; should that become too large, the arcs that lead back are cut, and named.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.timing.states import Graph, Hop, Region, States, in_order, unfolded, without_returns

__all__ = ["Graph", "Hop", "Region", "Way", "Ways", "ways"]


class Way(NamedTuple):
    """A way: its cost, the vertex at which it starts, and its arcs."""

    cost: int
    start: int
    arcs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Ways:
    """All ways of a route, as an acyclic graph of states in topological order. `vertex` says where each state is.

    `rest` is the extreme cost from a state to the end, `counts` the number of ways to it. `cut` are the arcs that were
    left out because they lead back.
    """

    vertex: Sequence[int]
    after: Sequence[Sequence[Hop]]
    starts: Sequence[tuple[int, int]]
    ends: frozenset[int]
    rest: Sequence[int | None]
    counts: Sequence[int]
    cut: tuple[int, ...]
    longest: bool

    @property
    def count(self) -> int:
        """Count the ways."""
        return sum(self.counts[state] for state, _ in self.starts)

    def best(self, most: int = 1) -> Iterator[Way]:
        """Give ways from the extreme one on, at most so many."""
        sign = -1 if self.longest else 1
        heap: list[tuple[int, int, int, int, int, _Trail | None]] = []
        for state, cost in self.starts:
            rest = self.rest[state]
            if rest is not None:
                heapq.heappush(heap, (sign * (cost + rest), 0, len(heap), cost, state, None))
        serial = len(heap)
        while heap and most > 0:
            _, depth, _, cost, state, trail = heapq.heappop(heap)
            if state < 0:
                most -= 1
                yield _way(cost, trail, self.vertex)
                continue
            for hop in self._onward(state):
                rest = 0 if hop.target < 0 else self.rest[hop.target]
                if rest is not None:
                    serial += 1
                    spent = cost + hop.cost
                    step = _Trail(trail, state, hop.arc)
                    heapq.heappush(heap, (sign * (spent + rest), depth - 1, serial, spent, hop.target, step))

    def _onward(self, state: int) -> Iterator[Hop]:
        yield from self.after[state]
        if state in self.ends:
            yield Hop(-1, 0, -1)

    def arcs(self) -> Iterator[int]:
        """Give every arc that lies on a way, each once."""
        seen = set[int]()
        for state, hops in enumerate(self.after):
            if self.rest[state] is not None:
                fresh = {hop.arc for hop in hops if hop.arc >= 0 and self.rest[hop.target] is not None} - seen
                seen |= fresh
                yield from sorted(fresh)


class _Trail(NamedTuple):
    before: _Trail | None
    state: int
    arc: int


def _way(cost: int, trail: _Trail | None, vertex: Sequence[int]) -> Way:
    arcs: list[int] = []
    start = -1
    while trail is not None:
        if trail.arc >= 0:
            arcs.append(trail.arc)
        start = trail.state
        trail = trail.before
    return Way(cost, vertex[start], tuple(reversed(arcs)))


def ways(graph: Graph, first: Sequence[int], route: Sequence[Region], *, longest: bool) -> Ways:
    """Find all ways of a route. `first` is what each vertex costs as the start of a way."""
    rough = States.explore(graph, route, longest=longest)
    kept = rough.on_a_way()
    order = in_order(rough.after, kept)
    if order is not None:
        return _solved(rough, order, first, (), longest=longest)
    whole = unfolded(rough, kept)
    if whole is not None:
        order = in_order(whole.after, range(len(whole.after))) or []
        return _solved(whole, order, first, (), longest=longest)
    open_states, cut = without_returns(rough, kept)
    return _solved(open_states, in_order(open_states.after, kept) or [], first, cut, longest=longest)


def _solved(rough: States, order: Sequence[int], first: Sequence[int], cut: tuple[int, ...], *, longest: bool) -> Ways:
    """Find the extreme cost from each state to the end, and count the ways, from the end backwards."""
    rest: list[int | None] = [None] * len(rough.after)
    counts = [0] * len(rough.after)
    ends = frozenset(rough.ends)
    for state in reversed(order):
        extreme: int | None = 0 if state in ends else None
        number = 1 if state in ends else 0
        for target, cost, _ in rough.after[state]:
            onward = rest[target]
            if onward is not None:
                onward += cost
                number += counts[target]
                if extreme is None or (onward > extreme if longest else onward < extreme):
                    extreme = onward
        rest[state], counts[state] = extreme, number
    starts = tuple((state, first[rough.vertex[state]]) for state in rough.starts)
    return Ways(rough.vertex, rough.after, starts, ends, rest, counts, cut, longest)
