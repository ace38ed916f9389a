"""Ways without listing them, against listing them; and their speed."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from archgen.timing.chains import path_states
from archgen.timing.chains.path_search import Hop, RouteRegion, find_paths
from tests.quiet_seconds import measure_quiet_seconds

Arcs = list[tuple[int, int, int]]


def _graph(count: int, arcs: Arcs) -> list[list[Hop]]:
    graph: list[list[Hop]] = [[] for _ in range(count)]
    for number, (source, target, cost) in enumerate(arcs):
        graph[source].append(Hop(target, cost, number))
    return graph


def _between(start: int, end: int) -> list[RouteRegion]:
    return [
        RouteRegion(frozenset([start]), inside=False),
        RouteRegion(None, optional=True),
        RouteRegion(frozenset([end]), inside=False),
    ]


def _listed(graph: list[list[Hop]], here: int, end: int, seen: frozenset[int]) -> Iterator[tuple[int, tuple[int, ...]]]:
    """List all ways that visit nothing twice."""
    if here == end:
        yield 0, ()
        return
    for hop in graph[here]:
        if hop.target not in seen:
            for cost, arcs in _listed(graph, hop.target, end, seen | {hop.target}):
                yield cost + hop.cost, (hop.arc, *arcs)


@pytest.mark.parametrize("seed", range(60))
def test_worst_best_and_number_are_those_of_all_ways_listed(seed: int) -> None:
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    count = dice.randint(2, 8)
    pairs = [(a, b) for a in range(count) for b in range(count) if a != b and dice.random() < 0.4]
    graph = _graph(count, [(a, b, dice.randrange(50)) for a, b in pairs])
    listed = sorted(_listed(graph, 0, count - 1, frozenset([0])), key=lambda way: -way[0])
    worst = find_paths(graph, [7] * count, _between(0, count - 1), longest=True)
    assert worst.path_count == len(listed)
    assert [way.cost for way in worst.best_paths(10**6)] == [cost + 7 for cost, _ in listed]
    assert {way.arcs for way in worst.best_paths(10**6)} == {arcs for _, arcs in listed}
    best = find_paths(graph, [7] * count, _between(0, count - 1), longest=False)
    assert [way.cost for way in best.best_paths(3)] == [cost + 7 for cost, _ in listed[::-1]][:3]
    assert worst.cut_arcs == ()


def test_a_loop_that_is_too_large_is_cut_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_states, "MAX_STATES", 3)
    graph = _graph(4, [(0, 1, 1), (1, 2, 1), (2, 1, 1), (2, 3, 1)])
    found = find_paths(graph, [0] * 4, _between(0, 3), longest=True)
    assert [(way.cost, way.arcs) for way in found.best_paths(9)] == [(3, (0, 1, 3))]
    assert found.cut_arcs == (2,)


def test_where_nothing_leads_there_is_no_way() -> None:
    found = find_paths(_graph(3, [(0, 1, 1)]), [0] * 3, _between(0, 2), longest=True)
    assert (found.path_count, list(found.best_paths(5))) == (0, [])


def test_a_way_through_a_set_may_move_inside_it() -> None:
    # 0 > {1, 2} > 3 with 1 > 2 inside: the worst way takes both.
    graph = _graph(4, [(0, 1, 1), (0, 2, 1), (1, 2, 10), (1, 3, 1), (2, 3, 1)])
    route = [
        RouteRegion(frozenset([0]), inside=False),
        RouteRegion(frozenset([1, 2])),
        RouteRegion(frozenset([3]), inside=False),
    ]
    assert [way.cost for way in find_paths(graph, [0] * 4, route, longest=True).best_paths(9)] == [12, 2, 2]


def test_a_region_is_left_by_its_output_only() -> None:
    graph = _graph(3, [(0, 1, 5), (0, 1, 3), (1, 2, 1)])
    route = [
        RouteRegion(frozenset([0]), inside=False, leaving_arcs=frozenset([1])),
        RouteRegion(None, optional=True),
        RouteRegion(frozenset([2])),
    ]
    assert [way.arcs for way in find_paths(graph, [0] * 3, route, longest=True).best_paths(9)] == [(1, 2)]


def _layers(wide: int, deep: int, each: int) -> list[list[Hop]]:
    dice = random.Random(5)  # noqa: S311 - a test's dice
    arcs = [
        (layer * wide + at, (layer + 1) * wide + other, dice.randrange(10**9))
        for layer in range(deep - 1)
        for at in range(wide)
        for other in dice.sample(range(wide), each)
    ]
    return _graph(wide * deep, arcs)


def test_the_worst_of_more_than_1e8_ways_are_found_at_once() -> None:
    graph = _layers(15, 20, 3)
    ends = [
        RouteRegion(frozenset(range(15)), inside=False),
        RouteRegion(None, optional=True),
        RouteRegion(frozenset(range(285, 300))),
    ]
    found = find_paths(graph, [0] * 300, ends, longest=True)
    assert sum(map(len, graph)) == 855
    assert found.path_count > 10**8
    costs = [way.cost for way in found.best_paths(100)]
    assert len(costs) == 100
    assert costs == sorted(costs, reverse=True)
    seconds = [
        measure_quiet_seconds(lambda: list(find_paths(graph, [0] * 300, ends, longest=True).best_paths(100)))
        for _ in range(3)
    ]
    assert min(seconds) < 0.1


def test_ten_thousand_elements_take_a_moment() -> None:
    graph = _layers(100, 100, 3)
    ends = [
        RouteRegion(frozenset(range(100)), inside=False),
        RouteRegion(None, optional=True),
        RouteRegion(frozenset(range(9900, 10_000))),
    ]
    assert find_paths(graph, [0] * 10_000, ends, longest=True).path_count > 10**40
    assert measure_quiet_seconds(lambda: next(find_paths(graph, [0] * 10_000, ends, longest=True).best_paths())) < 1
