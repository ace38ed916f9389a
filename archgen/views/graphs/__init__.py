"""Make the pictures of an architecture, as graphs: which there are, and what each shows.

| id | shows |
|---|---|
| `overview` | the groups |
| `components` | all groups with their components |
| `groups/G` | a group with its neighbours |
| `components/G.C` | a component with its ports |
| `implementation/G.C` | a component's nodes and topics |
| `ros` | all nodes |
| `hosts` | hosts, containers and links |
| `views/V` | a view of the project |
| `timing` | all activities by their period, or those of the selection |
| `timing/G` | the activities of a group by their period |
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.selector import Selecting, Selection
from archgen.views.graphs import selected, timing
from archgen.views.graphs.component import component
from archgen.views.graphs.folding import fold
from archgen.views.graphs.group import group
from archgen.views.graphs.hosts import hosts
from archgen.views.graphs.implementation import implementation
from archgen.views.graphs.overview import components, overview
from archgen.views.graphs.ros import ros
from archgen.views.index import Index, index
from archgen.views.shapes import Graph
from archgen.views.timed import Timed

__all__ = [
    "all_graphs",
    "component",
    "components",
    "group",
    "hosts",
    "implementation",
    "overview",
    "ros",
    "selected",
    "timing",
]


def all_graphs(
    architecture: Architecture,
    selection: Selection | None = None,
    findings: Iterable[Diagnostic] = (),
    timed: Timed | None = None,
) -> tuple[Graph, ...]:
    """Make all graphs; with a selection, one of it and those of what is selected. Empty graphs are left out."""
    return tuple(graph for graph in _all(index(architecture, findings, timed=timed), selection) if graph.boxes)


def _all(view: Index, selection: Selection | None) -> Iterator[Graph]:
    architecture = view.architecture
    shown = list(architecture.components.values())
    if selection is None:
        yield fold(overview(view))
        yield fold(components(view))
    else:
        shown = [component for component in shown if component.id in selection.components]
        # The same ids as without a selection (`overview` here, `ros` below), since pages and reports refer to graphs by
        # id.
        yield selected.functional(view, "overview", "The selected part", selection.components)
    for name in dict.fromkeys(each.group for each in shown):
        yield fold(group(view, name))
    for each in shown:
        yield component(view, each.id)
        yield implementation(view, each.id)
    if selection is None:
        yield ros(view)
        yield hosts(view)
    else:
        yield selected.implementation(view, "ros", "Nodes of the selected part", selection.nodes)
    if view.timed is not None:
        groups = dict.fromkeys(each.group for each in shown)
        yield from timing.pictures(view, view.timed, groups, selection.nodes if selection else None)
    selecting = Selecting(architecture)
    # Views of the project show what they say, whatever is selected.
    for asked in architecture.views.values():
        chosen, _ = selecting.select(asked.show)
        yield selected.of_view(view, asked, chosen)
