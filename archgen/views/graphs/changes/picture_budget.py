"""How large a picture of changes may be before it omits unchanged neighbours, and before it folds groups."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PictureBudget:
    """`boxes_with_neighbours` is the maximal number of boxes including unchanged neighbours, `boxes` without them."""

    boxes_with_neighbours: int
    boxes: int
    arrows: int


LARGE_BUDGET = PictureBudget(boxes_with_neighbours=30, boxes=45, arrows=70)
"""For a page or a screen."""
SMALL_BUDGET = PictureBudget(boxes_with_neighbours=14, boxes=25, arrows=40)
"""For a comment on a pull request."""
