"""The states (region, vertex) of a route: explored, freed of dead ends, and unfolded or cut where they make loops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.frozen import NamedTuple, dataclass
from archgen.model.graph_search import find_reachable, find_rings

MAX_STATES = 20_000
"""How many states the unfolding of loops may make before arcs that lead back are cut instead."""


class Hop(NamedTuple):
    """One arc with its cost; `arc` is -1 for a step that stays at its vertex."""

    target: int
    cost: int
    arc: int


CostGraph = Sequence[Sequence[Hop]]
"""The hops from each vertex."""


@dataclass(frozen=True, slots=True)
class RouteRegion:
    """Vertices that a path may visit in turn. None means every vertex that no other region names.

    With `inside` a path may move along arcs between them. `leaving_arcs` are those by which it may go on (None: all).
    An `optional` region may be skipped.
    """

    members: frozenset[int] | None
    inside: bool = True
    leaving_arcs: frozenset[int] | None = None
    optional: bool = False


@dataclass(frozen=True, slots=True)
class StateGraph:
    """States as they are found, loops and dead ends included: each one's vertex and hops, the first and last ones."""

    vertices: list[int]
    hops: list[list[Hop]]
    start_states: list[int]
    end_states: list[int]

    @classmethod
    def explore_route(cls, graph: CostGraph, route: Sequence[RouteRegion], *, longest: bool) -> StateGraph:
        """Go forward from the first region's entries to all states that can be reached."""
        state_numbers: list[dict[int, int]] = [{} for _ in route]
        found_states: list[tuple[int, int]] = []
        all_hops: list[list[Hop]] = []
        starts = [_number_state(state_numbers, found_states, 0, vertex) for vertex in _entry_vertices(graph, route[0])]
        exits = [_RegionExits.of_region(route, region) for region in range(len(route))]
        # Breadth first: `found_states` grows while it is walked through, and `all_hops` has one entry for each that is
        # done.
        while len(all_hops) < len(found_states):
            region, vertex = found_states[len(all_hops)]
            best_hops: dict[int, Hop] = {}
            for target, cost, arc in exits[region].hops_from(graph, vertex):
                # An arc from an activity to itself is no step of a path.
                if target == vertex and arc >= 0:
                    continue
                for next_region in exits[region].regions_reached(target, arc):
                    state = state_numbers[next_region].get(target)
                    if state is None:
                        state = _number_state(state_numbers, found_states, next_region, target)
                    # Of parallel arcs (several topics) only the extreme one is kept: a path is known by its vertices.
                    old_hop = best_hops.get(state)
                    if old_hop is None or (cost > old_hop[1] if longest else cost < old_hop[1]):
                        best_hops[state] = Hop(state, cost, arc)
            all_hops.append(list(best_hops.values()))
        last = len(route) - 1
        last_states = [state for state, (region, _) in enumerate(found_states) if region == last]
        # A path ends where nothing leads on in the last region, or anywhere in it if all of it is loops.
        end_states = [state for state in last_states if not all_hops[state]] or last_states
        return cls([vertex for _, vertex in found_states], all_hops, starts, end_states)

    def states_on_paths(self) -> list[int]:
        """Return the states from which the end can be reached (all can be reached from the start)."""
        predecessors: list[list[int]] = [[] for _ in self.hops]
        for state, hops in enumerate(self.hops):
            for hop in hops:
                predecessors[hop.target].append(state)
        return sorted(find_reachable(dict(enumerate(predecessors)), self.end_states))


def _number_state(
    state_numbers: list[dict[int, int]], found_states: list[tuple[int, int]], region: int, vertex: int
) -> int:
    """Return the number of a state, a new one where it has none."""
    if vertex not in state_numbers[region]:
        state_numbers[region][vertex] = len(found_states)
        found_states.append((region, vertex))
    return state_numbers[region][vertex]


@dataclass(frozen=True, slots=True)
class _RegionExits:
    """Where a path may go from a region: inside it, and on. Where two regions overlap, it passes in what they share."""

    index: int
    region: RouteRegion
    next_regions: tuple[tuple[int, frozenset[int] | None], ...]
    named_vertices: frozenset[int]
    shared_vertices: frozenset[int]

    @classmethod
    def of_region(cls, route: Sequence[RouteRegion], index: int) -> _RegionExits:
        """Look at a route from one of its regions."""
        next_indices = [index + 1] if index + 1 < len(route) else []
        if next_indices and route[next_indices[0]].optional:
            next_indices.append(index + 2)
        named_vertices = frozenset[int]().union(*(region.members for region in route if region.members is not None))
        region_members = route[index].members or frozenset()
        shared_vertices = region_members & frozenset[int]().union(
            *(route[next_index].members or () for next_index in next_indices)
        )
        return cls(
            index,
            route[index],
            tuple((next_index, route[next_index].members) for next_index in next_indices),
            named_vertices,
            shared_vertices,
        )

    def hops_from(self, graph: CostGraph, vertex: int) -> Iterable[Hop]:
        """Return the steps from a vertex; where regions overlap one of them stays there."""
        # Two elements of a chain may be one activity (a node and its component): the path goes from the one region to
        # the next without an arc.
        return (*graph[vertex], Hop(vertex, 0, -1)) if vertex in self.shared_vertices else graph[vertex]

    def regions_reached(self, target: int, arc: int) -> Iterator[int]:
        """Yield the regions in which a step may arrive."""
        if arc < 0:
            yield from (
                next_index for next_index, members in self.next_regions if members is not None and target in members
            )
            return
        region = self.region
        if region.inside and (
            target not in self.named_vertices if region.members is None else target in region.members
        ):
            yield self.index
        # Where regions overlap the path must pass from one to the next in what they share, not along an arc.
        if self.shared_vertices or (region.leaving_arcs is not None and arc not in region.leaving_arcs):
            return
        for next_index, members in self.next_regions:
            if target not in self.named_vertices if members is None else target in members:
                yield next_index


