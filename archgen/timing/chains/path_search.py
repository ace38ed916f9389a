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

from archgen.frozen import NamedTuple, dataclass
from archgen.timing.chains.path_states import (
    CostGraph,
    Hop,
    RouteRegion,
    StateGraph,
    cut_returns,
    sort_topologically,
    unfold_loops,
)

__all__ = ["CostGraph", "CostedPath", "Hop", "PathSet", "RouteRegion", "find_paths"]


class CostedPath(NamedTuple):
    """A path: its cost, the vertex at which it starts, and its arcs."""

    cost: int
    start: int
    arcs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class PathSet:
    """All paths of a route, as an acyclic graph of states in topological order. `vertices` says where each state is.

    `remaining_costs` is the extreme cost from a state to the end (None: no way there), `counts_by_state` the number of
    paths to it. `cut_arcs` were left out because they lead back.
    """

    vertices: Sequence[int]
    hops: Sequence[Sequence[Hop]]
    starts: Sequence[tuple[int, int]]
    end_states: frozenset[int]
    remaining_costs: Sequence[int | None]
    counts_by_state: Sequence[int]
    cut_arcs: tuple[int, ...]
    longest: bool

    @property
    def path_count(self) -> int:
        """Return the number of paths."""
        return sum(self.counts_by_state[state] for state, _ in self.starts)

    def best_paths(self, limit: int = 1) -> Iterator[CostedPath]:
        """Yield paths from the extreme one on, at most so many."""
        # heapq takes the smallest first: costs are negated for the longest paths.
        sign = -1 if self.longest else 1
        heap: list[tuple[int, int, int, int, int, _PathTrail | None]] = []
        # An entry is (estimate, -depth, serial, cost so far, state, trail). The estimate is exact, so the first
        # complete path that is taken out is extreme. Of equal estimates the deepest comes first: without that a
        # thousand equal paths would all be opened before one is complete. The serial keeps trails from being compared.
        for state, cost in self.starts:
            remaining_cost = self.remaining_costs[state]
            if remaining_cost is not None:
                heapq.heappush(heap, (sign * (cost + remaining_cost), 0, len(heap), cost, state, None))
        serial = len(heap)
        while heap and limit > 0:
            _, depth, _, cost, state, trail = heapq.heappop(heap)
            # State -1 is the end: several states may be last, and a path may also go on from one of them.
            if state < 0:
                limit -= 1
                yield _build_path(cost, trail, self.vertices)
                continue
            for hop in self._hops_from(state):
                remaining_cost = 0 if hop.target < 0 else self.remaining_costs[hop.target]
                if remaining_cost is not None:
                    serial += 1
                    spent_cost = cost + hop.cost
                    step = _PathTrail(trail, state, hop.arc)
                    heapq.heappush(
                        heap, (sign * (spent_cost + remaining_cost), depth - 1, serial, spent_cost, hop.target, step)
                    )

    def _hops_from(self, state: int) -> Iterator[Hop]:
        """Yield the hops from a state, and one to the end (-1) where a path may end."""
        yield from self.hops[state]
        if state in self.end_states:
            yield Hop(-1, 0, -1)

    def arcs_on_paths(self) -> Iterator[int]:
        """Yield every arc that lies on a path, each once."""
        seen_arcs = set[int]()
        for state, hops in enumerate(self.hops):
            if self.remaining_costs[state] is not None:
                new_arcs = {
                    hop.arc for hop in hops if hop.arc >= 0 and self.remaining_costs[hop.target] is not None
                } - seen_arcs
                seen_arcs |= new_arcs
                yield from sorted(new_arcs)


class _PathTrail(NamedTuple):
    """The steps of a path, linked backwards: paths that begin alike share their beginning."""

    previous: _PathTrail | None
    state: int
    arc: int


def _build_path(cost: int, trail: _PathTrail | None, vertices: Sequence[int]) -> CostedPath:
    arcs: list[int] = []
    start = -1
    while trail is not None:
        if trail.arc >= 0:
            arcs.append(trail.arc)
        start = trail.state
        trail = trail.previous
    return CostedPath(cost, vertices[start], tuple(reversed(arcs)))


def find_paths(graph: CostGraph, start_costs: Sequence[int], route: Sequence[RouteRegion], *, longest: bool) -> PathSet:
    """Find all paths of a route. `start_costs` is what each vertex costs as the start of a path."""
    state_graph = StateGraph.explore_route(graph, route, longest=longest)
    kept_states = state_graph.states_on_paths()
    # From cheap to expensive: no loops; loops that can be unfolded; loops of which arcs must be cut.
    order = sort_topologically(state_graph.hops, kept_states)
    if order is not None:
        return _solve_path_set(state_graph, order, start_costs, (), longest=longest)
    unfolded_graph = unfold_loops(state_graph, kept_states)
    if unfolded_graph is not None:
        order = sort_topologically(unfolded_graph.hops, range(len(unfolded_graph.hops))) or []
        return _solve_path_set(unfolded_graph, order, start_costs, (), longest=longest)
    cut_graph, cut_arcs = cut_returns(state_graph, kept_states)
    return _solve_path_set(
        cut_graph, sort_topologically(cut_graph.hops, kept_states) or [], start_costs, cut_arcs, longest=longest
    )


def _solve_path_set(
    state_graph: StateGraph,
    order: Sequence[int],
    start_costs: Sequence[int],
    cut_arcs: tuple[int, ...],
    *,
    longest: bool,
) -> PathSet:
    """Find the extreme cost from each state to the end, and count the paths, from the end backwards."""
    remaining_costs: list[int | None] = [None] * len(state_graph.hops)
    counts_by_state = [0] * len(state_graph.hops)
    end_states = frozenset(state_graph.end_states)
    for state in reversed(order):
        extreme: int | None = 0 if state in end_states else None
        path_count = 1 if state in end_states else 0
        for target, cost, _ in state_graph.hops[state]:
            remaining_cost = remaining_costs[target]
            if remaining_cost is not None:
                remaining_cost += cost
                path_count += counts_by_state[target]
                if extreme is None or (remaining_cost > extreme if longest else remaining_cost < extreme):
                    extreme = remaining_cost
        remaining_costs[state], counts_by_state[state] = extreme, path_count
    starts = tuple((state, start_costs[state_graph.vertices[state]]) for state in state_graph.start_states)
    return PathSet(
        state_graph.vertices, state_graph.hops, starts, end_states, remaining_costs, counts_by_state, cut_arcs, longest
    )
