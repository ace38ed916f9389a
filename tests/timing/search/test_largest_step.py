"""The largest step at which something still holds: exact, and in few looks."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.timing.search.chain_budgets import climb_steps, find_largest_step


def _count_looks(slack_at: Callable[[int], Fraction | None]) -> tuple[Callable[[int], Fraction | None], list[int]]:
    looks: list[int] = []

    def look(step: int) -> Fraction | None:
        looks.append(step)
        return slack_at(step)

    return look, looks


SHAPES: dict[str, Callable[[int], Fraction | None]] = {
    "a straight line": lambda step: Fraction(700_001 - step),
    "steep": lambda step: Fraction(2_000_000 - 7 * step),
    "stairs": lambda step: Fraction(1_000_000 - 90_000 * (step // 50_000)),
    "a wall": lambda step: Fraction(5) if step < 123_456 else None,
    "a line up to a wall": lambda step: Fraction(900_000 - step) if step < 400_000 else None,
    "bent": lambda step: Fraction(10**12 - step * step),
}


def _find_last(slack_at: Callable[[int], Fraction | None]) -> int:
    """Return the last step up to a million at which a shape holds: none of them begins to hold again."""

    def is_over(step: int) -> bool:
        slack = slack_at(step)
        return slack is None or slack < 0

    return bisect_left(range(1_000_001), x=True, key=is_over) - 1


@pytest.mark.parametrize("shape", SHAPES)
def test_the_last_step_that_holds_is_found(shape: str) -> None:
    slack_at = SHAPES[shape]
    last = _find_last(slack_at)
    look, looks = _count_looks(slack_at)
    assert find_largest_step(look, 0, 1_000_001, slack_at(0), slack_at(1_000_001)) == last
    assert len(looks) <= 40


@pytest.mark.parametrize(("shape", "most"), [("a straight line", 2), ("a wall", 40), ("stairs", 45)])
def test_a_climb_ends_at_the_last_step_that_holds(shape: str, most: int) -> None:
    slack_at = SHAPES[shape]
    last = _find_last(slack_at)
    look, looks = _count_looks(slack_at)
    start_slack = slack_at(1_000)
    assert start_slack is not None
    assert climb_steps(look, 1_000, 1_000_001, start_slack, Fraction(1)) == last
    assert len(looks) <= most


def test_what_holds_up_to_the_limit_has_no_last_step() -> None:
    assert climb_steps(lambda _: Fraction(5), 3, 1_000, Fraction(5), Fraction(1)) is None
