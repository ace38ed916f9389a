"""The layout `framed`: one run of dot with frames round the boxes, arrows from box to box.

Frames and labels together break dot (it may crash), so the labels are set on the arrows afterwards: for few boxes only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from archgen.emit.graphviz import layout_engine
from archgen.emit.graphviz.label_places import declutter_labels
from archgen.emit.graphviz.placed_scene import Scene, SceneFrame, ScenePart, read_scene
from archgen.emit.graphviz.styled_graph import (
    StyledGraph,
    frame_attributes,
    measure_nodes,
    place_labels_on_lines,
    title_attributes,
    write_dot,
)

_CLUSTER_MARGIN = 14
_SCREEN_SIZE = (1000.0, 700.0)
_DIRECTIONS = {None: ("LR", "TB"), "left-right": ("LR",), "top-bottom": ("TB",)}
"""Directions to try by the one that the project asks for; the first is taken where both are as good."""


def lay_out_framed(styled_graph: StyledGraph) -> Scene:
    """Lay out boxes in frames, then place the labels on the arrows. Of two directions the better is taken, unless one is asked for."""
    scenes = [_lay_out_direction(styled_graph, direction) for direction in _DIRECTIONS[styled_graph.graph.direction]]
    # `min` returns the first of equals.
    return min(scenes, key=lambda scene: (_count_lost_labels(styled_graph, scene), _screen_overflow(scene)))


def _count_lost_labels(styled_graph: StyledGraph, scene: Scene) -> int:
    """Count the labels that found no place."""
    return len(styled_graph.label_attributes) - sum(part.kind == "label" for part in scene.parts)


def _screen_overflow(scene: Scene) -> float:
    """Return how many times too large a scene is for a page on a screen. All that fit are equally good (1.0)."""
    left, bottom, right, top = scene.bounds()
    return max(1.0, (right - left) / _SCREEN_SIZE[0], (top - bottom) / _SCREEN_SIZE[1])


def _lay_out_direction(styled_graph: StyledGraph, direction: str) -> Scene:
    graph = styled_graph.graph
    headings = [title_attributes(cluster) for cluster in graph.clusters]
    sizes = measure_nodes(headings)
    statements = list(_cluster_statements(styled_graph, sizes))
    statements += [
        styled_graph.write_node(cluster_object)
        for cluster_object in graph.boxes
        if cluster_object.cluster not in _cluster_numbers(styled_graph)
    ]
    statements += [
        styled_graph.write_edge(at, cluster_object, with_text=False) for at, cluster_object in enumerate(graph.arrows)
    ]
    layout = layout_engine.lay_out_dot(write_dot(_layout_settings(styled_graph, direction), statements))
    scene = read_scene(layout, styled_graph.box_attributes, styled_graph.arrow_attributes)
    layout_objects: Mapping[str, Any] = {
        cluster_object["name"]: cluster_object for cluster_object in layout.get("objects", [])
    }
    frames, titles = [], []
    for at, cluster in enumerate(graph.clusters):
        cluster_object = layout_objects.get(f"cluster_{at}")
        # Of a cluster without boxes dot returns no frame (`bb`).
        if cluster_object is None or "bb" not in cluster_object:
            continue
        left, bottom, right, top = (float(number) for number in cluster_object["bb"].split(","))
        width, height = sizes[at]
        frames.append(
            SceneFrame(f"c{at}", frame_attributes(cluster, styled_graph.resolve_link), (left, bottom, right, top))
        )
        title_centre = left + 6 + width / 2, top - 5 - height / 2
        titles.append(ScenePart(f"t{at}", headings[at], *title_centre, width, height, kind="title"))
    return declutter_labels(
        place_labels_on_lines(styled_graph, scene.joined(Scene(frames=tuple(frames), parts=tuple(titles))))
    )


def _cluster_numbers(styled_graph: StyledGraph) -> dict[str | None, int]:
    return {cluster.id: at for at, cluster in enumerate(styled_graph.graph.clusters)}


def _cluster_statements(styled_graph: StyledGraph, sizes: tuple[tuple[float, float], ...]) -> Iterator[str]:
    """Yield the frames with their boxes. An empty label as large as the title keeps its place free."""
    for name, at in _cluster_numbers(styled_graph).items():
        inside_boxes = [item for item in styled_graph.graph.boxes if item.cluster == name]
        width, height = sizes[at]
        title_spacer = (
            f'<<TABLE BORDER="0" FIXEDSIZE="TRUE" WIDTH="{width:.0f}" HEIGHT="{height:.0f}"><TR><TD></TD></TR></TABLE>>'
        )
        boxes = " ".join(styled_graph.write_node(item) for item in inside_boxes)
        yield f'subgraph "cluster_{at}" {{ graph [label={title_spacer} labeljust="l" margin="{_CLUSTER_MARGIN}"]; {boxes} }}'


def _layout_settings(styled_graph: StyledGraph, direction: str) -> str:
    """Return the settings of dot, with room between the ranks for the longest line of a label."""
    longest = max((len(line) for arrow in styled_graph.graph.arrows for line in arrow.label.split("\n")), default=0)
    ranksep = min(0.5 + 0.065 * longest, 1.8) if direction == "LR" else 0.7
    return f'rankdir="{direction}" nodesep="0.28" ranksep="{ranksep:.2f}" remincross="true" mclimit="3"'
