"""How much a picture of changes may hold before it leaves out what stands around them, and before it folds groups."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Budget:
    """`around` is the most boxes with unchanged neighbours among them, `boxes` the most without, `arrows` the most arrows."""

    around: int
    boxes: int
    arrows: int


LARGE = Budget(around=30, boxes=45, arrows=70)
"""For a page or a screen."""
SMALL = Budget(around=14, boxes=25, arrows=40)
"""For a comment on a pull request."""
