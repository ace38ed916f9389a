"""Keep pictures within a budget: above it each frame is folded into a box that lists what is in it, and a note says so.

All frames of a kind are folded or none: a reader could not see why one is open and another is not. The frames of the
neighbours come first, so that what a picture is about stays open as long as it fits.

Thin out a picture of the whole architecture that is still too large when all its frames are folded.

A picture of 100 groups and 490 arrows took dot three seconds, and nobody could follow an arrow in it. So the boxes with
most flows are drawn, and of the arrows between them those that carry most from each box. A note says how many are left
out; the explorer, the matrices and the tables have all of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import get_args

from archgen.frozen import replace
from archgen.grouping import group_pairs
from archgen.views.inline_text import count_noun
from archgen.views.picture_shapes import Arrow, Box, Cluster, ElementChange, Graph, PeriodStep

MAX_BOXES = 70
MAX_ARROWS = 160
_LIST_WIDTH = 56
_MAX_LIST_ROWS = 14


def fold_graph(graph: Graph, max_arrows: int = MAX_ARROWS) -> Graph:
    """Fold a graph until it fits the budget. One that still does not fit is thinned out where it shows the whole; another
    gets a note that says so.
    """
    if _fits_budget(graph, max_arrows):
        return graph
    members = Counter(box.cluster for box in graph.boxes)
    # Folding a frame with a single box saves nothing.
    foldable = [cluster for cluster in graph.clusters if members[cluster.id] > 1]
    neighbours = {cluster.id for cluster in foldable if cluster.emphasis == "neighbour"}
    folded = graph
    for cluster_ids in (neighbours, {cluster.id for cluster in foldable}):
        if cluster_ids:
            folded = _fold_clusters(graph, cluster_ids, max_arrows)
            if _fits_budget(folded, max_arrows):
                return folded
    if graph.kind in WHOLE_KINDS and (len(folded.boxes) > MAX_DRAWN_BOXES or len(folded.arrows) > max_arrows):
        return thin_graph(folded, max_arrows)
    note = f"This picture is larger than {MAX_BOXES} boxes and {max_arrows} arrows: select a part to see it well."
    return replace(folded, notes=(*folded.notes, note))


def _fits_budget(graph: Graph, max_arrows: int) -> bool:
    return len(graph.boxes) <= MAX_BOXES and len(graph.arrows) <= max_arrows


def _fold_clusters(graph: Graph, cluster_ids: set[str], max_arrows: int) -> Graph:
    drawn_ids = {box.id: box.cluster if box.cluster in cluster_ids else box.id for box in graph.boxes}
    drawn_ids |= {cluster.id: cluster.id for cluster in graph.clusters}
    outer_arrows = [arrow for arrow in graph.arrows if drawn_ids[arrow.tail] != drawn_ids[arrow.head]]
    flows_within = Counter[str]()
    for arrow in graph.arrows:
        if (drawn_id := drawn_ids[arrow.tail]) == drawn_ids[arrow.head] and drawn_id in cluster_ids:
            flows_within[drawn_id] += arrow.count
    boxes = [box for box in graph.boxes if box.cluster not in cluster_ids]
    boxes_inside = group_pairs((box.cluster, box) for box in graph.boxes)
    boxes += [
        _folded_box(cluster, boxes_inside[cluster.id], flows_within[cluster.id])
        for cluster in graph.clusters
        if cluster.id in cluster_ids
    ]
    arrows = merge_arrows(outer_arrows, {key: str(value) for key, value in drawn_ids.items()})
    kinds = {cluster.emphasis == "neighbour" for cluster in graph.clusters if cluster.id in cluster_ids}
    folded_words = "Each group of neighbours" if kinds == {True} else "Each group"
    note = (
        f"{folded_words} is one box that lists what is in it, because the picture would be larger than {MAX_BOXES} boxes "
        f"and {max_arrows} arrows; {count_noun(sum(flows_within.values()), 'flow')} inside not drawn."
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


def _folded_box(cluster: Cluster, inside: Sequence[Box], flows: int) -> Box:
    counts = f"{len(inside)} inside" + (f", {count_noun(flows, 'flow')} among them" if flows else "")
    lines = (*cluster.lines, counts, *_list_titles([box.title for box in inside]))
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


def _list_titles(titles: Sequence[str]) -> Iterator[str]:
    """Yield titles side by side, in rows; of more than fit the rest is counted."""
    rows: list[list[str]] = [[]]
    for title in titles:
        if rows[-1] and len(" · ".join([*rows[-1], title])) > _LIST_WIDTH:
            rows.append([])
        rows[-1].append(title)
    shown_rows = rows if len(rows) <= _MAX_LIST_ROWS else rows[: _MAX_LIST_ROWS - 1]
    yield from (" · ".join(row) for row in shown_rows)
    hidden = sum(len(row) for row in rows[len(shown_rows) :])
    if hidden:
        yield f"and {hidden} more"


def merge_arrows(arrows: list[Arrow], drawn_ids: dict[str, str]) -> tuple[Arrow, ...]:
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


_BADGE_KEYS = ("badge:error", "badge:warning", "badge:note", "badge:inside")
_BOX_KEYS = ("composed", "port", "source", "sink", "reactive", "external", "node", "topic", "fold")
_BOX_KEY_OF_FLOW = {"service": "service-box", "action": "action-box"}
_STATUS_KEYS = ("planned", "adapted")
# The first six of the literals are the steps of the scale; `event` and the others have no period.
_PERIOD_SCALE = get_args(PeriodStep)[:6]
_ARROW_KEYS = ("optional", "made", "physical", "medium", "service", "action", "internal", "link")


def add_legend_keys(graph: Graph, *extra: str) -> Graph:
    """Add the legend keys that a picture needs, in the legend's order."""
    return replace(graph, legend=tuple(dict.fromkeys((*_legend_keys(graph), *extra))))


