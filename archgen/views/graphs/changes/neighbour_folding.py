"""Fold the surroundings of a change: what did not change, and what no changed connection reaches, is one grey box a group.

Only groups in which something changed have a frame. A folded group that feeds what changed and reads from it has a box
for each, so that nothing runs backwards.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph

_MAX_NAMES = 6
"""A folded group of more components names all but the last ones; its tooltip names all."""
_FEEDER, _READER = "<", ">"


def fold_neighbours(graph: Graph) -> Graph:
    """Return a picture of changes with frames only where something changed, and a box for each group beside them."""
    quiet_frames = {
        cluster.id: cluster
        for cluster in graph.clusters
        # A sign before the title tells of a change of the group itself.
        if cluster.title == cluster.tooltip and not any(_is_changed(box) for box in _list_members(graph, cluster))
    }
    loud_ends = {end for arrow in graph.arrows if arrow.change or arrow.broken for end in (arrow.tail, arrow.head)}
    folded = {box.id: box for box in graph.boxes if box.cluster in quiet_frames and box.id not in loud_ends}
    arrows = _join_arrows(graph.arrows, folded)
    touched = {end for arrow in arrows for end in (arrow.tail, arrow.head)}
    boxes = [
        _name_group(box, quiet_frames[box.cluster]) if box.cluster in quiet_frames else box
        for box in graph.boxes
        if box.id not in folded
    ]
    for cluster in quiet_frames.values():
        members = [box for box in folded.values() if box.cluster == cluster.id]
        boxes += _draw_sides(cluster, members, graph.arrows, touched)
    return replace(
        graph,
        boxes=tuple(boxes),
        arrows=arrows,
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in quiet_frames),
    )


def _is_changed(box: Box) -> bool:
    return box.change is not None or box.broken


def _list_members(graph: Graph, cluster: Cluster) -> list[Box]:
    return [box for box in graph.boxes if box.cluster == cluster.id]


def _name_group(box: Box, cluster: Cluster) -> Box:
    """Return the box of a component without its frame: the group is said below the title."""
    place = " · ".join((cluster.title, *box.lines[:1]))
    return replace(box, lines=(place, *box.lines[1:]), cluster=None)


def _join_arrows(arrows: Sequence[Arrow], folded: Mapping[str, Box]) -> tuple[Arrow, ...]:
    """Return the arrows with those from or to a folded group as one."""
    bundles: dict[tuple[str, str, str], list[Arrow]] = {}
    for arrow in arrows:
        tail, head = _name_side(arrow.tail, _FEEDER, folded), _name_side(arrow.head, _READER, folded)
        is_kept = (tail, head) == (arrow.tail, arrow.head)
        bundles.setdefault((tail, head, arrow.id if is_kept else arrow.style), []).append(arrow)
    return tuple(_join_bundle(tail, head, bundle) for (tail, head, _), bundle in bundles.items())


def _name_side(box_id: str, side: str, folded: Mapping[str, Box]) -> str:
    return f"{side}{folded[box_id].cluster}" if box_id in folded else box_id


def _join_bundle(tail: str, head: str, bundle: Sequence[Arrow]) -> Arrow:
    first = bundle[0]
    if (tail, head) == (first.tail, first.head):
        return first
    return replace(
        first,
        id=f"{tail}>{head}:{first.style}:same",
        tail=tail,
        head=head,
        count=sum(arrow.count for arrow in bundle),
        optional=all(arrow.optional for arrow in bundle),
        flows=tuple(flow for arrow in bundle for flow in arrow.flows),
    )


def _draw_sides(cluster: Cluster, members: Sequence[Box], arrows: Sequence[Arrow], touched: set[str]) -> Iterator[Box]:
    """Yield the box of a folded group that feeds what changed, and the one that reads from it."""
    tails, heads = {arrow.tail for arrow in arrows}, {arrow.head for arrow in arrows}
    for side, ends in ((_FEEDER, tails), (_READER, heads)):
        if f"{side}{cluster.id}" in touched:
            yield _draw_group(f"{side}{cluster.id}", cluster, [box for box in members if box.id in ends])


def _draw_group(box_id: str, cluster: Cluster, members: Sequence[Box]) -> Box:
    if len(members) == 1:
        return replace(_name_group(members[0], cluster), id=box_id)
    names = [" · ".join((*box.lines[:1], box.title)) for box in members]
    shown = names if len(names) <= _MAX_NAMES else [*names[: _MAX_NAMES - 1], f"and {len(names) - _MAX_NAMES + 1} more"]
    return Box(
        box_id,
        cluster.title,
        tuple(shown),
        style="group",
        emphasis="neighbour",
        ref=cluster.ref,
        tooltip="\n".join((cluster.title, *names)),
    )
