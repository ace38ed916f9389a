"""Draw a part: what a selector names, with its neighbours in grey, at either level. The project's views are such parts.

A small part is one flow with a label at each arrow. A large one has frames, and its neighbours are folded by group.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from archgen.diagnostics import fit_lines
from archgen.frozen import replace
from archgen.model.architecture import View
from archgen.model.component import Component
from archgen.model.component_nesting import find_component
from archgen.model.port_media import label_of_medium
from archgen.model.selector_evaluation import Selection
from archgen.views.graphs import element_boxes, implementation_graph
from archgen.views.graphs.composed_graph import draw_to_depth, find_drawn, list_opened, place_in_frames
from archgen.views.graphs.drawn_level import ComponentFlow, DrawnLevel, list_open_shells, merge_flows
from archgen.views.graphs.graph_folding import add_legend_keys, fold_graph
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph

_SMALL_PICTURE = (26, 45)
"""The most boxes and arrows of a small picture."""
_LINES_PER_BOX = 4


def draw_functional_part(
    lookup: Lookup, graph_id: str, title: str, component_ids: Collection[str], depth: int = 0
) -> Graph:
    """Draw selected components and their neighbours; composed ones among the former are open to a depth."""

    def draw_opened(each: int) -> Graph:
        return _draw_part(lookup, graph_id, title, component_ids, each)

    return draw_to_depth(lookup.architecture, draw_opened, depth)


def _draw_part(lookup: Lookup, graph_id: str, title: str, component_ids: Collection[str], depth: int) -> Graph:
    architecture = lookup.architecture
    partly_open = list_open_shells(architecture, component_ids)
    shown_ids = [name for name in architecture.components if name in component_ids]
    closed_ids = dict.fromkeys(DrawnLevel(lookup, partly_open).find_box(name) for name in shown_ids)
    opened = list_opened(architecture, (name for name in closed_ids if name not in partly_open), depth)
    level = DrawnLevel(lookup, partly_open | opened)
    box_ids = {level.find_box(name): name for name in shown_ids}
    components = [find_drawn(architecture, name, opened) for name in box_ids]
    touching_flows = level.list_flows_at(box_ids)
    neighbour_ids = dict.fromkeys(
        end for flow in touching_flows for end in (flow.tail, flow.head) if end not in box_ids
    )
    is_small = len(components) + len(neighbour_ids) <= _SMALL_PICTURE[0] and len(touching_flows) <= _SMALL_PICTURE[1]
    graph = (_draw_small_part if is_small or opened else _draw_large_part)(
        lookup, components, touching_flows, list(neighbour_ids)
    )
    if opened:
        placed_boxes, placed_frames = place_in_frames(lookup, graph.boxes, opened, None)
        # The group is said at the outermost frame, instead of at each box inside.
        boxes = tuple(replace(box, lines=box.lines[1:]) if box.cluster else box for box in placed_boxes)
        frames = tuple(frame if frame.parent else _name_group(lookup, frame) for frame in placed_frames)
        arrows = graph.arrows if is_small else tuple(replace(arrow, label="") for arrow in graph.arrows)
        graph = replace(graph, layout="framed", boxes=boxes, clusters=frames, arrows=arrows)
    summary = (
        f"{count_noun(len(components), 'component')}: {', '.join(component.title for component in components[:12])}"
    )
    return fold_graph(
        add_legend_keys(
            replace(
                graph,
                id=graph_id,
                title=title,
                direction=lookup.architecture.layout.direction,
                alt=f"{summary}{', ...' if len(components) > 12 else ''}. {count_noun(len(neighbour_ids), 'neighbour')} in grey.",  # noqa: PLR2004
            )
        )
    )


def _draw_small_part(
    lookup: Lookup,
    components: Sequence[Component],
    touching_flows: Sequence[ComponentFlow],
    neighbour_ids: Sequence[str],
) -> Graph:
    architecture = lookup.architecture
    titles = {group.id: group.title for group in architecture.groups.values()}
    chosen_boxes = [
        replace(element_boxes.component_box(lookup, each, lines=(titles[each.group],)), cluster=None)
        for each in components
    ]
    neighbour_boxes = [
        element_boxes.neighbour_box(lookup, find_component(architecture, each), None) for each in neighbour_ids
    ]
    arrows = merge_flows(touching_flows, lambda flow: (flow.tail, flow.head), labels=True)
    return Graph("", "", "flow", (*chosen_boxes, *neighbour_boxes), arrows, asked=len(touching_flows), kind="overview")


def _name_group(lookup: Lookup, frame: Cluster) -> Cluster:
    group = lookup.architecture.groups[(frame.ref or "").removeprefix("component:").partition(".")[0]]
    return replace(frame, lines=(" · ".join((group.title, *frame.lines)),))


def _draw_large_part(
    lookup: Lookup,
    components: Sequence[Component],
    touching_flows: Sequence[ComponentFlow],
    neighbour_ids: Sequence[str],
) -> Graph:
    component_ids = {component.id for component in components}
    groups = dict.fromkeys(component.group for component in components)
    outside_groups = dict.fromkeys(each.split(".", 1)[0] for each in neighbour_ids)

    def find_home(component_id: str) -> str:
        group = component_id.split(".", 1)[0]
        return group if component_id in component_ids else f"around {group}"

    def find_ends(flow: ComponentFlow) -> tuple[str, str]:
        tail, head = find_home(flow.tail), find_home(flow.head)
        return (flow.tail, flow.head) if tail == head else (tail, head)

    neighbour_boxes = [
        _neighbour_group_box(lookup, group, [c for c in neighbour_ids if c.split(".", 1)[0] == group])
        for group in outside_groups
    ]
    inner_arrows = merge_flows(
        [flow for flow in touching_flows if find_home(flow.tail) == find_home(flow.head)], find_ends, labels=False
    )
    outer_arrows = merge_flows(
        [flow for flow in touching_flows if find_home(flow.tail) != find_home(flow.head)],
        find_ends,
        labels=False,
        by_style=False,
    )
    coloured_arrows = tuple(_colour_outer_arrow(lookup, arrow) for arrow in outer_arrows)
    return Graph(
        "",
        "",
        "two-step",
        (*(element_boxes.component_box(lookup, each) for each in components), *neighbour_boxes),
        (*inner_arrows, *coloured_arrows),
        tuple(element_boxes.group_frame(lookup, group) for group in groups),
        asked=len(touching_flows),
        kind="overview",
    )


def _colour_outer_arrow(lookup: Lookup, arrow: Arrow) -> Arrow:
    return (
        replace(arrow, colour=element_boxes.group_hue(lookup, arrow.tail))
        if arrow.tail in lookup.group_hues
        else replace(arrow, faded=True)
    )


def _neighbour_group_box(lookup: Lookup, group: str, member_ids: Sequence[str]) -> Box:
    """Return the neighbours in one group as one grey box."""
    titles = [find_component(lookup.architecture, each).title for each in member_ids]
    group_box, lines = element_boxes.group_box(lookup, group), tuple(fit_lines(titles, _LINES_PER_BOX))
    return replace(group_box, id=f"around {group}", emphasis="neighbour", lines=lines, tooltip="\n".join(titles))


def draw_implementation_part(lookup: Lookup, graph_id: str, title: str, node_ids: Collection[str]) -> Graph:
    """Draw selected nodes with what runs to and from them. A small part has its topics as boxes."""
    node_flows = [
        each
        for each in element_boxes.list_node_flows(lookup.architecture)
        if each.tail in node_ids or each.head in node_ids
    ]
    neighbour_ids = dict.fromkeys(end for each in node_flows for end in (each.tail, each.head) if end not in node_ids)
    topics = {each.topic.name: each.topic for each in node_flows}
    if len(node_ids) + len(neighbour_ids) + len(topics) > _SMALL_PICTURE[1]:
        return implementation_graph.draw_nodes(lookup, graph_id, title, node_ids)
    all_nodes = lookup.architecture.nodes
    chosen_boxes = [
        element_boxes.node_box(lookup, node, is_subject=False) for node in all_nodes.values() if node.id in node_ids
    ]
    neighbour_boxes = [
        replace(element_boxes.node_box(lookup, all_nodes[each]), emphasis="neighbour", badge=None)
        for each in neighbour_ids
    ]
    arrows: dict[str, Arrow] = {}
    for each in node_flows:
        style = "data" if each.topic.flow == "topic" else each.topic.flow
        box = f"topic {each.topic.name}"
        # Several flows share a topic's box: its arrows are drawn once, with the sentences of all of them.
        for tail, head in ((each.tail, box), (box, each.head)):
            arrow_id = f"{tail}>{head}"
            sentences = (*arrows[arrow_id].flows, each.sentence) if arrow_id in arrows else (each.sentence,)
            arrows[arrow_id] = Arrow(
                arrow_id,
                tail,
                head,
                style=style,
                flows=tuple(dict.fromkeys(sentences)),
                medium=label_of_medium(each.topic),
            )
    graph = Graph(
        graph_id,
        title,
        "flow",
        (
            *chosen_boxes,
            *(element_boxes.topic_box(topic) for topic in topics.values()),
            *neighbour_boxes,
        ),
        tuple(arrows.values()),
        direction=lookup.architecture.layout.direction,
        alt=f"{count_noun(len(chosen_boxes), 'node')} with {count_noun(len(topics), 'topic')} and {count_noun(len(neighbour_boxes), 'neighbour')} in grey.",
        asked=len(arrows),
        kind="ros",
    )
    return fold_graph(add_legend_keys(graph))


def draw_view(lookup: Lookup, project_view: View, selection: Selection, depth: int = 0) -> Graph:
    """Draw one of the project's views; `depth` holds where it does not say how deep it opens composed components."""
    name = f"views/{project_view.id}"
    if project_view.level == "implementation":
        graph = draw_implementation_part(lookup, name, project_view.title, selection.nodes)
    else:
        own_depth = depth if project_view.depth is None else project_view.depth
        graph = draw_functional_part(lookup, name, project_view.title, selection.components, own_depth)
    graph = replace(graph, kind="view", direction=project_view.layout.direction or graph.direction)
    return (
        colour_graph(lookup, graph, project_view.colour)
        if project_view.colour and project_view.colour != "group"
        else graph
    )


