"""Draw the whole ROS graph: all nodes, framed by the group of what they implement, and what runs between them.

Inside a frame each pair of nodes has its arrow; between frames the arrows are merged and counted.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from archgen.model.node import Node
from archgen.views.graphs import boxes, nodes
from archgen.views.graphs.folding import fold
from archgen.views.graphs.legend import with_legend
from archgen.views.graphs.nodes import Pass
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Cluster, Graph
from archgen.views.words import plural


def ros(view: Index) -> Graph:
    """Draw all nodes."""
    title = f"{view.architecture.project.title}: nodes"
    return between(view, "ros", title, set(view.architecture.nodes))


def between(view: Index, name: str, title: str, chosen: Collection[str]) -> Graph:
    """Draw some nodes and all that runs among them."""
    found = [node for node in view.architecture.nodes.values() if node.id in chosen]
    home = {node.id: home_of(view, node) for node in found}
    running = [each for each in nodes.passes(view.architecture) if each.tail in home and each.head in home]
    frames = tuple(_frame(view, each) for each in dict.fromkeys(home.values()))
    arrows = _arrows(view, running, home)
    graph = Graph(
        name,
        title,
        "two-step",
        tuple(replace(_box(view, node), cluster=home[node.id]) for node in found),
        arrows,
        frames,
        direction=view.architecture.layout.direction or "left-right",
        alt=f"{plural(len(found), 'node')} in {plural(len(frames), 'frame')}; "
        f"{plural(len(running), 'flow')} over topics, services and actions among them.",
        asked=len(running),
    )
    return fold(with_legend(graph))


def _box(view: Index, node: Node) -> Box:
    return nodes.node(view, node)


def home_of(view: Index, node: Node) -> str:
    """Return the id of a node's frame: the first group of what it implements, else its namespace."""
    groups = [component.split(".", 1)[0] for component in node.implements]
    return next((group for group in groups if group in view.architecture.groups), f"namespace {node.namespace}")


def _frame(view: Index, home: str) -> Cluster:
    if home in view.architecture.groups:
        return boxes.frame(view, home)
    return Cluster(home, home.removeprefix("namespace "), tooltip=f"Nodes in {home} that implement no component")


def _arrows(view: Index, running: Sequence[Pass], home: dict[str, str]) -> tuple[Arrow, ...]:
    bundles: dict[tuple[str, str, str], list[Pass]] = {}
    for each in running:
        tail, head = home[each.tail], home[each.head]
        inside = tail == head
        style = "data" if each.topic.flow == "topic" else each.topic.flow
        ends = (each.tail, each.head, style) if inside else (tail, head, "data")
        bundles.setdefault(ends, []).append(each)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            style=style,  # type: ignore[arg-type]
            count=len(bundle),
            # A frame may be a namespace, which has no hue, and a node may have the id of a group.
            colour=boxes.hue(view, tail) if tail in view.hues and tail not in home else None,
            flows=tuple(each.sentence for each in bundle),
        )
        for (tail, head, style), bundle in bundles.items()
    )
