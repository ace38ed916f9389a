"""Fold groups, the largest first, until a picture of changes fits its budget, with a note of what was folded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

from archgen.views.changes.telling import SIGNS
from archgen.views.graphs.changes.budget import Budget
from archgen.views.shapes import Arrow, Box, Changed, Cluster, Graph
from archgen.views.words import plural

_KINDS: tuple[Changed, ...] = get_args(Changed)


def folded(graph: Graph, budget: Budget) -> Graph:
    """Fold as few groups as possible. If that is not enough, a note says that the picture is larger."""
    members = Counter(box.cluster for box in graph.boxes)
    # Folding a group of one box would save nothing.
    largest = sorted((c.id for c in graph.clusters if members[c.id] > 1), key=lambda name: -members[name])
    tried = graph
    for count in range(len(largest) + 1):
        tried = _folded(graph, set(largest[:count])) if count else graph
        if fits(tried, budget):
            return tried
    said = (
        f"This picture is larger than {budget.boxes} boxes and {budget.arrows} arrows: `--select` shows a part of it."
    )
    return replace(tried, notes=(*tried.notes, said))


def fits(graph: Graph, budget: Budget) -> bool:
    """Whether a graph keeps to a budget."""
    return len(graph.boxes) <= budget.boxes and len(graph.arrows) <= budget.arrows


def _folded(graph: Graph, names: set[str]) -> Graph:
    home = {box.id: f"group {box.cluster}" if box.cluster in names else box.id for box in graph.boxes}
    outer = [arrow for arrow in graph.arrows if home[arrow.tail] != home[arrow.head]]
    inner = [arrow for arrow in graph.arrows if home[arrow.tail] == home[arrow.head]]
    boxes = [box for box in graph.boxes if box.cluster not in names]
    boxes += [_box(graph, cluster, inner) for cluster in graph.clusters if cluster.id in names]
    note = f"{plural(len(names), 'group')} folded to one box each, because the picture would be too large."
    return replace(
        graph,
        boxes=tuple(boxes),
        arrows=_merged(outer, home),
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in names),
        notes=(*graph.notes, note),
    )


def _box(graph: Graph, cluster: Cluster, inner: Sequence[Arrow]) -> Box:
    inside = [box for box in graph.boxes if box.cluster == cluster.id]
    lines = [f"{SIGNS[kind]} {plural(count, 'component')}" for kind, count in _counts(inside)]
    within = {box.id for box in inside}
    flows = Counter(arrow.change for arrow in inner for _ in range(arrow.count) if arrow.tail in within)
    lines += [f"{SIGNS[kind]} {plural(flows[kind], 'connection')} inside" for kind in _KINDS if flows[kind]]
    kinds = [kind for kind, _ in _counts(inside)]
    changed = [box.title for box in inside if box.change]
    return Box(
        f"group {cluster.id}",
        cluster.title,
        tuple(lines),
        style="fold",
        emphasis="normal" if kinds else "neighbour",
        ref=cluster.ref,
        tooltip="\n".join([cluster.title, *changed]),
        # Different changes inside make the group as a whole "changed".
        change=(kinds[0] if len(kinds) == 1 else "changed") if kinds else None,
    )


def _counts(inside: Sequence[Box]) -> list[tuple[Changed, int]]:
    found = Counter(box.change for box in inside)
    return [(kind, found[kind]) for kind in _KINDS if found[kind]]


def _merged(arrows: Sequence[Arrow], home: dict[str, str]) -> tuple[Arrow, ...]:
    """Return one arrow for all that now have the same ends and the same change."""
    kept = [arrow for arrow in arrows if (home[arrow.tail], home[arrow.head]) == (arrow.tail, arrow.head)]
    bundles: dict[tuple[str, str, Changed | None], list[Arrow]] = {}
    for arrow in arrows:
        if arrow not in kept:
            bundles.setdefault((home[arrow.tail], home[arrow.head], arrow.change), []).append(arrow)
    return (*kept, *(_joined(bundle, *key) for key, bundle in bundles.items()))


def _joined(bundle: Sequence[Arrow], tail: str, head: str, change: Changed | None) -> Arrow:
    count = sum(arrow.count for arrow in bundle)
    alone = bundle[0].label if len(bundle) == 1 else ""
    return replace(
        bundle[0],
        id=f"{tail}>{head}:{change or 'same'}",
        tail=tail,
        head=head,
        label=alone or (f"{SIGNS[change]} {plural(count, 'connection')}" if change else ""),
        style=bundle[0].style if len({arrow.style for arrow in bundle}) == 1 else "data",
        count=count,
        optional=False,
        flows=tuple(flow for arrow in bundle for flow in arrow.flows),
    )
