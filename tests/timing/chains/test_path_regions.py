"""Routes through regions of random graphs, against all paths listed; loops unfolded or cut; equal costs; what is extreme."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from itertools import pairwise

import pytest

from archgen.timing.chains import path_states
from archgen.timing.chains.path_search import Hop, RouteRegion, find_paths
from archgen.timing.chains.path_states import StateGraph, cut_returns, sort_topologically, unfold_loops

Arcs = Sequence[tuple[int, int, int]]


def _graph(count: int, arcs: Arcs) -> list[list[Hop]]:
    graph: list[list[Hop]] = [[] for _ in range(count)]
    for number, (source, target, cost) in enumerate(arcs):
        graph[source].append(Hop(target, cost, number))
    return graph


def _listed(graph: list[list[Hop]], path: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    """List all paths from the last vertex on that visit nothing twice."""
    yield path
    for hop in graph[path[-1]]:
        if hop.target not in path:
            yield from _listed(graph, (*path, hop.target))


@pytest.mark.parametrize("seed", range(40))
def test_paths_through_three_elements_are_those_of_all_listed(seed: int) -> None:
    """0, then anything else, then 1, then anything else, then 2: no vertex of the route in between."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    count = dice.randint(3, 7)
    pairs = [(a, b) for a in range(count) for b in range(count) if a != b and dice.random() < 0.45]
    arcs = [(a, b, dice.randrange(30)) for a, b in pairs]
    graph = _graph(count, arcs)
    costs = {(a, b): cost for a, b, cost in arcs}
    between = RouteRegion(None, optional=True)
    route = [RouteRegion(frozenset([0]), inside=False), between, RouteRegion(frozenset([1]), inside=False)]
    route += [between, RouteRegion(frozenset([2]), inside=False)]
    expected = sorted(
        (sum(costs[pair] for pair in pairwise(path)), path)
        for path in _listed(graph, (0,))
        if path[-1] == 2 and 1 in path
    )
    for longest in (True, False):
        found = find_paths(graph, [5] * count, route, longest=longest)
        paths = list(found.best_paths(10**4))
        # A path may pass the free regions with a vertex in both: those that visit nothing twice are the listed ones.
        simple = [
            path
            for path in paths
            if len({0, *(graph_arc[1] for graph_arc in map(arcs.__getitem__, path.arcs))}) == len(path.arcs) + 1
        ]
        assert [path.cost for path in simple] == sorted((cost + 5 for cost, _ in expected), reverse=longest)
        assert [path.cost for path in paths] == sorted((path.cost for path in paths), reverse=longest)
        assert all(path.start == 0 for path in paths)
        assert found.path_count == len(paths)


def test_of_parallel_arcs_the_extreme_one_counts() -> None:
    graph = _graph(2, [(0, 1, 3), (0, 1, 7), (0, 1, 5), (0, 0, 9)])
    route = [RouteRegion(frozenset([0]), inside=False), RouteRegion(frozenset([1]))]
    assert [(path.cost, path.arcs) for path in find_paths(graph, [0, 0], route, longest=True).best_paths(9)] == [
        (7, (1,))
    ]
    assert [(path.cost, path.arcs) for path in find_paths(graph, [0, 0], route, longest=False).best_paths(9)] == [
        (3, (0,))
    ]


@pytest.mark.parametrize(("longest", "arcs"), [(True, (3,)), (False, (2,))])
def test_the_extreme_one_counts_wherever_it_stands(longest: bool, arcs: tuple[int]) -> None:  # noqa: FBT001 - a parameter of the test
    graph = _graph(2, [(0, 1, 5), (0, 1, 5), (0, 1, 3), (0, 1, 7), (0, 1, 4)])
    route = [RouteRegion(frozenset([0]), inside=False), RouteRegion(frozenset([1]))]
    assert [path.arcs for path in find_paths(graph, [0, 0], route, longest=longest).best_paths(9)] == [arcs]


