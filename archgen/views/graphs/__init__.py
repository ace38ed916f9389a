"""Make the pictures of an architecture, as graphs: which there are, and what each shows.

| id | kind | shows |
|---|---|---|
| `overview` | `overview` | the groups; `overview_upright` for paper and narrow screens |
| `components` | `components` | all groups with their components |
| `groups/G` | `group` | a group with its neighbours |
| `composed/G.C` | `composed` | a composed component, open, with what is inside |
| `components/G.C` | `component` | a component with its ports |
| `implementation/G.C` | `implementation` | a component's nodes and topics |
| `ros` | `ros` | all nodes |
| `frames` | `frames` | the coordinate frames, as a tree |
| `views/V` | `view` | a view of the project |
| `timing` | `timing` | all activities by their period, or those of the selection |
| `timing/G` | `group-timing` | the activities of a group by their period |
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from archgen.diagnostics import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import Selection, SelectorEvaluator
from archgen.views.graphs import selection_graphs, timing_graphs
from archgen.views.graphs.component_graph import draw_component
from archgen.views.graphs.composed_graph import draw_composed
from archgen.views.graphs.frame_graph import draw_frames
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.graphs.group_graphs import draw_components, draw_group, draw_overview
from archgen.views.graphs.host_graph import draw_hosts
from archgen.views.graphs.implementation_graph import draw_implementation, draw_ros_graph
from archgen.views.graphs.start_graph import draw_start
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import Drawing, Graph
from archgen.views.timing.timing_lookup import TimingLookup

__all__ = ["draw_component", "draw_components", "draw_composed", "draw_frames", "draw_group", "draw_hosts"]
__all__ += ["draw_implementation", "draw_overview", "draw_ros_graph", "draw_start", "list_graphs", "make_all_graphs"]
__all__ += ["selection_graphs", "timing_graphs"]


_GRAPHS_BEHIND_SHEETS = {"overview": draw_overview, "hosts": draw_hosts}


def list_graphs(lookup: Lookup, drawings: Iterable[Drawing]) -> Iterator[Graph]:
    """Yield drawings as templates take them, which know boxes and arrows only: a graph for each that is one, or stands for one."""
    for drawing in drawings:
        if isinstance(drawing, Graph):
            yield drawing
        elif drawing.id in _GRAPHS_BEHIND_SHEETS:
            yield fold_graph(_GRAPHS_BEHIND_SHEETS[drawing.id](lookup))


MAX_COMPOSED_PICTURES = 300
"""With more composed components they have pictures only where single components have them."""


def make_all_graphs(  # noqa: PLR0913 - what pictures show, and how
    architecture: Architecture,
    selection: Selection | None = None,
    findings: Iterable[Diagnostic] = (),
    timed: TimingLookup | None = None,
    *,
    undrawn_kinds: Collection[str] = (),
    depth: int = 0,
) -> tuple[Graph, ...]:
    """Make all graphs; with a selection, one of it and those of what is selected. Empty graphs are left out.

    Without those of the `undrawn_kinds`; where single components are not drawn, composed ones are as long as they are few.
    Composed components are open to a depth.
    """
    lookup = make_lookup(architecture, findings, timing_lookup=timed)
    return tuple(graph for graph in _iterate_graphs(lookup, selection, undrawn_kinds, depth) if graph.boxes)


def _iterate_graphs(
    lookup: Lookup, selection: Selection | None, undrawn_kinds: Collection[str], depth: int
) -> Iterator[Graph]:
    architecture = lookup.architecture
    shown_components = list(architecture.components.values())
    if selection is None:
        yield fold_graph(draw_overview(lookup))
        yield fold_graph(draw_overview(lookup, "top-bottom"))
        yield fold_graph(draw_components(lookup, depth))
    else:
        shown_components = [component for component in shown_components if component.id in selection.components]
        # The same ids as without a selection (`overview` here, `ros` below), since pages and reports refer to graphs by
        # id.
        yield selection_graphs.draw_functional_part(
            lookup, "overview", "The selected part", selection.components, depth
        )
    groups = dict.fromkeys(each.group for each in shown_components)
    for name in groups if "group" not in undrawn_kinds else ():
        yield fold_graph(draw_group(lookup, name, depth))
    shown_ids = {component.id for component in shown_components}
    shown_shells = [each for each in architecture.shells if not shown_ids.isdisjoint(architecture.leaves_of(each))]
    for shell_id in (
        shown_shells if "component" not in undrawn_kinds or len(shown_shells) <= MAX_COMPOSED_PICTURES else ()
    ):
        yield draw_composed(lookup, shell_id, depth)
    for each in shown_components if "component" not in undrawn_kinds else ():
        # A composed one that is not designed to its end is among them, and has its own picture already.
        if each.id not in architecture.shells:
            yield draw_component(lookup, each.id)
        yield draw_implementation(lookup, each.id)
    if selection is None:
        yield draw_ros_graph(lookup)
        yield draw_frames(lookup)
        yield draw_start(lookup)
    else:
        yield selection_graphs.draw_implementation_part(lookup, "ros", "Nodes of the selected part", selection.nodes)
    if lookup.timing is not None:
        timed_groups = groups if "group-timing" not in undrawn_kinds else ()
        yield from timing_graphs.draw_timing_graphs(
            lookup, lookup.timing, timed_groups, selection.nodes if selection else None
        )
    selecting = SelectorEvaluator(architecture)
    # Views of the project show what they say, whatever is selected.
    for project_view in architecture.views.values():
        view_selection, _ = selecting.evaluate(project_view.show)
        yield selection_graphs.draw_view(lookup, project_view, view_selection, depth)