def colour_graph(lookup: Lookup, graph: Graph, criterion: str) -> Graph:
    """Colour a graph by another criterion than the group (`owner`, `role`, ...), and say so in the legend."""
    values = {
        box.id: value
        for box in graph.boxes
        if (value := _colour_value(lookup, box, criterion)) and box.emphasis != "neighbour"
    }
    hues = {value: at % 10 for at, value in enumerate(dict.fromkeys(values.values()))}
    coloured_boxes = tuple(
        replace(box, colour=hues[values[box.id]] if box.id in values else None) if box.emphasis != "neighbour" else box
        for box in graph.boxes
    )
    # Hues of groups would be read as values of the criterion, so frames and arrows lose theirs.
    plain_clusters = tuple(replace(cluster, colour=None) for cluster in graph.clusters)
    arrows = tuple(replace(arrow, colour=None) for arrow in graph.arrows)
    legend = tuple((hue, f"{criterion}: {value}") for value, hue in hues.items())
    return replace(graph, boxes=coloured_boxes, clusters=plain_clusters, arrows=arrows, legend_colours=legend)


def _colour_value(lookup: Lookup, box: Box, criterion: str) -> str | None:
    component = lookup.architecture.shells.get(box.id) or lookup.architecture.components.get(box.id)
    node = lookup.architecture.nodes.get(box.id)
    item = component or node
    if item is None:
        return None
    # Functions, so that only the one that is asked for is evaluated.
    values: dict[str, Callable[[], str | None]] = {
        "owner": lambda: element_boxes.join_owner_titles(lookup, item.owners) or None,
        "role": lambda: component.role if component else None,
        "status": lambda: node.status if node else _component_status(lookup, box.id),
        "host": lambda: node.host if node else None,
        "package": lambda: node.package if node else None,
        "tag": lambda: ", ".join(item.tags) or None,
    }
    return values.get(criterion, lambda: None)()


def _component_status(lookup: Lookup, component_id: str) -> str | None:
    statuses = dict.fromkeys(node.status for node in lookup.nodes_of.get(component_id, ()) if node.status)
    return ", ".join(statuses) or None