@pytest.mark.parametrize("longest", [True, False])
def test_of_equal_parallel_arcs_the_first_one_is_named(longest: bool) -> None:  # noqa: FBT001 - a parameter of the test
    graph = _graph(2, [(0, 1, 3), (0, 1, 3)])
    route = [RouteRegion(frozenset([0]), inside=False), RouteRegion(frozenset([1]))]
    assert [path.arcs for path in find_paths(graph, [0, 0], route, longest=longest).best_paths(9)] == [(0,)]


def test_a_start_costs_what_its_vertex_costs() -> None:
    graph = _graph(3, [(0, 2, 1), (1, 2, 1)])
    route = [RouteRegion(frozenset([0, 1])), RouteRegion(frozenset([2]))]
    paths = list(find_paths(graph, [10, 20, 99], route, longest=True).best_paths(9))
    assert [(path.cost, path.start) for path in paths] == [(21, 1), (11, 0)]


def test_a_path_starts_where_nothing_inside_the_region_leads() -> None:
    graph = _graph(3, [(0, 1, 4), (1, 2, 1), (0, 2, 2)])
    inside = [RouteRegion(frozenset([0, 1])), RouteRegion(frozenset([2]))]
    assert [path.cost for path in find_paths(graph, [0] * 3, inside, longest=True).best_paths(9)] == [5, 2]
    apart = [RouteRegion(frozenset([0, 1]), inside=False), RouteRegion(frozenset([2]))]
    assert [path.cost for path in find_paths(graph, [0] * 3, apart, longest=True).best_paths(9)] == [2, 1]
    ring = _graph(3, [(0, 1, 4), (1, 0, 4), (1, 2, 1)])
    assert [path.cost for path in find_paths(ring, [0] * 3, inside, longest=True).best_paths(9)] == [5, 1]


def test_where_regions_overlap_the_path_passes_without_an_arc() -> None:
    graph = _graph(3, [(0, 1, 4), (1, 2, 1), (0, 2, 8)])
    route = [RouteRegion(frozenset([0, 1])), RouteRegion(frozenset([1]), inside=False), RouteRegion(frozenset([2]))]
    paths = list(find_paths(graph, [0] * 3, route, longest=True).best_paths(9))
    assert [(path.cost, path.arcs) for path in paths] == [(5, (0, 1))]


def test_a_region_in_between_must_be_visited_unless_it_may_be_skipped() -> None:
    graph = _graph(3, [(0, 1, 4), (1, 2, 1), (0, 2, 2)])
    ends = RouteRegion(frozenset([0]), inside=False), RouteRegion(frozenset([2]))
    for optional, costs in ((True, [5, 2]), (False, [5])):
        route = [ends[0], RouteRegion(None, optional=optional), ends[1]]
        assert [path.cost for path in find_paths(graph, [0] * 3, route, longest=True).best_paths(9)] == costs


def test_only_so_many_paths_are_given() -> None:
    graph = _graph(4, [(0, 1, 1), (0, 2, 2), (1, 3, 1), (2, 3, 1)])
    route = [RouteRegion(frozenset([0])), RouteRegion(None, optional=True), RouteRegion(frozenset([3]))]
    found = find_paths(graph, [0] * 4, route, longest=True)
    assert [[path.cost for path in found.best_paths(limit)] for limit in (0, 1, 2, 3)] == [[], [3], [3, 2], [3, 2]]
    assert [path.cost for path in found.best_paths()] == [3]
    assert sorted(found.arcs_on_paths()) == [0, 1, 2, 3]


def test_arcs_that_lead_nowhere_lie_on_no_path() -> None:
    graph = _graph(5, [(0, 1, 1), (1, 3, 1), (0, 2, 9), (1, 4, 9)])
    route = [RouteRegion(frozenset([0])), RouteRegion(None, optional=True), RouteRegion(frozenset([3]))]
    found = find_paths(graph, [0] * 5, route, longest=True)
    assert (sorted(found.arcs_on_paths()), found.path_count) == ([0, 1], 1)