def _legend_keys(graph: Graph) -> list[str]:
    kinds = {kind for box in graph.boxes for kind in _box_kinds(box)}
    arrow_kinds = {kind for arrow in graph.arrows for kind in _arrow_kinds(arrow)}
    keys = [
        key for key in ("subject", "neighbour", *_BOX_KEYS, *_BOX_KEY_OF_FLOW.values(), *_STATUS_KEYS) if key in kinds
    ]
    keys += [key for key in _BADGE_KEYS if key in kinds]
    keys += _period_keys(graph)
    keys += _change_keys(graph)
    keys += [key for key in _ARROW_KEYS if key in arrow_kinds]
    keys += ["star"] if any(line.startswith("*") for arrow in graph.arrows for line in arrow.label.split("\n")) else []
    # Only these layouts draw the number of flows, as text and as width (`merged` in `style_graph`).
    if graph.layout == "overview":
        return [*keys, "heads"] if graph.arrows else keys
    has_widths = graph.layout == "two-step" and any(arrow.count > 1 for arrow in graph.arrows)
    return [*keys, "count"] if has_widths else keys


def _change_keys(graph: Graph) -> list[str]:
    """Return keys for what happened to boxes and arrows, and for arrows that are as before, where two versions are
    drawn.
    """
    boxes = {"broken" if box.broken else box.change for box in graph.boxes}
    lines = {"broken" if arrow.broken else arrow.change or "same" for arrow in graph.arrows}
    if boxes == {None} and lines <= {"same"}:
        return []
    return [f"change:{kind}" for kind in ("broken", *get_args(ElementChange)) if kind in boxes] + [
        f"line:{kind}" for kind in ("broken", *get_args(ElementChange), "same") if kind in lines
    ]


def _period_keys(graph: Graph) -> list[str]:
    """Return the whole scale of periods where boxes are filled by it, and what else they are filled with."""
    used = {box.fill for box in graph.boxes} - {None}
    return [f"pace:{pace}" for pace in get_args(PeriodStep) if pace in used or pace in _PERIOD_SCALE] if used else []


def _box_kinds(box: Box) -> set[str]:
    kinds = {_BOX_KEY_OF_FLOW.get(box.style, "external" if box.style in {"physical", "partner"} else box.style)}
    kinds |= {f"badge:{box.badge}"} if box.badge else set()
    kinds |= {"badge:inside"} if box.badge_count else set()
    return kinds | {box.emphasis} | ({box.status} if box.status else set())


def _arrow_kinds(arrow: Arrow) -> set[str]:
    return (
        {str(arrow.style)}
        | ({"optional"} if arrow.optional else set())
        | ({"made"} if arrow.is_made else set())
        | ({"medium"} if arrow.medium else set())
    )
