"""All that is drawn of an architecture, graphs and charts, by id."""

from __future__ import annotations

from typing import Literal

from archgen.model.selector import Selection
from archgen.views import charts, graphs
from archgen.views.bars import Drawing
from archgen.views.index import Index


def drawings(
    view: Index, selection: Selection | None, level: Literal["functional", "implementation"]
) -> dict[str, Drawing]:
    """Make the drawings of one level, or of a part: of charts those that it has a share in."""
    made = graphs.all_graphs(view.architecture, selection, view.findings, view.timed)
    bars = charts.all_charts(view)
    found: dict[str, Drawing] = {graph.id: graph for graph in made} | {chart.id: chart for chart in bars}
    return found if level == "implementation" else {name: one for name, one in found.items() if not _is_low(name)}


def _is_low(name: str) -> bool:
    return name in {"ros", "hosts", "timing", "load"} or name.startswith(("implementation/", "timing/", "load/"))