def test_states_are_sorted_only_where_there_is_no_loop() -> None:
    graph = _graph(4, [(2, 0, 1), (0, 1, 1), (2, 1, 1), (1, 3, 1)])
    assert sort_topologically(graph, [0, 1, 2, 3]) == [2, 0, 1, 3]
    assert sort_topologically(graph, [1, 3]) == [1, 3]
    assert sort_topologically(_graph(2, [(0, 1, 1), (1, 0, 1)]), [0, 1]) is None


def _state_graph(arcs: Arcs, count: int) -> StateGraph:
    return StateGraph(list(range(count)), _graph(count, arcs), [0], [count - 1])


LOOP = ((0, 1, 1), (1, 2, 1), (2, 1, 1), (2, 3, 1), (0, 2, 5))


def test_a_loop_is_unfolded_by_what_was_visited(monkeypatch: pytest.MonkeyPatch) -> None:
    """0, then 1 alone, 2 alone, both by way of 1, both by way of 2, and 3: the ring of 1 and 2 has two bits."""
    unfolded = unfold_loops(_state_graph(LOOP, 4), range(4))
    assert unfolded is not None
    assert sorted(unfolded.vertices) == [0, 1, 1, 2, 2, 3]
    assert len(unfolded.end_states) == 1
    assert unfold_loops(_state_graph(LOOP, 4), [0, 1]) is not None
    monkeypatch.setattr(path_states, "MAX_STATES", 6)
    assert unfold_loops(_state_graph(LOOP, 4), range(4)) is not None
    monkeypatch.setattr(path_states, "MAX_STATES", 5)
    assert unfold_loops(_state_graph(LOOP, 4), range(4)) is None


def test_arcs_that_lead_back_are_cut_once() -> None:
    cut, arcs = cut_returns(_state_graph(LOOP, 4), range(4))
    assert arcs == (2,)
    assert [[hop.arc for hop in hops] for hops in cut.hops] == [[0, 4], [1], [3], []]
    nothing, none = cut_returns(_state_graph(LOOP, 4), [1, 2])
    assert (nothing.hops, none) == ([[], [], [], []], ())
    part, arcs = cut_returns(_state_graph(LOOP, 4), [0, 1, 3])
    assert ([[hop.arc for hop in hops] for hops in part.hops], arcs) == ([[0], [], [], []], ())


def test_an_arc_back_to_the_start_is_cut() -> None:
    """0 > 1 > 2 is left; of the ring of 0 and 1 the arc that leads back to where the path began goes."""
    cut, arcs = cut_returns(_state_graph(((0, 1, 1), (1, 0, 1), (1, 2, 1)), 3), range(3))
    assert ([[hop.arc for hop in hops] for hops in cut.hops], arcs) == ([[0], [2], []], (1,))


def test_an_arc_from_an_element_to_itself_is_no_step() -> None:
    """1 is an end though an arc leads from it to itself, be it the first of all arcs."""
    graph = _graph(3, [(1, 1, 9), (0, 1, 5), (0, 2, 1)])
    route = [RouteRegion(frozenset([0]), inside=False), RouteRegion(frozenset([1, 2]))]
    assert [path.arcs for path in find_paths(graph, [0] * 3, route, longest=True).best_paths(9)] == [(1,), (2,)]


def test_from_what_regions_share_a_path_passes_over_what_may_be_skipped() -> None:
    graph = _graph(4, [(0, 1, 4), (1, 2, 1), (1, 3, 7), (3, 2, 7)])
    route = [RouteRegion(frozenset([0, 1])), RouteRegion(None, optional=True), RouteRegion(frozenset([1, 2]))]
    assert [path.arcs for path in find_paths(graph, [0] * 4, route, longest=True).best_paths(9)] == [(0, 1)]
