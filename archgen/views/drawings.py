"""All drawings of an architecture, graphs and charts alike, by id."""

from __future__ import annotations

from typing import Literal

from archgen.model.selector import Selection
from archgen.views import charts, graphs
from archgen.views.bars import Drawing
from archgen.views.index import Index


def drawings(
    view: Index, selection: Selection | None, level: Literal["functional", "implementation"]
) -> dict[str, Drawing]:
    """Make the drawings of one level, or of a selection; of charts only those that show something selected."""
    made = graphs.all_graphs(view.architecture, selection, view.findings, view.timed)
    bars = charts.all_charts(view)
    found: dict[str, Drawing] = {graph.id: graph for graph in made} | {chart.id: chart for chart in bars}
    # Charts of chains stay: the report on the functional level has a chapter on chains, too.
    return found if level == "implementation" else {name: one for name, one in found.items() if not _is_low(name)}


def _is_low(name: str) -> bool:
    """Whether a drawing shows nodes, hosts or timing, which the functional level leaves out."""
    return name in {"ros", "hosts", "timing", "load"} or name.startswith(("implementation/", "timing/", "load/"))
