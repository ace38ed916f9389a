"""Drawings that are made when somebody asks for them: a page shows a few, and a project of a thousand components has
thousands.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Literal

from archgen.model.selector_evaluation import Selection, SelectorEvaluator
from archgen.views import drawing_set, graphs
from archgen.views.changes.site_changes import SiteChanges, mark_drawing
from archgen.views.graphs import host_rack, partner_matrix, selection_graphs, timing_graphs
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import UPRIGHT, Drawing, Graph
from archgen.views.sequences import lane_sheets
from archgen.views.sequences.sequence_charts import CHART_PREFIX, make_sequence_chart
from archgen.views.timing import chain_charts

# One without boxes is not shown: there may be neither hosts nor frames.
_WHOLE_GRAPHS = {
    "ros": graphs.draw_ros_graph,
    "frames": graphs.draw_frames,
    "start_up": graphs.draw_start,
}


class DrawingsOnDemand(Mapping[str, Drawing]):
    """The drawings of an architecture by id, each made once. To go through all of them makes all."""

    def __init__(
        self,
        lookup: Lookup,
        level: Literal["functional", "implementation"],
        further_drawings: Iterable[Drawing] = (),
        selection: Selection | None = None,
        changes: SiteChanges | None = None,
    ) -> None:
        """Make nothing yet. `further_drawings` are there besides those of the architecture.

        Of a selection all are made with the first one: they are few. What changed is marked.
        """
        self._lookup, self._level = lookup, level
        self._selection, self._changes = selection, changes
        change_graphs = changes.document.graphs if changes else ()
        self._further_drawings = {drawing.id: drawing for drawing in (*further_drawings, *change_graphs)}
        self._made_drawings: dict[str, Drawing | None] = {}

    @cached_property
    def _graph_lookup(self) -> Lookup:
        """The look-ups as `make_all_graphs` makes them: graphs show every element, whatever the pages show."""
        return make_lookup(self._lookup.architecture, self._lookup.findings, timing_lookup=self._lookup.timing)

    @cached_property
    def _all_drawings(self) -> dict[str, Drawing]:
        return drawing_set.make_drawings(self._lookup, self._selection, self._level) | self._further_drawings

    def __getitem__(self, drawing_id: str) -> Drawing:
        """Return a drawing, made now if need be."""
        drawing = self._further_drawings.get(drawing_id)
        if drawing is None:
            if drawing_id not in self._made_drawings:
                self._make_drawings(drawing_id)
            drawing = self._made_drawings[drawing_id]
        if drawing is None:
            raise KeyError(drawing_id)
        return drawing

    def _make_drawings(self, drawing_id: str) -> None:
        """Make a drawing and whatever is made together with it; None is kept where there is nothing to draw."""
        drawings = self._list_drawings(drawing_id) if self._selection is None else self._all_drawings.values()
        changes = self._changes
        self._made_drawings |= {
            drawing.id: mark_drawing(drawing, changes) if changes else drawing for drawing in drawings
        }
        self._made_drawings.setdefault(drawing_id, None)

    def __iter__(self) -> Iterator[str]:
        """Go through the ids."""
        return iter(self._all_drawings)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._all_drawings)

    def _list_drawings(self, drawing_id: str) -> Iterator[Drawing]:
        """Yield a drawing and whatever can only be made together with it."""
        family, _, name = drawing_id.partition("/")
        made_drawings: Iterable[Drawing | None]
        if family.removesuffix(UPRIGHT) == "overview" and partner_matrix.is_too_dense(self._graph_lookup):
            made_drawings = partner_matrix.draw_partner_matrices(self._graph_lookup)
        elif family.removesuffix(UPRIGHT) == "hosts":
            made_drawings = host_rack.draw_host_racks(self._graph_lookup)
        elif family in {"timing", "chains", "load"}:
            made_drawings = self._make_timing_drawings(family)
        elif f"{family}/" == CHART_PREFIX:
            name = name.removesuffix(UPRIGHT)
            has_steps = name in self._lookup.steps.by_use_case
            made_drawings = (
                lane_sheets.choose_sequences(self._lookup, make_sequence_chart(self._lookup, name)) if has_steps else ()
            )
        else:
            made_drawings = (self._draw_graph(family, name),)
        yield from (drawing for drawing in made_drawings if drawing and self._is_shown(drawing))

    def _is_shown(self, drawing: Drawing) -> bool:
        """Whether a drawing is not empty, and not left out at this level."""
        is_empty = isinstance(drawing, Graph) and not drawing.boxes
        return not is_empty and (self._level != "functional" or not drawing_set.is_implementation_id(drawing.id))

    def _make_timing_drawings(self, family: str) -> Iterable[Drawing | None]:
        """Make the graphs of timing, or the charts of chains and hosts."""
        timing_lookup = self._lookup.timing
        if timing_lookup is None:
            return ()
        if family == "timing":
            groups = dict.fromkeys(each.group for each in self._lookup.architecture.components.values())
            return timing_graphs.draw_timing_graphs(self._graph_lookup, timing_lookup, groups)
        return chain_charts.make_timing_charts(self._lookup)

    def _draw_graph(self, family: str, name: str) -> Graph | None:
        """Draw one graph; None where no such thing exists."""
        lookup = self._graph_lookup
        if name:
            return self._draw_element(family, name)
        match family:
            case "overview":
                return fold_graph(graphs.draw_overview(lookup))
            case "overview_upright":
                return fold_graph(graphs.draw_overview(lookup, "top-bottom"))
            case "components":
                return fold_graph(graphs.draw_components(lookup))
        draw_whole = _WHOLE_GRAPHS.get(family)
        return draw_whole(lookup) if draw_whole else None

    def _draw_element(self, family: str, name: str) -> Graph | None:
        """Draw the graph of a group, a component or a view; None where there is none of this name."""
        architecture, lookup = self._lookup.architecture, self._graph_lookup
        if family == "groups" and any(each.group == name for each in architecture.components.values()):
            return fold_graph(graphs.draw_group(lookup, name))
        if family == "composed" and name in architecture.shells:
            return graphs.draw_composed(lookup, name)
        if family == "components" and name in architecture.components and name not in architecture.shells:
            return graphs.draw_component(lookup, name)
        if family == "implementation" and name in architecture.components:
            return graphs.draw_implementation(lookup, name)
        if family == "views" and name in architecture.views:
            project_view = architecture.views[name]
            view_selection, _ = SelectorEvaluator(architecture).evaluate(project_view.show)
            return selection_graphs.draw_view(lookup, project_view, view_selection)
        return None
