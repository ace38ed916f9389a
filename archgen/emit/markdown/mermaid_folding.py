"""Fold a graph for Mermaid, which lays out anew in each browser and tangles above some forty arrows."""

from __future__ import annotations

from dataclasses import replace

from archgen.views.graph_shapes import Arrow, Graph
from archgen.views.graphs.graph_folding import fold_graph

MAX_MERMAID_ARROWS = 40


def fold_for_mermaid(graph: Graph) -> Graph:
    """Fold a graph with too many arrows: what runs between a neighbour and a frame becomes one arrow, then frames become
    boxes.
    """
    if len(graph.arrows) <= MAX_MERMAID_ARROWS:
        return graph
    merged_graph = _lead_to_frames(graph)
    return (
        merged_graph if len(merged_graph.arrows) <= MAX_MERMAID_ARROWS else fold_graph(merged_graph, MAX_MERMAID_ARROWS)
    )


def _lead_to_frames(graph: Graph) -> Graph:
    """Lead arrows that cross a frame to the frame itself, one for all with the same ends."""
    frame_ids = {cluster.id for cluster in graph.clusters}
    frames = {box.id: box.cluster for box in graph.boxes if box.cluster in frame_ids}
    bundles: dict[tuple[str, str], list[Arrow]] = {}
    arrows = []
    for arrow in graph.arrows:
        tail_frame, head_frame = frames.get(arrow.tail), frames.get(arrow.head)
        if tail_frame == head_frame:
            arrows.append(arrow)
        else:
            bundles.setdefault((tail_frame or arrow.tail, head_frame or arrow.head), []).append(arrow)
    for (tail, head), bundle in bundles.items():
        first = replace(bundle[0], tail=tail, head=head, tail_port=None, head_port=None)
        flows = tuple(flow for arrow in bundle for flow in arrow.flows)
        count = sum(arrow.count for arrow in bundle)
        style = first.style if len({arrow.style for arrow in bundle}) == 1 else "data"
        label = first.label if len(bundle) == 1 else ""
        arrows.append(replace(first, label=label, style=style, count=count, flows=flows))
    return replace(graph, arrows=tuple(arrows))
