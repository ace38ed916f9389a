"""Draw groups: one with its neighbours at both sides, the groups alone, and all groups with their components."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

from archgen.diagnostics import fit_lines
from archgen.frozen import replace
from archgen.model.component import Component
from archgen.model.component_nesting import find_component, list_members
from archgen.views.graphs import element_boxes
from archgen.views.graphs.composed_graph import draw_to_depth, find_drawn, list_opened, place_in_frames
from archgen.views.graphs.drawn_level import ComponentFlow, DrawnLevel, merge_flows
from archgen.views.graphs.graph_folding import add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Arrow, Box, Cluster, Graph

Direction = Literal["left-right", "top-bottom"]
MAX_FLOWS = 45
"""With more flows the neighbours are folded by group."""
_MAX_TITLES = 6
"""How many lines with titles of components a folded group has; its tooltip has them all."""


def draw_group(lookup: Lookup, group_id: str, depth: int = 0) -> Graph:
    """Draw one group with its neighbours; its composed components are open to a depth."""
    return draw_to_depth(lookup.architecture, lambda each: _draw_opened(lookup, group_id, each), depth)


def _draw_opened(lookup: Lookup, group_id: str, depth: int) -> Graph:
    group = lookup.architecture.groups[group_id]
    opened = list_opened(lookup.architecture, list_members(lookup.architecture, group_id), depth)
    level = DrawnLevel(lookup, opened)
    own_ids = set(level.list_group_boxes(group_id))
    touching_flows = level.list_flows_at(own_ids)
    is_folded = len(touching_flows) > MAX_FLOWS
    placed_flows = [_place_flow(flow, own_ids, is_folded=is_folded) for flow in touching_flows]
    neighbour_boxes = _draw_neighbours(lookup, placed_flows, own_ids, is_folded=is_folded)
    # By identity: hashing a flow would hash its connection with all that it holds.
    ends = {id(flow): (tail, head) for flow, tail, head in placed_flows}
    arrows = merge_flows(touching_flows, lambda flow: ends[id(flow)], labels=not is_folded)
    arrows = tuple(_label_arrow(lookup, arrow, own_ids, group_id, is_folded=is_folded) for arrow in arrows)
    members = (find_drawn(lookup.architecture, each, opened) for each in level.list_group_boxes(group_id))
    boxes, frames = place_in_frames(lookup, (_draw_member(lookup, each) for each in members), opened, group_id)
    graph = Graph(
        f"groups/{group_id}",
        group.title,
        "group",
        # Without a hue: all of them are in the same group, and its frame has it.
        (*boxes, *neighbour_boxes),
        arrows,
        (element_boxes.group_frame(lookup, group_id), *frames),
        direction=group.layout.direction or lookup.architecture.layout.direction,
        notes=("Neighbours are folded: a box for each group, with the number of flows.",) if is_folded else (),
        alt=_describe_group(lookup, group_id, touching_flows, own_ids),
        asked=len(touching_flows),
        kind="group",
    )
    return add_legend_keys(graph)


def _draw_member(lookup: Lookup, component: Component) -> Box:
    lines = element_boxes.type_lines(lookup, component)
    return replace(element_boxes.component_box(lookup, component, lines=lines), colour=None)


def _place_flow(flow: ComponentFlow, own_ids: set[str], *, is_folded: bool) -> tuple[ComponentFlow, str, str]:
    """Return a flow with the ids of the boxes that it joins: neighbours are at the left where they feed, at the right
    where they read.
    """
    tail = flow.tail if flow.tail in own_ids else _neighbour_id(flow.tail, "<", is_folded=is_folded)
    head = flow.head if flow.head in own_ids else _neighbour_id(flow.head, ">", is_folded=is_folded)
    return flow, tail, head


def _neighbour_id(component: str, side: str, *, is_folded: bool) -> str:
    return side + (component.split(".", 1)[0] if is_folded else component)


def _draw_neighbours(
    lookup: Lookup, placed_flows: Sequence[tuple[ComponentFlow, str, str]], own_ids: set[str], *, is_folded: bool
) -> Iterable[Box]:
    names = dict.fromkeys(end for _, tail, head in placed_flows for end in (tail, head) if end not in own_ids)
    for box_id in names:
        side: Literal["left", "right"] = "left" if box_id[0] == "<" else "right"
        if is_folded:
            members = {flow.tail if side == "left" else flow.head for flow, *ends in placed_flows if box_id in ends}
            titles = [c.title for c in DrawnLevel(lookup).list_boxes() if c.id in members]
            yield replace(
                element_boxes.group_box(lookup, box_id[1:]),
                id=box_id,
                emphasis="neighbour",
                side=side,
                lines=tuple(fit_lines(titles, _MAX_TITLES)),
            )
        else:
            component = find_component(lookup.architecture, box_id[1:])
            yield replace(element_boxes.neighbour_box(lookup, component, side), id=box_id)


def _label_arrow(lookup: Lookup, arrow: Arrow, own_ids: set[str], group_id: str, *, is_folded: bool) -> Arrow:
    inside = arrow.tail in own_ids and arrow.head in own_ids
    label = str(arrow.count) if is_folded and arrow.count > 1 else arrow.label
    return replace(arrow, label=label, colour=element_boxes.group_hue(lookup, group_id) if inside else None)


def _describe_group(lookup: Lookup, group_id: str, touching_flows: Sequence[ComponentFlow], own_ids: set[str]) -> str:
    group = lookup.architecture.groups[group_id]
    titles = {key: each.title for key, each in lookup.architecture.groups.items()}
    feeders = _group_titles(titles, [flow.tail for flow in touching_flows if flow.tail not in own_ids])
    readers = _group_titles(titles, [flow.head for flow in touching_flows if flow.head not in own_ids])
    inside = sum(flow.tail in own_ids and flow.head in own_ids for flow in touching_flows)
    sentences = [
        f"{group.title} with {count_noun(len(own_ids), 'component')} and {count_noun(inside, 'flow')} among them."
    ]
    sentences += [f"It is fed by {', '.join(feeders)}."] if feeders else []
    sentences += [f"It is read by {', '.join(readers)}."] if readers else []
    return " ".join(sentences)


def _group_titles(titles: dict[str, str], components: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(titles[each.split(".", 1)[0]] for each in components))


def draw_overview(lookup: Lookup, direction: Direction | None = None) -> Graph:
    """Draw the groups with a square for each component in the hue of its partner; flows are counted by their ends.

    With a direction it is the picture for paper and narrow screens (`top-bottom`), with an id of its own.
    """
    architecture = lookup.architecture
    between = _flows_between_groups(lookup)
    arrows = merge_flows(between, _groups_of_flow, labels=False, by_style=False)
    hues = choose_partner_hues(lookup)
    graph = Graph(
        f"overview{UPRIGHT if direction else ''}",
        f"{architecture.project.title}: groups",
        "overview",
        tuple(_draw_closed_group(lookup, group, hues) for group in architecture.groups),
        arrows,
        direction=direction or architecture.layout.direction,
        legend_colours=_explain_squares(lookup, hues),
        alt=_describe_flows(lookup, f"{count_noun(len(architecture.groups), 'group')} of components", arrows),
        asked=len(between),
        kind="overview",
    )
    return add_legend_keys(graph)


_PARTNER_HUES = 9


def choose_partner_hues(lookup: Lookup) -> dict[str, int]:
    """Return the number of the colour of each partner that has one, in the order in which the project declares them.

    Who is added at the end, or owns more than before, changes nobody's colour.
    """
    return {partner: at + 1 for at, partner in enumerate(list(lookup.architecture.partners)[:_PARTNER_HUES])}


def _explain_squares(lookup: Lookup, hues: Mapping[str, int]) -> tuple[tuple[int, str], ...]:
    """Return the colours of those who own components, and grey for all others together."""
    owners = {each.owners[0] if each.owners else "" for each in lookup.architecture.components.values()}
    entries = [(hue, lookup.architecture.partners[owner].title) for owner, hue in hues.items() if owner in owners]
    others = owners.difference(hues)
    return (*entries, (0, "nobody yet" if others == {""} else "others")) if others and entries else tuple(entries)


def _draw_closed_group(lookup: Lookup, group_id: str, hues: Mapping[str, int]) -> Box:
    """Return a group with a square for each of its components, by partner, the one with most first."""
    box = element_boxes.group_box(lookup, group_id)
    architecture = lookup.architecture
    members = list(architecture.groups[group_id].components.values())
    owners = Counter(member.owners[0] if member.owners else "" for member in members)
    title = next((element_boxes.join_owner_titles(lookup, (owner,)) for owner, _ in owners.most_common() if owner), "")
    others = len(owners - Counter([""])) - 1
    words = [f"{title} and {others} more" if others > 0 else title, f"{len(members)}"]
    squares = Counter[int | None]()
    for owner, count in owners.most_common():
        squares[hues.get(owner)] += count
    return replace(box, lines=(" · ".join(filter(None, words)),), colour=None, members=tuple(squares.items()))


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


def weigh_group_flows(lookup: Lookup) -> dict[tuple[str, str], int]:
    """Count what flows from one group to another, as the overview does."""
    return dict(Counter(map(_groups_of_flow, _flows_between_groups(lookup))))


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
