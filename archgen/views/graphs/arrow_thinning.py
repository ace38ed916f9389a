"""Thin out a picture of the whole architecture that is still too large when all its frames are folded.

A picture of 100 groups and 490 arrows took dot three seconds, and nobody could follow an arrow in it. So the boxes with
most flows are drawn, and of the arrows between them those that carry most from each box. A note says how many are left
out; the explorer, the matrices and the tables have all of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from archgen.views.graph_shapes import Arrow, Box, Graph
from archgen.views.graphs.legend_keys import add_legend_keys

WHOLE_KINDS = frozenset({"overview", "components", "ros", "timing"})
"""The kinds of pictures that are thinned out: others show what somebody chose, or what was agreed."""
MAX_DRAWN_BOXES = 150


def thin_graph(graph: Graph, max_arrows: int) -> Graph:
    """Leave out the boxes with fewest flows and the arrows that carry least, and say in a note how many."""
    boxes = _choose_boxes(graph)
    drawn_ids = {box.id for box in boxes} | {cluster.id for cluster in graph.clusters}
    arrows = [arrow for arrow in graph.arrows if arrow.tail in drawn_ids and arrow.head in drawn_ids]
    chosen_ids = {arrow.id for arrow in _rank_arrows(arrows)[:max_arrows]}
    drawn_arrows = tuple(arrow for arrow in arrows if arrow.id in chosen_ids)
    used_frames = {box.cluster for box in boxes} | {end for arrow in drawn_arrows for end in (arrow.tail, arrow.head)}
    note = " ".join(
        (*_describe_cuts(graph, boxes, drawn_arrows), "The explorer, the matrices and the tables have all.")
    )
    thinned_graph = replace(
        graph,
        boxes=tuple(boxes),
        arrows=drawn_arrows,
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id in used_frames),
        notes=(*graph.notes, note),
        asked=sum(arrow.count for arrow in drawn_arrows),
    )
    return add_legend_keys(thinned_graph)


def _choose_boxes(graph: Graph) -> Sequence[Box]:
    """Return the boxes with most flows, in the order of the graph; of equals the first."""
    if len(graph.boxes) <= MAX_DRAWN_BOXES:
        return graph.boxes
    flows: Counter[str] = Counter()
    for arrow in graph.arrows:
        flows.update({arrow.tail: arrow.count})
        flows.update({arrow.head: arrow.count})
    chosen = {box.id for box in sorted(graph.boxes, key=lambda box: -flows[box.id])[:MAX_DRAWN_BOXES]}
    return [box for box in graph.boxes if box.id in chosen]


def _rank_arrows(arrows: Sequence[Arrow]) -> list[Arrow]:
    """Return arrows in the order in which they are worth drawing: the largest from each box, then the second of each."""
    places: Counter[str] = Counter()
    ranked = []
    for arrow in sorted(arrows, key=lambda arrow: -arrow.count):
        ranked.append((places[arrow.tail], arrow))
        places[arrow.tail] += 1
    return [arrow for _, arrow in sorted(ranked, key=lambda each: (each[0], -each[1].count))]


def _describe_cuts(graph: Graph, boxes: Sequence[Box], arrows: Sequence[Arrow]) -> Iterator[str]:
    if len(boxes) < len(graph.boxes):
        yield f"{len(boxes):,} of {len(graph.boxes):,} boxes are drawn, those with most flows."
    if len(arrows) < len(graph.arrows):
        yield f"{len(arrows):,} of {len(graph.arrows):,} arrows are drawn, the largest from each box first."
