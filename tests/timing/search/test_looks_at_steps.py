"""Where a search for the largest step looks: each look costs an analysis, so that none may be wasted."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.timing.search.chain_budgets import climb_steps, find_largest_step

Slack = Callable[[int], int | None]


def _note_looks(slack_at: Slack) -> tuple[Callable[[int], Fraction | None], list[int]]:
    looks: list[int] = []

    def look(step: int) -> Fraction | None:
        looks.append(step)
        slack = slack_at(step)
        return None if slack is None else Fraction(slack)

    return look, looks


@pytest.mark.parametrize(
    ("slack_at", "start_slack", "fall", "last", "looks"),
    [
        # As far as the slack reaches, then twice as far, as long as it stays the same; halves from there.
        (lambda step: 5 if step < 20 else None, 5, 1, 19, [5, 15, 35, 25, 20, 17, 18, 19]),
        # A line: as far as is left for at most; the last look shows that nothing is.
        (lambda step: 10 - step, 10, 2, 10, [5, 7, 8, 9, 10, 11]),
        # Nothing to spare, and nothing taken: one step, two, four.
        (lambda step: 0 if step < 7 else None, 0, 1, 6, [1, 3, 7, 5, 6]),
        (lambda step: 0 if step < 3 else -1, 0, 1, 2, [1, 3, 2]),
        # Up to the limit, which is looked at.
        (lambda _: 40, 40, 1, None, [40, 100]),
    ],
)
def test_a_climb(slack_at: Slack, start_slack: int, fall: int, last: int | None, looks: list[int]) -> None:
    look, seen = _note_looks(slack_at)
    assert climb_steps(look, 0, 100, Fraction(start_slack), Fraction(fall)) == last
    assert seen == looks


@pytest.mark.parametrize(
    ("slack_at", "last", "looks"),
    [
        # A straight line shows the step, and the next look that it is the last one.
        (lambda step: 30 - 2 * step, 15, [15, 16]),
        # A curve: after two looks on the same side a half.
        (lambda step: 100 - step * step, 10, [1, 2, 51, 3, 4, 27, 6, 7, 17, 9, 10, 13, 11]),
    ],
)
def test_a_search_between_two_ends(slack_at: Slack, last: int, looks: list[int]) -> None:
    look, seen = _note_looks(slack_at)
    low_slack, high_slack = (Fraction(slack_at(step) or 0) for step in (0, 100))
    assert find_largest_step(look, 0, 100, low_slack, high_slack) == last
    assert seen == looks


def test_ends_whose_slack_nobody_knows_are_halved() -> None:
    look, seen = _note_looks(lambda step: None if step > 3 else 0)
    assert find_largest_step(look, 0, 10) == 3
    assert seen == [5, 2, 3, 4]


def test_neighbouring_steps_need_no_look() -> None:
    look, seen = _note_looks(lambda _: 0)
    assert find_largest_step(look, 4, 5) == 4
    assert seen == []
