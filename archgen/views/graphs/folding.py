"""Keep pictures within a budget: above it frames are folded into a box each, the largest first, and a note says so."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from archgen.views.graphs.legend import with_legend
from archgen.views.shapes import Arrow, Box, Cluster, Graph
from archgen.views.words import plural

BOXES = 70
ARROWS = 160


def fold(graph: Graph) -> Graph:
    """Fold a graph until it fits the budget. One that still does not fit gets a note that says so."""
    members = Counter(box.cluster for box in graph.boxes)
    # Folding a frame with a single box saves nothing.
    names = [cluster.id for cluster in graph.clusters if members[cluster.id] > 1]
    # Stable, so frames of the same size are folded in the order of the files.
    largest = sorted(names, key=lambda name: -members[name])
    folded, left = graph, len(graph.boxes)
    for count in range(len(largest) + 1):
        # Counted on, instead of folded, as long as the boxes alone are too many.
        left -= members[largest[count - 1]] - 1 if count else 0
        if left > BOXES and count < len(largest):
            continue  # whatever its arrows, it does not fit
        folded = _folded(graph, set(largest[:count])) if count else graph
        if _fits(folded):
            return folded
    said = f"This picture is larger than {BOXES} boxes and {ARROWS} arrows: select a part to see it well."
    return replace(folded, notes=(*folded.notes, said))


def _fits(graph: Graph) -> bool:
    return len(graph.boxes) <= BOXES and len(graph.arrows) <= ARROWS


def _folded(graph: Graph, names: set[str]) -> Graph:
    ends = {box.id: box.cluster if box.cluster in names else box.id for box in graph.boxes}
    ends |= {cluster.id: cluster.id for cluster in graph.clusters}
    outer = [arrow for arrow in graph.arrows if ends[arrow.tail] != ends[arrow.head]]
    hidden = [arrow for arrow in graph.arrows if ends[arrow.tail] == ends[arrow.head]]
    within = {name: sum(arrow.count for arrow in hidden if ends[arrow.tail] == name) for name in names}
    boxes = [box for box in graph.boxes if box.cluster not in names]
    boxes += [_box(graph, cluster, within[cluster.id]) for cluster in graph.clusters if cluster.id in names]
    arrows = _merged(outer, {key: str(value) for key, value in ends.items()})
    note = (
        f"{plural(len(names), 'group')} folded, because the picture would be larger than {BOXES} boxes and {ARROWS} arrows; "
        f"{plural(sum(within.values()), 'flow')} inside not drawn."
    )
    found = replace(
        graph,
        boxes=tuple(boxes),
        arrows=arrows,
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in names),
        notes=(*graph.notes, note),
        asked=sum(arrow.count for arrow in arrows),
    )
    return with_legend(found)


def _box(graph: Graph, cluster: Cluster, flows: int) -> Box:
    inside = [box for box in graph.boxes if box.cluster == cluster.id]
    lines = (*cluster.lines, f"{len(inside)} inside") + ((plural(flows, "flow") + " inside",) if flows else ())
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


def _merged(arrows: list[Arrow], ends: dict[str, str]) -> tuple[Arrow, ...]:
    """Merge arrows that now have the same ends."""
    bundles: dict[tuple[str, str, bool], list[Arrow]] = {}
    for arrow in arrows:
        # Network links are kept apart from what flows: their arrows have no head.
        bundles.setdefault((ends[arrow.tail], ends[arrow.head], arrow.style == "link"), []).append(arrow)
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
