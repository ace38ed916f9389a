"""The searches on graphs: what can be reached, strong components in order, rings."""

from __future__ import annotations

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from archgen.model.graph_search import (
    find_reach_masks,
    find_reachable,
    find_rings,
    find_strong_components,
    is_ring,
)

GRAPHS = st.dictionaries(st.integers(0, 9), st.lists(st.integers(0, 9), max_size=4), max_size=10).map(
    lambda given: {element: given.get(element, []) for element in range(10)}
)


def test_reach_counts_steps() -> None:
    neighbours = {"a": ("b", "c"), "b": ("d",), "c": ("d",), "d": ("a",)}
    assert find_reachable(neighbours, ["a"]) == {"a": 0, "b": 1, "c": 1, "d": 2}
    assert find_reachable(neighbours, ["a"], 1) == {"a": 0, "b": 1, "c": 1}
    assert find_reachable(neighbours, ["x"], 0) == {"x": 0}
    # The step with which they are enough is taken whole.
    assert find_reachable(neighbours, ["a"], enough=2) == {"a": 0, "b": 1, "c": 1}
    assert find_reachable(neighbours, ["a"], enough=1) == {"a": 0}


def test_rings_are_found_without_recursion() -> None:
    chain = {at: [at + 1] for at in range(50_000)}
    assert find_rings(chain) == []
    assert find_rings({**chain, 50_000: [49_999], 7: [7, 8]}) == [(7,), (49_999, 50_000)]


@given(GRAPHS)
def test_members_of_a_strong_component_reach_one_another(graph: dict[int, list[int]]) -> None:
    components = find_strong_components(graph, graph.__getitem__)
    component_of = {member: component for component in components for member in component}
    reached = {element: find_reachable(graph, [element]) for element in graph}
    assert sorted(member for component in components for member in component) == sorted(graph)
    for one, other in combinations(graph, 2):
        both_ways = other in reached[one] and one in reached[other]
        assert both_ways == (component_of[one] is component_of[other])


@given(GRAPHS)
def test_a_strong_component_comes_behind_all_that_lead_to_it(graph: dict[int, list[int]]) -> None:
    components = find_strong_components(graph, graph.__getitem__)
    position = {member: number for number, component in enumerate(components) for member in component}
    assert all(position[element] <= position[successor] for element in graph for successor in graph[element])


@given(GRAPHS)
def test_a_ring_is_what_leads_back_to_itself(graph: dict[int, list[int]]) -> None:
    components = find_strong_components(graph, graph.__getitem__)
    looped = [component for component in components if component[0] in find_reachable(graph, graph[component[0]])]
    assert [component for component in components if is_ring(component, graph)] == looped
    assert sorted(find_rings(graph)) == sorted(looped)


@given(GRAPHS)
def test_masks_hold_what_is_reached(graph: dict[int, list[int]]) -> None:
    masks = find_reach_masks(graph)
    bits = {element: {at for at in range(10) if mask >> at & 1} for element, mask in masks.items()}
    for one, other in combinations(graph, 2):
        reached = find_reachable(graph, [one]), find_reachable(graph, [other])
        assert len(bits[one]) == len(reached[0])
        assert len(bits[one] | bits[other]) == len(reached[0] | reached[1])
        assert len(bits[one] & bits[other]) == len(reached[0].keys() & reached[1].keys())