def _entry_vertices(graph: CostGraph, region: RouteRegion) -> list[int]:
    """Return the vertices at which a path may start: those that nothing inside the region feeds, or all."""
    members = sorted(region.members or ())
    fed_vertices = (
        {hop.target for vertex in members for hop in graph[vertex] if hop.target != vertex} if region.inside else set()
    )
    return [vertex for vertex in members if vertex not in fed_vertices] or members


def sort_topologically(all_hops: Sequence[Sequence[Hop]], kept_states: Sequence[int]) -> list[int] | None:
    """Sort states so that all hops lead forward; None where there are loops."""
    is_inside = bytearray(len(all_hops))
    for state in kept_states:
        is_inside[state] = 1
    in_degrees = [0] * len(all_hops)
    for state in kept_states:
        for hop in all_hops[state]:
            in_degrees[hop.target] += 1
    order = [state for state in kept_states if not in_degrees[state]]
    # Kahn's algorithm: `order` grows while it is walked through.
    for state in order:
        for hop in all_hops[state]:
            in_degrees[hop.target] -= 1
            if not in_degrees[hop.target] and is_inside[hop.target]:
                order.append(hop.target)
    # States in a loop never lose their last open input, so that they are missing from the order.
    return order if len(order) == len(kept_states) else None


def unfold_loops(state_graph: StateGraph, kept_states: Sequence[int]) -> StateGraph | None:
    """Tell states apart by what was visited of the loop that they lie in; None where that makes too many.

    No path through the result visits a state of a loop twice.
    """
    alive_states = set(kept_states)
    ring_bits: dict[int, tuple[int, int]] = {}
    for number, members in enumerate(
        find_rings({s: [h.target for h in state_graph.hops[s] if h.target in alive_states] for s in kept_states})
    ):
        # One bit for each state of a loop: what was visited is a bit mask, forgotten as soon as the path leaves the
        # loop.
        ring_bits |= {state: (number, 1 << visited_bits) for visited_bits, state in enumerate(members)}
    state_numbers: dict[tuple[int, int], int] = {}
    unfolded_states: list[tuple[int, int]] = []

    def number_state(state: int, visited: int) -> int:
        number = state_numbers.get((state, visited))
        if number is None:
            number = state_numbers[state, visited] = len(unfolded_states)
            unfolded_states.append((state, visited))
        return number

    starts = [
        number_state(state, ring_bits[state][1] if state in ring_bits else 0)
        for state in state_graph.start_states
        if state in alive_states
    ]
    all_hops: list[list[Hop]] = []
    while len(all_hops) < len(unfolded_states):
        # The number may grow exponentially with the size of a loop, so it is capped while it grows.
        if len(unfolded_states) > MAX_STATES:
            return None
        state, visited = unfolded_states[len(all_hops)]
        hops: list[Hop] = []
        for hop in state_graph.hops[state]:
            if hop.target in alive_states:
                visited_bits = _visited_after(ring_bits, state, hop.target, visited)
                if visited_bits is not None:
                    hops.append(Hop(number_state(hop.target, visited_bits), hop.cost, hop.arc))
        all_hops.append(hops)
    end_states = set(state_graph.end_states)
    return StateGraph(
        [state_graph.vertices[state] for state, _ in unfolded_states],
        all_hops,
        starts,
        [number for number, (state, _) in enumerate(unfolded_states) if state in end_states],
    )


def _visited_after(ring_bits: dict[int, tuple[int, int]], state: int, target: int, visited: int) -> int | None:
    """Return what is visited after a step; None where the step returns to what was visited."""
    if target not in ring_bits:
        return 0
    number, bit = ring_bits[target]
    if state in ring_bits and ring_bits[state][0] == number:
        return None if visited & bit else visited | bit
    return bit


def cut_returns(state_graph: StateGraph, kept_states: Sequence[int]) -> tuple[StateGraph, tuple[int, ...]]:
    """Leave out the arcs that lead back in a depth-first search from the starts, and return them as well."""
    alive_states = set(kept_states)
    all_hops: list[list[Hop]] = [[] for _ in state_graph.hops]
    cut_arcs: list[int] = []
    colours = bytearray(len(state_graph.hops))  # 1 on the way, 2 done
    for start in state_graph.start_states:
        if start not in alive_states or colours[start]:
            continue
        colours[start] = 1
        stack = [(start, iter(state_graph.hops[start]))]
        while stack:
            state, hops = stack[-1]
            hop = next(hops, None)
            if hop is None:
                colours[state] = 2
                stack.pop()
            elif hop.target in alive_states and colours[hop.target] == 1:
                cut_arcs.append(hop.arc)
            elif hop.target in alive_states:
                all_hops[state].append(hop)
                if not colours[hop.target]:
                    colours[hop.target] = 1
                    stack.append((hop.target, iter(state_graph.hops[hop.target])))
    return StateGraph(state_graph.vertices, all_hops, state_graph.start_states, state_graph.end_states), tuple(
        dict.fromkeys(cut_arcs)
    )
