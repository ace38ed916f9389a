"""Pictures of what changed: two versions laid over each other, removed elements taken from the first one.

A sign before each title says what was added, removed, changed or renamed; lines and colours repeat it. Unchanged
neighbours are grey. Above a budget groups are folded, and the picture says so.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare import Comparison
from archgen.views.graphs.changes.budget import LARGE, SMALL, Budget
from archgen.views.graphs.changes.functional import functional
from archgen.views.graphs.changes.implementation import implementation
from archgen.views.shapes import Graph

__all__ = ["LARGE", "SMALL", "Budget", "pictures"]


def pictures(found: Comparison, budget: Budget = LARGE) -> tuple[Graph, ...]:
    """Draw the changed components, then the changed nodes; no picture if nothing changed that it could show."""
    return tuple(_pictures(found, budget))


def _pictures(found: Comparison, budget: Budget) -> Iterator[Graph]:
    for draw in (functional, implementation):
        graph = draw(found, budget)
        if graph:
            yield graph
