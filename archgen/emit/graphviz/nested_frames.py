"""Frames as clusters of dot: written into a layout, each inside of its parent, and read back from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, ScenePart
from archgen.emit.graphviz.styled_graph import StyledGraph, frame_attributes, measure_nodes, title_attributes
from archgen.views.graph_shapes import Cluster, Graph

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
