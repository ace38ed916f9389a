"""All drawings of an architecture, graphs and charts alike, by id."""

from __future__ import annotations

from typing import Literal

from archgen.model.selector_evaluation import Selection
from archgen.views import graphs
from archgen.views.chart_shapes import Drawing
from archgen.views.graph_shapes import Graph
from archgen.views.lookup import Lookup
from archgen.views.timing import chain_charts


def make_drawings(
    lookup: Lookup,
    selection: Selection | None,
    level: Literal["functional", "implementation"],
    *,
    draws_components: bool = True,
) -> dict[str, Drawing]:
    """Make the drawings of one level, or of a selection; of charts only those that show something selected.

    Without `draws_components` there is none of a single component.
    """
    element_graphs = graphs.make_all_graphs(
        lookup.architecture, selection, lookup.findings, lookup.timing, draws_components=draws_components
    )
    timing_charts = chain_charts.make_timing_charts(lookup)
    drawings_by_id: dict[str, Drawing] = {graph.id: graph for graph in element_graphs} | {
        chart.id: chart for chart in timing_charts
    }
    # Charts of chains stay: the report on the functional level has a chapter on chains, too.
    return (
        drawings_by_id
        if level == "implementation"
        else {
            drawing_id: drawing
            for drawing_id, drawing in drawings_by_id.items()
            if not _is_implementation_drawing(drawing)
        }
    )


def is_component_drawing(drawing: Drawing) -> bool:
    """Whether a drawing shows a single component, with its neighbours or its nodes."""
    return isinstance(drawing, Graph) and drawing.kind in {"component", "implementation"}


def _is_implementation_drawing(drawing: Drawing) -> bool:
    """Whether a drawing shows nodes, hosts or timing, which the functional level leaves out."""
    if isinstance(drawing, Graph):
        return drawing.kind in {"ros", "hosts", "implementation", "timing", "group-timing"}
    return is_implementation_id(drawing.id)


def is_implementation_id(drawing_id: str) -> bool:
    """Whether a drawing of this id, if there is one, shows what the functional level leaves out."""
    return drawing_id.partition("/")[0] in {"ros", "hosts", "implementation", "timing", "load"}
