"""Worst, best and k worst paths through a graph of costs, and their number, without listing them all.

A route is a row of regions (sets of vertices): a path begins in the first, ends in the last, moves inside a region
along its arcs and on to the next. The states (region, vertex) that lie on a path make a graph; where it has no loops,
the longest path to the end is found by dynamic programming in time linear in arcs. With these exact remainders, a
best-first search yields paths in order of cost, each in time proportional to its length (the search never enters a
state in vain). Where loops remain, states also carry the set of visited vertices of the loop, so that exactly the paths
that visit nothing twice remain; should that become too large, the arcs that lead back are cut, and named.

Listing paths is out of the question: 300 activities with 840 arcs have 1e8 of them.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.timing.states import Graph, Hop, Region, States, in_order, unfolded, without_returns

__all__ = ["Graph", "Hop", "Region", "Way", "Ways", "ways"]


class Way(NamedTuple):
    """A path: its cost, the vertex at which it starts, and its arcs."""

    cost: int
    start: int
    arcs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Ways:
    """All paths of a route, as an acyclic graph of states in topological order. `vertices` says where each state is.

    `remaining_costs` is the extreme cost from a state to the end (None: no way there), `counts_by_state` the number of
    paths to it. `cut_arcs` were left out because they lead back.
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
        """Return the number of paths."""
        return sum(self.counts[state] for state, _ in self.starts)

    def best(self, most: int = 1) -> Iterator[Way]:
        """Yield paths from the extreme one on, at most so many."""
        # heapq takes the smallest first: costs are negated for the longest paths.
        sign = -1 if self.longest else 1
        heap: list[tuple[int, int, int, int, int, _Trail | None]] = []
        # An entry is (estimate, -depth, serial, cost so far, state, trail). The estimate is exact, so the first
        # complete path that is taken out is extreme. Of equal estimates the deepest comes first: without that a
        # thousand equal paths would all be opened before one is complete. The serial keeps trails from being compared.
        for state, cost in self.starts:
            rest = self.rest[state]
            if rest is not None:
                heapq.heappush(heap, (sign * (cost + rest), 0, len(heap), cost, state, None))
        serial = len(heap)
        while heap and most > 0:
            _, depth, _, cost, state, trail = heapq.heappop(heap)
            # State -1 is the end: several states may be last, and a path may also go on from one of them.
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
        """Yield the hops from a state, and one to the end (-1) where a path may end."""
        yield from self.after[state]
        if state in self.ends:
            yield Hop(-1, 0, -1)

    def arcs(self) -> Iterator[int]:
        """Yield every arc that lies on a path, each once."""
        seen = set[int]()
        for state, hops in enumerate(self.after):
            if self.rest[state] is not None:
                fresh = {hop.arc for hop in hops if hop.arc >= 0 and self.rest[hop.target] is not None} - seen
                seen |= fresh
                yield from sorted(fresh)


class _Trail(NamedTuple):
    """The steps of a path, linked backwards: paths that begin alike share their beginning."""

    before: _Trail | None
    state: int
    arc: int


def _way(cost: int, trail: _Trail | None, vertex: Sequence[int]) -> Way:
    """Build a path from its trail."""
    arcs: list[int] = []
    start = -1
    while trail is not None:
        if trail.arc >= 0:
            arcs.append(trail.arc)
        start = trail.state
        trail = trail.before
    return Way(cost, vertex[start], tuple(reversed(arcs)))


def ways(graph: Graph, first: Sequence[int], route: Sequence[Region], *, longest: bool) -> Ways:
    """Find all paths of a route. `start_costs` is what each vertex costs as the start of a path."""
    rough = States.explore(graph, route, longest=longest)
    kept = rough.on_a_way()
    # From cheap to expensive: no loops; loops that can be unfolded; loops of which arcs must be cut.
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
    """Find the extreme cost from each state to the end, and count the paths, from the end backwards."""
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
