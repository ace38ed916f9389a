"""The largest whole number at which something still holds, in few looks: a secant of exact figures, or halves."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

SlackFunction = Callable[[int], Fraction | None]
"""How much is left of a deadline at a step; None where nothing is known to be left. It grows with no step."""


def find_largest_step(
    slack_at: SlackFunction, low: int, high: int, low_slack: Fraction | None = None, high_slack: Fraction | None = None
) -> int:
    """Return the largest step from `low` to `high` - 1 at which slack is left.

    It is left at `low`, and not at `high`, neither of which is looked at again.
    """
    side, repeats = 0, 0
    while high - low > 1:
        middle = _choose_step(low, high, low_slack, high_slack if repeats < 1 else None)
        slack = slack_at(middle)
        new_side = 1 if _is_left(slack) else -1
        # A secant that always moves the same end comes closer in ever smaller steps: then a half does more.
        repeats = repeats + 1 if new_side == side else 0
        side = new_side
        if new_side > 0:
            low, low_slack = middle, slack
        else:
            high, high_slack = middle, slack
    return low


def climb_steps(slack_at: SlackFunction, start: int, limit: int, start_slack: Fraction, fall: Fraction) -> int | None:
    """Return the largest step from `start` up to `limit` at which slack is left; None where it is left at `limit`.

    `fall` is the slack that each step takes at least, where it takes any: so far the first look goes.
    """
    low, slack, stride = start, start_slack, 0
    while True:
        stride = max(1, 2 * stride, int(slack / fall)) if slack else max(1, 2 * stride)
        step = min(low + stride, limit)
        new_slack = slack_at(step)
        if not _is_left(new_slack):
            return find_largest_step(slack_at, low, step, slack, new_slack)
        if step == limit:
            return None
        # Where the first look was right, nothing is left for another one: the next step decides.
        stride = stride if new_slack == slack else 0
        low, slack = step, new_slack or Fraction(0)


def _is_left(slack: Fraction | None) -> bool:
    return slack is not None and slack >= 0


def _choose_step(low: int, high: int, low_slack: Fraction | None, high_slack: Fraction | None) -> int:
    """Return where a straight line through both ends leaves nothing, else the middle."""
    if low_slack is None or high_slack is None or low_slack <= high_slack:
        return (low + high) // 2
    step = low + int(low_slack * (high - low) / (low_slack - high_slack))
    return min(max(step, low + 1), high - 1)
