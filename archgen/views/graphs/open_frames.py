"""Open composed components in a picture: what stands inside is drawn in a frame, to as many levels as are asked for.

A picture that would get too large is opened less deep, and says so.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.component_nesting import find_component, list_surrounding
from archgen.views.graphs import element_boxes
from archgen.views.graphs.graph_folding import MAX_ARROWS, MAX_BOXES
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Box, Cluster, Graph


def draw_to_depth(architecture: Architecture, draw: Callable[[int], Graph], depth: int) -> Graph:
    """Draw with composed components open to a depth, or less deep where the picture would be too large."""
    deepest = max((len(list_surrounding(architecture, shell)) + 1 for shell in architecture.shells), default=0)
    wanted_depth = min(depth, deepest)
    for each in range(wanted_depth, 0, -1):
        graph = draw(each)
        if len(graph.boxes) <= MAX_BOXES and len(graph.arrows) <= MAX_ARROWS:
            return graph if each == wanted_depth else _note_depth(graph, f"only {count_noun(each, 'level')} deep")
    graph = draw(0)
    return _note_depth(graph, "closed") if wanted_depth else graph


def _note_depth(graph: Graph, words: str) -> Graph:
    note = (
        f"Components of components are {words} here: with more of them open the picture would be larger than "
        f"{MAX_BOXES} boxes and {MAX_ARROWS} arrows."
    )
    return replace(graph, notes=(*graph.notes, note))


def list_opened(architecture: Architecture, box_ids: Iterable[str], depth: int) -> frozenset[str]:
    """Return the composed components that are open where those among some boxes are opened so many levels deep."""
    opened: set[str] = set()
    closed_ids = [box_id for box_id in box_ids if box_id in architecture.shells]
    for _ in range(depth):
        opened.update(closed_ids)
        children = (child for shell in closed_ids for child in architecture.shells[shell].children)
        closed_ids = [child for child in children if child in architecture.shells]
    return frozenset(opened)


def find_drawn(architecture: Architecture, component_id: str, opened: Collection[str]) -> Component:
    """Return what a box in a picture shows: of an open component, what of it is not designed yet."""
    if component_id in opened:
        return replace(architecture.components[component_id], title="Not designed yet")
    return find_component(architecture, component_id)


def place_in_frames(
    lookup: Lookup, boxes: Iterable[Box], opened: Collection[str], outer: str | None
) -> tuple[tuple[Box, ...], tuple[Cluster, ...]]:
    """Set boxes of components into the frames of the open components around them, and these into `outer`."""
    placed_boxes, clusters = [], dict[str, Cluster]()
    for box in boxes:
        parent = outer
        own_frame = (box.id,) if box.id in opened else ()
        for shell_id in (*list_surrounding(lookup.architecture, box.id), *own_frame):
            if shell_id in opened:
                frame_id = f"open {shell_id}"
                clusters.setdefault(frame_id, _make_frame(lookup, shell_id, frame_id, parent))
                parent = frame_id
        placed_boxes.append(replace(box, cluster=parent))
    return tuple(placed_boxes), tuple(clusters.values())


def _make_frame(lookup: Lookup, shell_id: str, frame_id: str, parent: str | None) -> Cluster:
    shell = lookup.architecture.shells[shell_id]
    return Cluster(
        frame_id,
        shell.title,
        element_boxes.type_lines(lookup, shell),
        colour=element_boxes.group_hue(lookup, shell.group),
        parent=parent,
        ref=f"component:{shell_id}",
        tooltip=f"{shell.title} ({shell_id})",
    )
