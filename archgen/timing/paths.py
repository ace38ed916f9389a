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
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from archgen.timing.loops import rings

STATES = 20_000
"""How many states the unfolding of loops may make before arcs that lead back are cut instead."""


class Hop(NamedTuple):
    """One arc with its cost; `arc` is -1 for a step that stays at its vertex."""

    target: int
    cost: int
    arc: int


Graph = Sequence[Sequence[Hop]]


@dataclass(frozen=True, slots=True)
class Region:
    """Vertices that a way may visit in turn. None is every vertex that no other region names.

    With `inside` a way may move along arcs between them. `leave` are the arcs by which it may go on (None: all). One that
    is `optional` may be skipped.
    """

    members: frozenset[int] | None
    inside: bool = True
    leave: frozenset[int] | None = None
    optional: bool = False


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
    rough = _Rough.explore(graph, route, longest=longest)
    kept = rough.on_a_way()
    order = _sorted(rough.after, kept)
    if order is not None:
        return _solved(rough, order, first, (), longest=longest)
    unfolded = _unfolded(rough, kept)
    if unfolded is not None:
        order = _sorted(unfolded.after, range(len(unfolded.after)))
        if order is not None:
            return _solved(unfolded, order, first, (), longest=longest)
    cut = _without_returns(rough, kept)
    order = _sorted(cut[0].after, kept) or []
    return _solved(cut[0], order, first, cut[1], longest=longest)


@dataclass(frozen=True, slots=True)
class _Rough:
    """States as they are found, loops and dead ends included."""

    vertex: list[int]
    after: list[list[Hop]]
    starts: list[int]
    ends: list[int]

    @classmethod
    def explore(cls, graph: Graph, route: Sequence[Region], *, longest: bool) -> _Rough:
        """Go forward from the first region's starts."""
        named = frozenset[int]().union(*(region.members for region in route if region.members is not None))
        places: dict[tuple[int, int], int] = {}
        found: list[tuple[int, int]] = []

        def place(region: int, vertex: int) -> int:
            state = places.get((region, vertex))
            if state is None:
                state = places[region, vertex] = len(found)
                found.append((region, vertex))
            return state

        after: list[list[Hop]] = []
        starts = [place(0, vertex) for vertex in _entries(graph, route[0])]
        while len(after) < len(found):
            region, vertex = found[len(after)]
            chosen: dict[int, Hop] = {}
            for at, hop in _steps(graph, route, named, region, vertex):
                state = place(at, hop.target)
                old = chosen.get(state)
                if old is None or (hop.cost > old.cost if longest else hop.cost < old.cost):
                    chosen[state] = Hop(state, hop.cost, hop.arc)
            after.append(list(chosen.values()))
        last = len(route) - 1
        arrived = [state for state, (region, _) in enumerate(found) if region == last]
        ends = [state for state in arrived if not after[state]] or arrived
        return cls([vertex for _, vertex in found], after, starts, ends)

    def on_a_way(self) -> list[int]:
        """Give the states from which the end can be reached (all can be reached from the start)."""
        before: list[list[int]] = [[] for _ in self.after]
        for state, hops in enumerate(self.after):
            for hop in hops:
                before[hop.target].append(state)
        seen = bytearray(len(self.after))
        queue = deque(self.ends)
        for state in queue:
            seen[state] = 1
        while queue:
            for state in before[queue.popleft()]:
                if not seen[state]:
                    seen[state] = 1
                    queue.append(state)
        return [state for state in range(len(seen)) if seen[state]]


def _steps(
    graph: Graph, route: Sequence[Region], named: frozenset[int], region: int, vertex: int
) -> Iterator[tuple[int, Hop]]:
    """Give the steps from a vertex in a region, each with the region that it leads to."""
    here = route[region]
    onward = _onward(route, region)
    overlaps = [at for at in onward if here.members and (route[at].members or frozenset()) & here.members]
    for at in overlaps:
        if vertex in (route[at].members or ()):
            yield at, Hop(vertex, 0, -1)
    for hop in graph[vertex]:
        if here.inside and hop.target != vertex and _holds(here, named, hop.target):
            yield region, hop
        if overlaps or (here.leave is not None and hop.arc not in here.leave):
            continue
        for at in onward:
            if _holds(route[at], named, hop.target):
                yield at, hop


