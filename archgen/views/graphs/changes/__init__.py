"""Pictures of what changed: two versions laid over each other, removed elements taken from the first one.

A sign before each title says what was added, removed, changed or renamed; lines and colours repeat it. Unchanged
neighbours are grey. Above a budget groups are folded, and the picture says so.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare import Comparison
from archgen.views.graphs.changes.component_changes import draw_component_changes
from archgen.views.graphs.changes.merged_versions import LARGE_BUDGET, SMALL_BUDGET, PictureBudget
from archgen.views.graphs.changes.node_changes import draw_node_changes
from archgen.views.picture_shapes import Graph

__all__ = ["LARGE_BUDGET", "SMALL_BUDGET", "PictureBudget", "draw_changes"]


def draw_changes(comparison: Comparison, budget: PictureBudget = LARGE_BUDGET) -> tuple[Graph, ...]:
    """Draw the changed components, then the changed nodes; no picture if nothing changed that it could show."""
    return tuple(_draw_pictures(comparison, budget))


def _draw_pictures(comparison: Comparison, budget: PictureBudget) -> Iterator[Graph]:
    for draw_picture in (draw_component_changes, draw_node_changes):
        graph = draw_picture(comparison, budget)
        if graph:
            yield graph
