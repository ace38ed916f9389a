"""The layout `framed`: one run of dot with frames round the boxes, arrows from box to box.

Frames and labels together break dot (it may crash), so the labels are set on the arrows afterwards: for few boxes only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.label_places import clear_titles, count_cut_titles, declutter_labels
from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, ScenePart, read_scene
from archgen.emit.graphviz.styled_graph import (
    StyledGraph,
    frame_attributes,
    measure_nodes,
    place_labels_on_lines,
    title_attributes,
    write_dot,
)
from archgen.views.picture_shapes import Cluster, Graph

_SCREEN_SIZE = (1000.0, 700.0)
_CUT_PENALTY = 0.05
"""How much smaller a picture may be for each title of a frame that cuts no line, as a share of its size."""
_DIRECTIONS = {None: ("LR", "TB"), "left-right": ("LR",), "top-bottom": ("TB",)}
"""Directions to try by the one that the project asks for; the first is taken where both are as good."""


def lay_out_framed(styled_graph: StyledGraph) -> Scene:
    """Lay out boxes in frames, then place the labels on the arrows. Of two directions the better is taken, unless one is asked for."""
    scenes = [_lay_out_direction(styled_graph, direction) for direction in _DIRECTIONS[styled_graph.graph.direction]]
    # `min` returns the first of equals.
    return min(scenes, key=lambda scene: (_count_lost_labels(styled_graph, scene), _reading_cost(scene)))


def _count_lost_labels(styled_graph: StyledGraph, scene: Scene) -> int:
    """Count the labels that found no place."""
    return len(styled_graph.label_attributes) - sum(part.kind == "label" for part in scene.parts)


def _reading_cost(scene: Scene) -> float:
    """Return how hard a scene is to read: how small it gets on a screen, and how many titles of frames cut lines."""
    left, bottom, right, top = scene.bounds()
    return max(1.0, (right - left) / _SCREEN_SIZE[0], (top - bottom) / _SCREEN_SIZE[1]) * (
        1 + _CUT_PENALTY * count_cut_titles(scene)
    )


def _lay_out_direction(styled_graph: StyledGraph, direction: str) -> Scene:
    graph = styled_graph.graph
    # All titles in one call of Graphviz: what follows asks for them one by one, and the sizes are kept.
    measure_nodes([title_attributes(cluster) for cluster in graph.clusters])
    frame_ids = {cluster.id for cluster in graph.clusters}
    statements = list(write_frames(styled_graph, None))
    statements += [styled_graph.write_node(box) for box in graph.boxes if box.cluster not in frame_ids]
    statements += [styled_graph.write_edge(at, arrow, with_text=False) for at, arrow in enumerate(graph.arrows)]
    ranksep = find_rank_distance(styled_graph.graph) if direction == "LR" else 0.7
    layout = layout_engine.lay_out_dot(
        write_dot(
            f'rankdir="{direction}" nodesep="0.28" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"', statements
        )
    )
    scene = read_scene(layout, styled_graph.box_attributes, styled_graph.arrow_attributes)
    frames = read_frames(styled_graph, layout, graph.clusters)
    return declutter_labels(place_labels_on_lines(styled_graph, clear_titles(scene.joined(frames))))


_CLUSTER_MARGIN = 14


def find_rank_distance(graph: Graph) -> float:
    """Return how many inches the longest line of a label beside an arrow takes between two ranks of boxes."""
    longest = max((len(line) for arrow in graph.arrows for line in arrow.label.split("\n")), default=0)
    return min(0.5 + 0.065 * longest, 1.8)


def write_frames(styled_graph: StyledGraph, parent: str | None) -> Iterator[str]:
    """Yield the frames directly inside of one, or of none, with what is in them. An empty label as large as the title
    keeps its place free.
    """
    graph = styled_graph.graph
    for at, cluster in enumerate(graph.clusters):
        if cluster.parent == parent:
            ((width, height),) = measure_nodes([title_attributes(cluster)])
            title_spacer = f'<<TABLE BORDER="0" FIXEDSIZE="TRUE" WIDTH="{width:.0f}" HEIGHT="{height:.0f}"><TR><TD></TD></TR></TABLE>>'
            boxes = " ".join(styled_graph.write_node(box) for box in graph.boxes if box.cluster == cluster.id)
            inner_frames = " ".join(write_frames(styled_graph, cluster.id))
            yield (
                f'subgraph "cluster_{at}" {{ graph [label={title_spacer} labeljust="l" margin="{_CLUSTER_MARGIN}"]; '
                f"{boxes} {inner_frames} }}"
            )


def read_frames(styled_graph: StyledGraph, layout: Mapping[str, Any], clusters: Sequence[Cluster]) -> Scene:
    """Return some of the frames as a layout placed them, with their titles."""
    numbers = {cluster.id: at for at, cluster in enumerate(styled_graph.graph.clusters)}
    layout_objects = {each["name"]: each for each in layout.get("objects", [])}
    frames, titles = [], []
    for cluster in clusters:
        at = numbers[cluster.id]
        cluster_object = layout_objects.get(f"cluster_{at}")
        # Of a cluster without boxes dot returns no frame (`bb`).
        if cluster_object is None or "bb" not in cluster_object:
            continue
        left, bottom, right, top = (float(number) for number in cluster_object["bb"].split(","))
        heading = title_attributes(cluster)
        ((width, height),) = measure_nodes([heading])
        frames.append(
            SceneFrame(f"c{at}", frame_attributes(cluster, styled_graph.resolve_link), (left, bottom, right, top))
        )
        title_centre = left + 6 + width / 2, top - 5 - height / 2
        titles.append(ScenePart(f"t{at}", heading, *title_centre, width, height, kind="title"))
    return Scene(frames=tuple(frames), parts=tuple(titles))