def _onward(route: Sequence[Region], region: int) -> list[int]:
    after = [region + 1] if region + 1 < len(route) else []
    if after and route[after[0]].optional:
        after.append(region + 2)
    return after


def _holds(region: Region, named: frozenset[int], vertex: int) -> bool:
    return vertex not in named if region.members is None else vertex in region.members


def _entries(graph: Graph, region: Region) -> list[int]:
    """Give the vertices at which a way may start: those that nothing inside the region feeds, or all."""
    members = sorted(region.members or ())
    fed = (
        {hop.target for vertex in members for hop in graph[vertex] if hop.target != vertex} if region.inside else set()
    )
    return [vertex for vertex in members if vertex not in fed] or members


def _sorted(after: Sequence[Sequence[Hop]], kept: Sequence[int]) -> list[int] | None:
    """Sort states so that arcs lead forward; None where there are loops."""
    inside = bytearray(len(after))
    for state in kept:
        inside[state] = 1
    waiting = [0] * len(after)
    for state in kept:
        for hop in after[state]:
            waiting[hop.target] += 1
    order = [state for state in kept if not waiting[state]]
    for state in order:
        for hop in after[state]:
            waiting[hop.target] -= 1
            if not waiting[hop.target] and inside[hop.target]:
                order.append(hop.target)
    return order if len(order) == len(kept) else None


def _solved(rough: _Rough, order: Sequence[int], first: Sequence[int], cut: tuple[int, ...], *, longest: bool) -> Ways:
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


def _unfolded(rough: _Rough, kept: Sequence[int]) -> _Rough | None:
    """Tell states apart by what was visited of the loop that they lie in; None where that makes too many."""
    alive = set(kept)
    ring: dict[int, tuple[int, int]] = {}
    for number, members in enumerate(rings({s: [h.target for h in rough.after[s] if h.target in alive] for s in kept})):
        ring |= {state: (number, 1 << bit) for bit, state in enumerate(members)}
    places: dict[tuple[int, int], int] = {}
    found: list[tuple[int, int]] = []

    def place(state: int, visited: int) -> int:
        number = places.get((state, visited))
        if number is None:
            number = places[state, visited] = len(found)
            found.append((state, visited))
        return number

    starts = [place(state, ring[state][1] if state in ring else 0) for state in rough.starts if state in alive]
    after: list[list[Hop]] = []
    while len(after) < len(found):
        if len(found) > STATES:
            return None
        state, visited = found[len(after)]
        hops: list[Hop] = []
        for hop in rough.after[state]:
            if hop.target in alive:
                bit = _bit(ring, state, hop.target, visited)
                if bit is not None:
                    hops.append(Hop(place(hop.target, bit), hop.cost, hop.arc))
        after.append(hops)
    ends = set(rough.ends)
    return _Rough(
        [rough.vertex[state] for state, _ in found],
        after,
        starts,
        [number for number, (state, _) in enumerate(found) if state in ends],
    )


def _bit(ring: dict[int, tuple[int, int]], state: int, target: int, visited: int) -> int | None:
    """Give what is visited after a step; None where the step returns."""
    if target not in ring:
        return 0
    number, bit = ring[target]
    if state in ring and ring[state][0] == number:
        return None if visited & bit else visited | bit
    return bit


def _without_returns(rough: _Rough, kept: Sequence[int]) -> tuple[_Rough, tuple[int, ...]]:
    """Leave out the arcs that lead back in a depth-first search from the starts."""
    alive = set(kept)
    after: list[list[Hop]] = [[] for _ in rough.after]
    cut: list[int] = []
    colour = bytearray(len(rough.after))  # 1 on the way, 2 done
    for start in rough.starts:
        if start not in alive or colour[start]:
            continue
        colour[start] = 1
        stack = [(start, iter(rough.after[start]))]
        while stack:
            state, hops = stack[-1]
            hop = next(hops, None)
            if hop is None:
                colour[state] = 2
                stack.pop()
            elif hop.target in alive and colour[hop.target] == 1:
                cut.append(hop.arc)
            elif hop.target in alive:
                after[state].append(hop)
                if not colour[hop.target]:
                    colour[hop.target] = 1
                    stack.append((hop.target, iter(rough.after[hop.target])))
    return _Rough(rough.vertex, after, rough.starts, rough.ends), tuple(dict.fromkeys(cut))
