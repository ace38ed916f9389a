"""Draw the whole: the groups, and all groups with their components (the first and the widest picture)."""

from __future__ import annotations

from archgen.frozen import replace
from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph
from archgen.views.graphs import element_boxes
from archgen.views.graphs.component_flows import ComponentFlow, merge_flows
from archgen.views.graphs.drawn_level import DrawnLevel
from archgen.views.graphs.legend_keys import add_legend_keys
from archgen.views.graphs.open_frames import draw_to_depth, find_drawn, list_opened, place_in_frames
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup


def draw_overview(lookup: Lookup) -> Graph:
    """Draw the groups, with one arrow for all that flows from one to another."""
    architecture = lookup.architecture
    between = _flows_between_groups(lookup)
    arrows = _colour_by_source(lookup, merge_flows(between, _groups_of_flow, labels=False, by_style=False))
    graph = Graph(
        "overview",
        f"{architecture.project.title}: groups",
        "overview",
        tuple(element_boxes.group_box(lookup, group) for group in architecture.groups),
        arrows,
        direction=architecture.layout.direction,
        alt=_describe_flows(lookup, f"{count_noun(len(architecture.groups), 'group')} of components", arrows),
        asked=len(between),
        kind="overview",
    )
    return add_legend_keys(graph)


def draw_components(lookup: Lookup, depth: int = 0) -> Graph:
    """Draw all groups with their components: flows inside a group one by one, between groups merged and counted.

    With composed components open to a depth all flows are drawn one by one.
    """

    def draw_opened(each: int) -> Graph:
        return _draw_open_components(lookup, each) if each else _draw_closed_components(lookup)

    return draw_to_depth(lookup.architecture, draw_opened, depth)


def _draw_open_components(lookup: Lookup, depth: int) -> Graph:
    architecture = lookup.architecture
    opened = list_opened(architecture, (each.id for each in DrawnLevel(lookup).list_boxes()), depth)
    level = DrawnLevel(lookup, opened)
    flows = level.list_flows()
    boxes, clusters = list[Box](), list[Cluster]()
    for group in architecture.groups:
        members = (find_drawn(architecture, name, opened) for name in level.list_group_boxes(group))
        own_boxes = (replace(element_boxes.component_box(lookup, each), colour=None) for each in members)
        placed_boxes, frames = place_in_frames(lookup, own_boxes, opened, group)
        boxes += placed_boxes
        clusters += [element_boxes.group_frame(lookup, group), *frames]
    arrows = merge_flows(flows, lambda flow: (flow.tail, flow.head), labels=False)
    graph = _draw_closed_components(lookup)
    return add_legend_keys(
        replace(
            graph,
            layout="framed",
            boxes=tuple(boxes),
            clusters=tuple(clusters),
            arrows=tuple(
                replace(arrow, colour=element_boxes.group_hue(lookup, _group_of(arrow.tail))) for arrow in arrows
            ),
            asked=len(flows),
        )
    )


def _draw_closed_components(lookup: Lookup) -> Graph:
    architecture, level = lookup.architecture, DrawnLevel(lookup)
    inside = [flow for flow in level.list_flows() if _group_of(flow.tail) == _group_of(flow.head)]
    between = _flows_between_groups(lookup)
    arrows = merge_flows(inside, lambda flow: (flow.tail, flow.head), labels=False)
    arrows += _colour_by_source(lookup, merge_flows(between, _groups_of_flow, labels=False, by_style=False))
    counted = (
        f"{count_noun(len(architecture.components), 'component')} in {count_noun(len(architecture.groups), 'group')}"
    )
    graph = Graph(
        "components",
        f"{architecture.project.title}: all components",
        "two-step",
        tuple(element_boxes.component_box(lookup, component) for component in level.list_boxes()),
        arrows,
        tuple(element_boxes.group_frame(lookup, group) for group in architecture.groups),
        direction=architecture.layout.direction,
        alt=_describe_flows(lookup, counted, arrows),
        asked=len(inside) + len(between),
        kind="components",
    )
    return add_legend_keys(graph)


def _flows_between_groups(lookup: Lookup) -> list[ComponentFlow]:
    """Return the flows between groups. A connection to a whole group counts once."""
    flow_by_source: dict[tuple[int, str], ComponentFlow] = {}
    for flow in DrawnLevel(lookup).list_flows():
        if _group_of(flow.tail) != _group_of(flow.head):
            # By identity of the connection, and by source: one connection may take from several groups.
            flow_by_source.setdefault((id(flow.connection), _group_of(flow.tail)), flow)
    return list(flow_by_source.values())


def _group_of(component_id: str) -> str:
    return component_id.split(".", 1)[0]


def _groups_of_flow(flow: ComponentFlow) -> tuple[str, str]:
    return _group_of(flow.tail), _group_of(flow.head)


def _colour_by_source(lookup: Lookup, arrows: tuple[Arrow, ...]) -> tuple[Arrow, ...]:
    """Colour each arrow with the hue of the group that it comes from."""
    return tuple(replace(arrow, colour=element_boxes.group_hue(lookup, arrow.tail)) for arrow in arrows)


def _describe_flows(lookup: Lookup, subject: str, arrows: tuple[Arrow, ...]) -> str:
    strongest = sorted((arrow for arrow in arrows if arrow.tail in lookup.architecture.groups), key=lambda a: -a.count)
    titles = {key: group.title for key, group in lookup.architecture.groups.items()}
    strongest_words = "; ".join(f"{titles[a.tail]} to {titles[a.head]} ({a.count})" for a in strongest[:5])
    return (
        f"{subject}. Most runs from {strongest_words}."
        if strongest_words
        else f"{subject}. Nothing runs between groups yet."
    )
