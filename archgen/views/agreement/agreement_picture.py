"""The picture of an agreement: the second partner's components in a frame, the first one's on both sides of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from archgen.frozen import dataclass, replace
from archgen.model.partner_interfaces import PartnerInterface, components_at_ends
from archgen.views.agreement.interface_terms import interface_title
from archgen.views.elements import element_names
from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph
from archgen.views.graphs import element_boxes, node_boxes
from archgen.views.graphs.component_flows import FlowStyle
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.graphs.legend_keys import add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup

PictureSide = Literal["left", "right"]
_PARTNER_HUES = (1, 4)
"""Hue numbers of both partners; every box also names its partner or is in the frame that does."""
_MAX_LABELS = 3


@dataclass(frozen=True, slots=True)
class _DrawnFlow:
    """One interface between two boxes, as drawn: a service or action runs from its client to its server."""

    interface: PartnerInterface
    tail: str
    head: str
    sentence: str


def draw_agreement(lookup: Lookup, name: str, pair: tuple[str, str], interfaces: Sequence[PartnerInterface]) -> Graph:
    """Draw what flows between two partners, and nothing else."""
    first, second = pair
    placed_flows = [_place_flow(flow, first) for interface in interfaces for flow in _list_flows(lookup, interface)]
    boxes_by_end = {
        box_id: _draw_box(lookup, box_id, pair) for _, tail, head in placed_flows for box_id in (tail, head)
    }
    titles = join_owner_titles(lookup, [first]), join_owner_titles(lookup, [second])
    graph = Graph(
        name,
        f"What flows between {titles[0]} and {titles[1]}",
        "group",
        tuple(boxes_by_end.values()),
        tuple(_draw_arrows(placed_flows)),
        (Cluster(second, titles[1], colour=_PARTNER_HUES[1]),),
        direction="left-right",
        legend_colours=tuple(zip(_PARTNER_HUES, titles, strict=True)),
        alt=_alternative_text(lookup, pair, interfaces),
        asked=len(placed_flows),
        kind="agreement",
    )
    return fold_graph(add_legend_keys(graph))


def _list_flows(lookup: Lookup, interface: PartnerInterface) -> Iterator[_DrawnFlow]:
    giving_components, taking_components = components_at_ends(lookup.architecture, interface)
    tail_ids = [component.id for component in giving_components] or [
        f"node {endpoint.node}" for endpoint in interface.giver_endpoints[:1]
    ]
    head_ids = [component.id for component in taking_components] or [
        f"node {endpoint.node}" for endpoint in interface.taker_endpoints[:1]
    ]
    calls = interface.flow in {"service", "action"}
    for giver_id in tail_ids:
        for taker_id in head_ids:
            tail, head = (taker_id, giver_id) if calls else (giver_id, taker_id)
            yield _DrawnFlow(interface, tail, head, interface_title(lookup, interface))


def _place_flow(flow: _DrawnFlow, first: str) -> tuple[_DrawnFlow, str, str]:
    """Return a flow with its boxes: the first partner's on the left where it begins, on the right where it ends."""
    calls = flow.interface.flow in {"service", "action"}
    begins = (flow.interface.pair[0] == first) is not calls
    # "<" and ">" in a box's id put the first partner's component on the left, the right, or both: `_draw_box` reads
    # them.
    return (flow, f"<{flow.tail}", flow.head) if begins else (flow, flow.tail, f">{flow.head}")


def _draw_box(lookup: Lookup, box_id: str, pair: tuple[str, str]) -> Box:
    side: PictureSide | None = {"<": "left", ">": "right"}.get(box_id[0])  # type: ignore[assignment]
    element_id = box_id.removeprefix("<").removeprefix(">")
    partner_index = 0 if side else 1
    cluster = None if side else pair[1]
    if element_id.startswith("node "):
        box = node_boxes.node_box(lookup, lookup.architecture.nodes[element_id.removeprefix("node ")])
    else:
        component = lookup.architecture.components[element_id]
        place = (
            join_owner_titles(lookup, component.owners) if side else lookup.architecture.groups[component.group].title
        )
        line = " · ".join(filter(None, (place, element_names.join_surrounding_titles(lookup, component))))
        box = element_boxes.component_box(lookup, component, lines=(line,))
    return replace(box, id=box_id, colour=_PARTNER_HUES[partner_index], cluster=cluster, side=side)


def _draw_arrows(placed_flows: Sequence[tuple[_DrawnFlow, str, str]]) -> Iterator[Arrow]:
    """Yield one arrow for all flows between two boxes in one direction."""
    bundles: dict[tuple[str, str, FlowStyle], list[_DrawnFlow]] = {}
    for flow, tail, head in placed_flows:
        kind = flow.interface.flow
        style: FlowStyle = "data" if kind == "topic" else kind
        bundles.setdefault((tail, head, style), []).append(flow)
    for (tail, head, style), flows in bundles.items():
        type_names = list(dict.fromkeys(flow.interface.type or flow.interface.key for flow in flows))
        label_lines = (
            type_names
            if len(type_names) <= _MAX_LABELS
            else [*type_names[: _MAX_LABELS - 1], f"and {len(type_names) - _MAX_LABELS + 1} more types"]
        )
        sentences = tuple(flow.sentence for flow in flows)
        yield Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            "\n".join(label_lines),
            style=style,
            count=len(flows),
            flows=sentences,
            ref=flows[0].interface.anchor if len(flows) == 1 else None,
        )


def _alternative_text(lookup: Lookup, pair: tuple[str, str], interfaces: Sequence[PartnerInterface]) -> str:
    sentences = []
    for giver, taker in (pair, pair[::-1]):
        interface_titles = [
            interface_title(lookup, interface) for interface in interfaces if interface.pair[0] == giver
        ]
        if interface_titles:
            direction_phrase = f"{join_owner_titles(lookup, [giver])} to {join_owner_titles(lookup, [taker])}"
            sentences.append(
                f"{count_noun(len(interface_titles), 'interface')} from {direction_phrase}: {', '.join(interface_titles)}."
            )
    return " ".join(sentences)
