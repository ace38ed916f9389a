"""Fold groups, the largest first, until a picture of changes fits its budget, with a note of what was folded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

from archgen.views.changes.change_wording import CHANGE_SIGNS
from archgen.views.graph_shapes import Arrow, Box, Cluster, ElementChange, Graph
from archgen.views.graphs.changes.picture_budget import PictureBudget
from archgen.views.inline_text import count_noun

_CHANGE_KINDS: tuple[ElementChange, ...] = get_args(ElementChange)


def fold_to_budget(graph: Graph, budget: PictureBudget) -> Graph:
    """Fold as few groups as possible. If that is not enough, a note says that the picture is larger."""
    member_counts = Counter(box.cluster for box in graph.boxes)
    # Folding a group of one box would save nothing.
    largest = sorted(
        (cluster.id for cluster in graph.clusters if member_counts[cluster.id] > 1),
        key=lambda name: -member_counts[name],
    )
    folded_graph = graph
    for count in range(len(largest) + 1):
        folded_graph = _fold_groups(graph, set(largest[:count])) if count else graph
        if fits_budget(folded_graph, budget):
            return folded_graph
    size_note = (
        f"This picture is larger than {budget.boxes} boxes and {budget.arrows} arrows: `--select` shows a part of it."
    )
    return replace(folded_graph, notes=(*folded_graph.notes, size_note))


def fits_budget(graph: Graph, budget: PictureBudget) -> bool:
    """Whether a graph keeps to a budget."""
    return len(graph.boxes) <= budget.boxes and len(graph.arrows) <= budget.arrows


def _fold_groups(graph: Graph, group_ids: set[str]) -> Graph:
    new_box_ids = {box.id: f"group {box.cluster}" if box.cluster in group_ids else box.id for box in graph.boxes}
    outer_arrows = [arrow for arrow in graph.arrows if new_box_ids[arrow.tail] != new_box_ids[arrow.head]]
    inner_arrows = [arrow for arrow in graph.arrows if new_box_ids[arrow.tail] == new_box_ids[arrow.head]]
    boxes = [box for box in graph.boxes if box.cluster not in group_ids]
    boxes += [_folded_box(graph, cluster, inner_arrows) for cluster in graph.clusters if cluster.id in group_ids]
    note = f"{count_noun(len(group_ids), 'group')} folded to one box each, because the picture would be too large."
    return replace(
        graph,
        boxes=tuple(boxes),
        arrows=_merge_arrows(outer_arrows, new_box_ids),
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in group_ids),
        notes=(*graph.notes, note),
    )


def _folded_box(graph: Graph, cluster: Cluster, inner_arrows: Sequence[Arrow]) -> Box:
    inner_boxes = [box for box in graph.boxes if box.cluster == cluster.id]
    lines = [
        f"{CHANGE_SIGNS[change_kind]} {count_noun(count, 'component')}"
        for change_kind, count in _count_kinds(inner_boxes)
    ]
    inner_ids = {box.id for box in inner_boxes}
    flows = Counter(arrow.change for arrow in inner_arrows for _ in range(arrow.count) if arrow.tail in inner_ids)
    lines += [
        f"{CHANGE_SIGNS[change_kind]} {count_noun(flows[change_kind], 'connection')} inside"
        for change_kind in _CHANGE_KINDS
        if flows[change_kind]
    ]
    change_kinds = [change_kind for change_kind, _ in _count_kinds(inner_boxes)]
    changed_titles = [box.title for box in inner_boxes if box.change]
    return Box(
        f"group {cluster.id}",
        cluster.title,
        tuple(lines),
        style="fold",
        emphasis="normal" if change_kinds else "neighbour",
        ref=cluster.ref,
        tooltip="\n".join([cluster.title, *changed_titles]),
        # Different changes inside make the group as a whole "changed".
        change=(change_kinds[0] if len(change_kinds) == 1 else "changed") if change_kinds else None,
    )


def _count_kinds(inner_boxes: Sequence[Box]) -> list[tuple[ElementChange, int]]:
    kind_counts = Counter(box.change for box in inner_boxes)
    return [(kind, kind_counts[kind]) for kind in _CHANGE_KINDS if kind_counts[kind]]


def _merge_arrows(arrows: Sequence[Arrow], new_box_ids: dict[str, str]) -> tuple[Arrow, ...]:
    """Return one arrow for all that now have the same ends and the same change."""
    kept_arrows = [
        arrow for arrow in arrows if (new_box_ids[arrow.tail], new_box_ids[arrow.head]) == (arrow.tail, arrow.head)
    ]
    bundles: dict[tuple[str, str, ElementChange | None], list[Arrow]] = {}
    for arrow in arrows:
        if arrow not in kept_arrows:
            bundles.setdefault((new_box_ids[arrow.tail], new_box_ids[arrow.head], arrow.change), []).append(arrow)
    return (*kept_arrows, *(_join_arrows(bundle, *key) for key, bundle in bundles.items()))


def _join_arrows(bundle: Sequence[Arrow], tail: str, head: str, change: ElementChange | None) -> Arrow:
    count = sum(arrow.count for arrow in bundle)
    single_label = bundle[0].label if len(bundle) == 1 else ""
    return replace(
        bundle[0],
        id=f"{tail}>{head}:{change or 'same'}",
        tail=tail,
        head=head,
        label=single_label or (f"{CHANGE_SIGNS[change]} {count_noun(count, 'connection')}" if change else ""),
        style=bundle[0].style if len({arrow.style for arrow in bundle}) == 1 else "data",
        count=count,
        optional=False,
        flows=tuple(flow for arrow in bundle for flow in arrow.flows),
    )
