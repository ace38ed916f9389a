"""Draw the whole ROS graph: all nodes, framed by the group of what they implement, and what runs between them.

Inside a frame each pair of nodes has its arrow; between frames the arrows are merged and counted.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from archgen.frozen import replace
from archgen.model.node import Node
from archgen.model.port_media import label_of_medium
from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph
from archgen.views.graphs import element_boxes
from archgen.views.graphs.element_boxes import NodeFlow
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.graphs.legend_keys import add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup


def draw_ros_graph(lookup: Lookup) -> Graph:
    """Draw all nodes."""
    title = f"{lookup.architecture.project.title}: nodes"
    return draw_nodes(lookup, "ros", title, set(lookup.architecture.nodes))


def draw_nodes(lookup: Lookup, graph_id: str, title: str, node_ids: Collection[str]) -> Graph:
    """Draw some nodes and all that runs among them."""
    chosen_nodes = [node for node in lookup.architecture.nodes.values() if node.id in node_ids]
    home_frames = {node.id: find_home_frame(lookup, node) for node in chosen_nodes}
    node_flows = [
        each
        for each in element_boxes.list_node_flows(lookup.architecture)
        if each.tail in home_frames and each.head in home_frames
    ]
    frames = tuple(draw_home_frame(lookup, each) for each in dict.fromkeys(home_frames.values()))
    arrows = _merge_node_flows(lookup, node_flows, home_frames)
    graph = Graph(
        graph_id,
        title,
        "two-step",
        tuple(replace(_node_box(lookup, node), cluster=home_frames[node.id]) for node in chosen_nodes),
        arrows,
        frames,
        direction=lookup.architecture.layout.direction,
        alt=f"{count_noun(len(chosen_nodes), 'node')} in {count_noun(len(frames), 'frame')}; "
        f"{count_noun(len(node_flows), 'flow')} over topics, services and actions among them.",
        asked=len(node_flows),
        kind="ros",
    )
    return fold_graph(add_legend_keys(graph))


def _node_box(lookup: Lookup, node: Node) -> Box:
    return element_boxes.node_box(lookup, node)


def find_home_frame(lookup: Lookup, node: Node) -> str:
    """Return the id of a node's frame: the first group of what it implements, else its namespace."""
    groups = [component.split(".", 1)[0] for component in node.implements]
    return next((group for group in groups if group in lookup.architecture.groups), f"namespace {node.namespace}")


def draw_home_frame(lookup: Lookup, home: str) -> Cluster:
    """Return the frame of a group or a namespace."""
    if home in lookup.architecture.groups:
        return element_boxes.group_frame(lookup, home)
    return Cluster(home, home.removeprefix("namespace "), tooltip=f"Nodes in {home} that implement no component")


def _merge_node_flows(lookup: Lookup, node_flows: Sequence[NodeFlow], home_frames: dict[str, str]) -> tuple[Arrow, ...]:
    bundles: dict[tuple[str, str, str, str], list[NodeFlow]] = {}
    for each in node_flows:
        tail, head = home_frames[each.tail], home_frames[each.head]
        is_inside = tail == head
        style = "data" if each.topic.flow == "topic" else each.topic.flow
        medium = label_of_medium(each.topic)
        ends = (each.tail, each.head, style, medium) if is_inside else (tail, head, "data", medium)
        bundles.setdefault(ends, []).append(each)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}" + (f":{medium}" if medium else ""),
            tail,
            head,
            style=style,  # type: ignore[arg-type]
            label=(f"({medium})" if len(bundle) == 1 else f"{len(bundle)} ({medium})") if medium else "",
            medium=medium,
            count=len(bundle),
            # A frame may be a namespace, which has no hue, and a node may have the id of a group.
            colour=element_boxes.group_hue(lookup, tail)
            if tail in lookup.group_hues and tail not in home_frames
            else None,
            flows=tuple(each.sentence for each in bundle),
        )
        for (tail, head, style, medium), bundle in bundles.items()
    )
