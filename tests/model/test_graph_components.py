"""Strong components and loops against reachability."""

from __future__ import annotations

from random import Random

import pytest

from archgen.model.graph_search import find_rings, find_strong_components


@pytest.mark.parametrize("seed", range(60))
def test_members_reach_one_another_and_components_come_in_order(seed: int) -> None:
    dice = Random(seed)  # noqa: S311 - a test's dice
    names = list(range(dice.randint(1, 9)))
    successors = {name: [other for other in names if dice.random() < 0.2] for name in names}
    reached = {name: set(successors[name]) for name in names}
    for _ in names:
        reached = {name: reached[name].union(*(reached[other] for other in reached[name])) for name in names}
    components = find_strong_components(names, successors.__getitem__)
    assert sorted(name for component in components for name in component) == names
    place = {name: index for index, component in enumerate(components) for name in component}
    for name in names:
        for other in names:
            together = name == other or (other in reached[name] and name in reached[other])
            assert (place[name] == place[other]) is together
            if other in reached[name]:
                assert place[name] <= place[other]
    assert all(list(component) == sorted(component) for component in components)
    expected = [component for component in components if component[0] in reached[component[0]]]
    assert find_rings(successors) == sorted(expected)


def test_elements_beyond_those_asked_for_come_last() -> None:
    successors = {"a": ["x"], "x": ["b"], "b": ["a"]}
    assert find_strong_components(["b", "a"], successors.__getitem__) == [("b", "a", "x")]
    assert find_rings({"a": ["a"], "b": ["c"], "c": []}) == [("a",)]
    assert find_rings({"a": ["gone"], "b": ["b", "b"]}) == [("b",)]
