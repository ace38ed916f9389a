"""Orders with little feedback: the best one for short loops, a good one for long ones, near the given order."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import pairwise, permutations

import pytest

from archgen.model.feedback_order import MAX_EXACT, order_by_feedback

Weights = dict[tuple[str, str], int]


def sum_feedback(elements: Sequence[str], weights: Weights) -> int:
    """Return how much flows back in an order."""
    positions = {element: position for position, element in enumerate(elements)}
    return sum(weight for (source, target), weight in weights.items() if positions[source] > positions[target])


@pytest.mark.parametrize(
    ("elements", "weights", "expected"),
    [
        ("abc", {("c", "b"): 1, ("b", "a"): 1}, "cba"),
        ("abc", {}, "abc"),
        ("abc", {("a", "b"): 1, ("b", "c"): 1, ("c", "a"): 5}, "cab"),
        ("abc", {("a", "b"): 5, ("b", "c"): 5, ("c", "a"): 1}, "abc"),
        ("ab", {("a", "a"): 9, ("b", "a"): 1}, "ba"),
        ("", {}, ""),
    ],
)
def test_what_feeds_comes_before_what_is_fed(elements: str, weights: Weights, expected: str) -> None:
    order = order_by_feedback(elements, weights)
    assert "".join(order.elements) == expected
    assert order.is_exact


@pytest.mark.parametrize("seed", range(12))
def test_no_order_of_a_short_loop_has_less_feedback(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311 - drawn anew each time would fail anew
    elements = "abcdef"
    weights = {(a, b): draw.randint(1, 9) for a in elements for b in elements if a != b and draw.random() < 0.5}
    best = min(sum_feedback(order, weights) for order in permutations(elements))
    found = order_by_feedback(elements, weights)
    assert sorted(found.elements) == list(elements)
    assert sum_feedback(found.elements, weights) == best


def test_a_long_loop_is_ordered_by_the_greedy_rule_and_that_is_said() -> None:
    names = [f"n{at:02}" for at in range(MAX_EXACT + 12)]
    weights = dict.fromkeys(pairwise(names), 3) | {(names[-1], names[0]): 1}
    shuffled = [*names[17:], *names[3:17], *names[:3]]
    order = order_by_feedback(shuffled, weights)
    assert not order.is_exact
    assert sorted(order.elements) == names
    assert sum_feedback(order.elements, weights) <= 3


def test_the_result_depends_on_nothing_but_the_input() -> None:
    weights = {("b", "a"): 1, ("a", "b"): 1, ("c", "a"): 2}
    assert order_by_feedback("abc", weights) == order_by_feedback("abc", dict(reversed(weights.items())))
