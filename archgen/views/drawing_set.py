"""All drawings of an architecture by id, graphs and charts alike: all at once, or each when somebody asks for it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

from archgen.model.selector_evaluation import Selection
from archgen.views import graphs
from archgen.views.graphs import host_rack, partner_matrix
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Drawing, Graph, GraphKind
from archgen.views.sequences import lane_sheets
from archgen.views.sequences.sequence_charts import make_sequence_charts
from archgen.views.timing import chain_charts

COMPONENT_KINDS: frozenset[GraphKind] = frozenset({"component", "implementation"})
"""The kinds of pictures of which there is one for each component."""
TIMING_KINDS: frozenset[GraphKind] = frozenset({"group-timing"})
"""The kinds of which there is one for each group, and which show how its components run."""
GROUP_KINDS: frozenset[GraphKind] = frozenset({"group", *TIMING_KINDS})
"""The kinds of which there is one for each group."""
MAX_PICTURED_COMPONENTS = 300
"""With more, the site has no picture of each component, nor of each group's timing, unless it is asked for: of 1,000 they
take minutes to draw, and the map shows the same at once.
"""
MAX_PICTURED_GROUPS = 200
"""The same for groups: a picture takes as long as five checks of its components."""


def make_drawings(
    lookup: Lookup,
    selection: Selection | None,
    level: Literal["functional", "implementation"],
    *,
    undrawn_kinds: Collection[str] = (),
    depth: int = 0,
) -> dict[str, Drawing]:
    """Make the drawings of one level, or of a selection; of charts only those that show something selected.

    There are none of the `undrawn_kinds`. Composed components are open to a depth.
    """
    element_graphs = graphs.make_all_graphs(
        lookup.architecture, selection, lookup.findings, lookup.timing, undrawn_kinds=undrawn_kinds, depth=depth
    )
    timing_charts = chain_charts.make_timing_charts(lookup)
    charts = make_sequence_charts(lookup, selection.components if selection else None)
    sequences = [sheet for chart in charts for sheet in lane_sheets.choose_sequences(lookup, chart)]
    drawings_by_id: dict[str, Drawing] = {graph.id: graph for graph in element_graphs}
    if selection is None and partner_matrix.is_too_dense(lookup):
        drawings_by_id |= {each.id: each for each in partner_matrix.draw_partner_matrices(lookup)}
    if selection is None:
        drawings_by_id |= {each.id: each for each in host_rack.draw_host_racks(lookup)}
    drawings_by_id |= {chart.id: chart for chart in timing_charts} | {chart.id: chart for chart in sequences}
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


def list_undrawn_kinds(components: int, groups: int, *, wish: bool | None) -> frozenset[GraphKind]:
    """Return the kinds of pictures that a site of so many components and groups has none of, unless it is wished."""
    leaves_out_components = components > MAX_PICTURED_COMPONENTS if wish is None else not wish
    leaves_out_groups = groups > MAX_PICTURED_GROUPS and not wish
    leaves_out_timing = components > MAX_PICTURED_COMPONENTS and not wish
    return (
        (COMPONENT_KINDS if leaves_out_components else frozenset())
        | (TIMING_KINDS if leaves_out_timing else frozenset())
        | (GROUP_KINDS if leaves_out_groups else frozenset())
    )


def _is_implementation_drawing(drawing: Drawing) -> bool:
    """Whether a drawing shows nodes, hosts or timing, which the functional level leaves out."""
    if isinstance(drawing, Graph):
        return drawing.kind in {"ros", "hosts", "implementation", "timing", "group-timing"}
    return is_implementation_id(drawing.id)


def is_implementation_id(drawing_id: str) -> bool:
    """Whether a drawing of this id, if there is one, shows what the functional level leaves out."""
    return drawing_id.partition("/")[0].removesuffix(UPRIGHT) in {"ros", "hosts", "implementation", "timing", "load"}
