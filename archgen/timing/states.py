"""The states (region, vertex) of a route: explored, freed of dead ends, and unfolded or cut where they make loops."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.timing.rings import rings

STATES = 20_000
"""How many states the unfolding of loops may make before arcs that lead back are cut instead."""


class Hop(NamedTuple):
    """One arc with its cost; `arc` is -1 for a step that stays at its vertex."""

    target: int
    cost: int
    arc: int


Graph = Sequence[Sequence[Hop]]
"""The hops from each vertex."""


@dataclass(frozen=True, slots=True)
class Region:
    """Vertices that a path may visit in turn. None means every vertex that no other region names.

    With `inside` a path may move along arcs between them. `leaving_arcs` are those by which it may go on (None: all).
    An `optional` region may be skipped.
    """

    members: frozenset[int] | None
    inside: bool = True
    leave: frozenset[int] | None = None
    optional: bool = False


@dataclass(frozen=True, slots=True)
class States:
    """States as they are found, loops and dead ends included: each one's vertex and hops, the first and last ones."""

    vertex: list[int]
    after: list[list[Hop]]
    starts: list[int]
    ends: list[int]

    @classmethod
    def explore(cls, graph: Graph, route: Sequence[Region], *, longest: bool) -> States:
        """Go forward from the first region's entries to all states that can be reached."""
        places: list[dict[int, int]] = [{} for _ in route]
        found: list[tuple[int, int]] = []
        after: list[list[Hop]] = []
        starts = [_place(places, found, 0, vertex) for vertex in _entries(graph, route[0])]
        leads = [_Lead.of(route, region) for region in range(len(route))]
        # Breadth first: `found_states` grows while it is walked through, and `all_hops` has one entry for each that is
        # done.
        while len(after) < len(found):
            region, vertex = found[len(after)]
            chosen: dict[int, Hop] = {}
            for target, cost, arc in leads[region].hops(graph, vertex):
                # An arc from an activity to itself is no step of a path.
                if target == vertex and arc >= 0:
                    continue
                for at in leads[region].regions(target, arc):
                    state = places[at].get(target)
                    if state is None:
                        state = _place(places, found, at, target)
                    # Of parallel arcs (several topics) only the extreme one is kept: a path is known by its vertices.
                    old = chosen.get(state)
                    if old is None or (cost > old[1] if longest else cost < old[1]):
                        chosen[state] = Hop(state, cost, arc)
            after.append(list(chosen.values()))
        last = len(route) - 1
        arrived = [state for state, (region, _) in enumerate(found) if region == last]
        # A path ends where nothing leads on in the last region, or anywhere in it if all of it is loops.
        ends = [state for state in arrived if not after[state]] or arrived
        return cls([vertex for _, vertex in found], after, starts, ends)

    def on_a_way(self) -> list[int]:
        """Return the states from which the end can be reached (all can be reached from the start)."""
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


def _place(places: list[dict[int, int]], found: list[tuple[int, int]], region: int, vertex: int) -> int:
    """Return the number of a state, a new one where it has none."""
    if vertex not in places[region]:
        places[region][vertex] = len(found)
        found.append((region, vertex))
    return places[region][vertex]


@dataclass(frozen=True, slots=True)
class _Lead:
    """Where a path may go from a region: inside it, and on. Where two regions overlap, it passes in what they share."""

    at: int
    here: Region
    onward: tuple[tuple[int, frozenset[int] | None], ...]
    named: frozenset[int]
    shared: frozenset[int]

    @classmethod
    def of(cls, route: Sequence[Region], at: int) -> _Lead:
        """Look at a route from one of its regions."""
        onward = [at + 1] if at + 1 < len(route) else []
        if onward and route[onward[0]].optional:
            onward.append(at + 2)
        named = frozenset[int]().union(*(region.members for region in route if region.members is not None))
        here = route[at].members or frozenset()
        shared = here & frozenset[int]().union(*(route[to].members or () for to in onward))
        return cls(at, route[at], tuple((to, route[to].members) for to in onward), named, shared)

    def hops(self, graph: Graph, vertex: int) -> Iterable[Hop]:
        """Return the steps from a vertex; where regions overlap one of them stays there."""
        # Two elements of a chain may be one activity (a node and its component): the path goes from the one region to
        # the next without an arc.
        return (*graph[vertex], Hop(vertex, 0, -1)) if vertex in self.shared else graph[vertex]

    def regions(self, target: int, arc: int) -> Iterator[int]:
        """Yield the regions in which a step may arrive."""
        if arc < 0:
            yield from (to for to, members in self.onward if members is not None and target in members)
            return
        here = self.here
        if here.inside and (target not in self.named if here.members is None else target in here.members):
            yield self.at
        # Where regions overlap the path must pass from one to the next in what they share, not along an arc.
        if self.shared or (here.leave is not None and arc not in here.leave):
            return
        for to, members in self.onward:
            if target not in self.named if members is None else target in members:
                yield to


def _entries(graph: Graph, region: Region) -> list[int]:
    """Return the vertices at which a path may start: those that nothing inside the region feeds, or all."""
    members = sorted(region.members or ())
    fed = (
        {hop.target for vertex in members for hop in graph[vertex] if hop.target != vertex} if region.inside else set()
    )
    return [vertex for vertex in members if vertex not in fed] or members


def in_order(after: Sequence[Sequence[Hop]], kept: Sequence[int]) -> list[int] | None:
    """Sort states so that all hops lead forward; None where there are loops."""
    inside = bytearray(len(after))
    for state in kept:
        inside[state] = 1
    waiting = [0] * len(after)
    for state in kept:
        for hop in after[state]:
            waiting[hop.target] += 1
    order = [state for state in kept if not waiting[state]]
    # Kahn's algorithm: `order` grows while it is walked through.
    for state in order:
        for hop in after[state]:
            waiting[hop.target] -= 1
            if not waiting[hop.target] and inside[hop.target]:
                order.append(hop.target)
    # States in a loop never lose their last open input, so that they are missing from the order.
    return order if len(order) == len(kept) else None


def unfolded(rough: States, kept: Sequence[int]) -> States | None:
    """Tell states apart by what was visited of the loop that they lie in; None where that makes too many.

    No path through the result visits a state of a loop twice.
    """
    alive = set(kept)
    ring: dict[int, tuple[int, int]] = {}
    for number, members in enumerate(rings({s: [h.target for h in rough.after[s] if h.target in alive] for s in kept})):
        # One bit for each state of a loop: what was visited is a bit mask, forgotten as soon as the path leaves the
        # loop.
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
        # The number may grow exponentially with the size of a loop, so it is capped while it grows.
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
    return States(
        [rough.vertex[state] for state, _ in found],
        after,
        starts,
        [number for number, (state, _) in enumerate(found) if state in ends],
    )


def _bit(ring: dict[int, tuple[int, int]], state: int, target: int, visited: int) -> int | None:
    """Return what is visited after a step; None where the step returns to what was visited."""
    if target not in ring:
        return 0
    number, bit = ring[target]
    if state in ring and ring[state][0] == number:
        return None if visited & bit else visited | bit
    return bit


def without_returns(rough: States, kept: Sequence[int]) -> tuple[States, tuple[int, ...]]:
    """Leave out the arcs that lead back in a depth-first search from the starts, and return them as well."""
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
    return States(rough.vertex, after, rough.starts, rough.ends), tuple(dict.fromkeys(cut))
