"""How long messages wait that are matched by time, as message_filters' ApproximateTime does it.

The time of a message is the activation of its source. Let g be the largest time between two messages of an input, D and d
the longest and shortest time from a message's time until it arrives, w how far apart matched messages may be.

- A set is given out at the latest when each input has a message that is later than the set's pivot: then none can come
  that makes a smaller set with it. The pivot is at most w later than any message of the set. So a set is complete
  w + max (g + D) after the time of each of its messages.
- If at most one input has g > w, a set is sure. What follows the last set is at most g later, input by input, and of
  each input with g <= w one message lies within w before the latest of those that come first; what is older is dropped.
  Of the one with g > w, the first message that is not dropped is at most g after what was dropped. So the pivot of the
  first set with a message not before t of an input i is at most t + max g + max (w, g_i) (both without i) later.
- Messages of one job have the same time, and are matched with one another at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class MatchedInput(NamedTuple):
    """An input that is matched, in ticks: the largest gap between the times of its messages, and how long they take."""

    gap: int
    best: int
    worst: int


class MatchWindows(NamedTuple):
    """What is sure of matched inputs, in ticks.

    `ages` are from the time of a message until the activation that uses it. `waits`, by input, are from the arrival of a
    message until an activation that uses it or a newer one, None where no match is sure. `gap` is the largest between two
    activations, None where no match is sure; `needed_within` is the least `within` for which one is.
    """

    ages: tuple[int, ...]
    waits: tuple[int, ...] | None
    gap: int | None
    needed_within: int


def find_match_windows(inputs: Sequence[MatchedInput], within: int, *, same_source: bool) -> MatchWindows:
    """Return what is sure of matched inputs; `same_source`: each message has its partners of the very same job."""
    if same_source or len(inputs) == 1:
        latest = max(each.worst for each in inputs)
        spread = latest - max(each.best for each in inputs)
        return MatchWindows(
            (latest,) * len(inputs),
            tuple(latest - each.best for each in inputs),
            max(each.gap for each in inputs) + spread,
            0,
        )
    proof = max(each.gap + each.worst for each in inputs)
    needed_within = sorted(each.gap for each in inputs)[-2]
    ages = (within + proof,) * len(inputs)
    # Equal times of different sources are a coincidence, however often they send.
    if within < needed_within or within == 0:
        return MatchWindows(ages, None, None, needed_within)
    reaches = [_latest_pivot(inputs, index, within) + proof for index in range(len(inputs))]
    return MatchWindows(
        ages,
        tuple(reach - each.best for reach, each in zip(reaches, inputs, strict=True)),
        min(each.gap + reach - each.best for reach, each in zip(reaches, inputs, strict=True)),
        needed_within,
    )


def _latest_pivot(inputs: Sequence[MatchedInput], index: int, within: int) -> int:
    """Return how much later than a message of an input the pivot of the first set is that holds it or a newer one."""
    other_gap = max(each.gap for number, each in enumerate(inputs) if number != index)
    return other_gap + max(within, inputs[index].gap)
