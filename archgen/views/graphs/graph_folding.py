"""Keep pictures within a budget: above it frames are folded into a box each, the largest first, and a note says so."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph
from archgen.views.graphs.legend_keys import add_legend_keys
from archgen.views.inline_text import count_noun

MAX_BOXES = 70
MAX_ARROWS = 160


def fold_graph(graph: Graph) -> Graph:
    """Fold a graph until it fits the budget. One that still does not fit gets a note that says so."""
    members = Counter(box.cluster for box in graph.boxes)
    # Folding a frame with a single box saves nothing.
    names = [cluster.id for cluster in graph.clusters if members[cluster.id] > 1]
    # Stable, so frames of the same size are folded in the order of the files.
    largest = sorted(names, key=lambda name: -members[name])
    folded, box_count = graph, len(graph.boxes)
    for count in range(len(largest) + 1):
        # Counted on, instead of folded, as long as the boxes alone are too many.
        box_count -= members[largest[count - 1]] - 1 if count else 0
        if box_count > MAX_BOXES and count < len(largest):
            continue  # whatever its arrows, it does not fit
        folded = _fold_clusters(graph, set(largest[:count])) if count else graph
        if _fits_budget(folded):
            return folded
    note = f"This picture is larger than {MAX_BOXES} boxes and {MAX_ARROWS} arrows: select a part to see it well."
    return replace(folded, notes=(*folded.notes, note))


def _fits_budget(graph: Graph) -> bool:
    return len(graph.boxes) <= MAX_BOXES and len(graph.arrows) <= MAX_ARROWS


def _fold_clusters(graph: Graph, cluster_ids: set[str]) -> Graph:
    drawn_ids = {box.id: box.cluster if box.cluster in cluster_ids else box.id for box in graph.boxes}
    drawn_ids |= {cluster.id: cluster.id for cluster in graph.clusters}
    outer_arrows = [arrow for arrow in graph.arrows if drawn_ids[arrow.tail] != drawn_ids[arrow.head]]
    hidden_arrows = [arrow for arrow in graph.arrows if drawn_ids[arrow.tail] == drawn_ids[arrow.head]]
    flows_within = {
        name: sum(arrow.count for arrow in hidden_arrows if drawn_ids[arrow.tail] == name)
        for name in sorted(cluster_ids)
    }
    boxes = [box for box in graph.boxes if box.cluster not in cluster_ids]
    boxes += [
        _folded_box(graph, cluster, flows_within[cluster.id]) for cluster in graph.clusters if cluster.id in cluster_ids
    ]
    arrows = _merge_arrows(outer_arrows, {key: str(value) for key, value in drawn_ids.items()})
    note = (
        f"{count_noun(len(cluster_ids), 'group')} folded, because the picture would be larger than {MAX_BOXES} boxes and {MAX_ARROWS} arrows; "
        f"{count_noun(sum(flows_within.values()), 'flow')} inside not drawn."
    )
    folded_graph = replace(
        graph,
        boxes=tuple(boxes),
        arrows=arrows,
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in cluster_ids),
        notes=(*graph.notes, note),
        asked=sum(arrow.count for arrow in arrows),
    )
    return add_legend_keys(folded_graph)


def _folded_box(graph: Graph, cluster: Cluster, flows: int) -> Box:
    inside = [box for box in graph.boxes if box.cluster == cluster.id]
    lines = (*cluster.lines, f"{len(inside)} inside") + ((count_noun(flows, "flow") + " inside",) if flows else ())
    return Box(
        cluster.id,
        cluster.title,
        lines,
        style="fold",
        colour=cluster.colour,
        emphasis="neighbour" if cluster.emphasis == "neighbour" else "normal",
        cluster=cluster.parent,
        ref=cluster.ref,
        tooltip="\n".join([cluster.title, *(box.title for box in inside)]),
    )


def _merge_arrows(arrows: list[Arrow], drawn_ids: dict[str, str]) -> tuple[Arrow, ...]:
    """Merge arrows that now have the same ends."""
    bundles: dict[tuple[str, str, bool], list[Arrow]] = {}
    for arrow in arrows:
        # Network links are kept apart from what flows: their arrows have no head.
        bundles.setdefault((drawn_ids[arrow.tail], drawn_ids[arrow.head], arrow.style == "link"), []).append(arrow)
    return tuple(
        bundle[0]
        if len(bundle) == 1 and (bundle[0].tail, bundle[0].head) == (tail, head)
        else replace(
            bundle[0],
            id=f"{tail}>{head}",
            tail=tail,
            head=head,
            label="",
            tail_port=None,
            head_port=None,
            style=bundle[0].style if len({arrow.style for arrow in bundle}) == 1 else "data",
            count=sum(arrow.count for arrow in bundle),
            optional=False,
            flows=tuple(flow for arrow in bundle for flow in arrow.flows),
        )
        for (tail, head, _), bundle in bundles.items()
    )
