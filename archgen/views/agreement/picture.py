"""The picture of an agreement: the second partner's components in a frame, the first one's on both sides of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from archgen.views.agreement.interfaces import Interface, components
from archgen.views.agreement.terms import partners, title
from archgen.views.graphs import boxes, nodes
from archgen.views.graphs.flows import Style
from archgen.views.graphs.folding import fold
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Cluster, Graph
from archgen.views.words import plural

Side = Literal["left", "right"]
_HUES = (1, 4)
"""Hue numbers of both partners; every box also names its partner or is in the frame that does."""
_NAMED = 3


@dataclass(frozen=True, slots=True)
class _Flow:
    """One interface between two boxes, as drawn: a service or action runs from its client to its server."""

    interface: Interface
    tail: str
    head: str
    sentence: str


def picture(view: Index, name: str, pair: tuple[str, str], interfaces: Sequence[Interface]) -> Graph:
    """Draw what flows between two partners, and nothing else."""
    first, second = pair
    placed = [_placed(flow, first) for each in interfaces for flow in _flows(view, each)]
    known = {end: _box(view, end, pair) for _, tail, head in placed for end in (tail, head)}
    titles = partners(view, [first]), partners(view, [second])
    graph = Graph(
        name,
        f"What flows between {titles[0]} and {titles[1]}",
        "group",
        tuple(known.values()),
        tuple(_arrows(placed)),
        (Cluster(second, titles[1], colour=_HUES[1]),),
        direction="left-right",
        legend_colours=tuple(zip(_HUES, titles, strict=True)),
        alt=_alt(view, pair, interfaces),
        asked=len(placed),
    )
    return fold(with_legend(graph))


def _flows(view: Index, interface: Interface) -> Iterator[_Flow]:
    giving, taking = components(view, interface)
    givers = [each.id for each in giving] or [f"node {end.node}" for end in interface.givers[:1]]
    takers = [each.id for each in taking] or [f"node {end.node}" for end in interface.takers[:1]]
    calls = interface.flow in {"service", "action"}
    for giver in givers:
        for taker in takers:
            tail, head = (taker, giver) if calls else (giver, taker)
            yield _Flow(interface, tail, head, title(view, interface))


def _placed(flow: _Flow, first: str) -> tuple[_Flow, str, str]:
    """Return a flow with its boxes: the first partner's on the left where it begins, on the right where it ends."""
    calls = flow.interface.flow in {"service", "action"}
    begins = (flow.interface.pair[0] == first) is not calls
    # "<" and ">" in a box's id put the first partner's component on the left, the right, or both: `_draw_box` reads
    # them.
    return (flow, f"<{flow.tail}", flow.head) if begins else (flow, flow.tail, f">{flow.head}")


def _box(view: Index, end: str, pair: tuple[str, str]) -> Box:
    side: Side | None = {"<": "left", ">": "right"}.get(end[0])  # type: ignore[assignment]
    name = end.removeprefix("<").removeprefix(">")
    whose = 0 if side else 1
    cluster = None if side else pair[1]
    if name.startswith("node "):
        found = nodes.node(view, view.architecture.nodes[name.removeprefix("node ")])
    else:
        item = view.architecture.components[name]
        lines = (partners(view, item.owners),) if side else (view.architecture.groups[item.group].title,)
        found = boxes.component(view, item, lines=lines)
    return replace(found, id=end, colour=_HUES[whose], cluster=cluster, side=side)


def _arrows(placed: Sequence[tuple[_Flow, str, str]]) -> Iterator[Arrow]:
    """Yield one arrow for all flows between two boxes in one direction."""
    bundles: dict[tuple[str, str, Style], list[_Flow]] = {}
    for flow, tail, head in placed:
        kind = flow.interface.flow
        style: Style = "data" if kind == "topic" else kind
        bundles.setdefault((tail, head, style), []).append(flow)
    for (tail, head, style), flows in bundles.items():
        names = list(dict.fromkeys(flow.interface.type or flow.interface.key for flow in flows))
        shown = names if len(names) <= _NAMED else [*names[: _NAMED - 1], f"and {len(names) - _NAMED + 1} more types"]
        sentences = tuple(flow.sentence for flow in flows)
        yield Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            "\n".join(shown),
            style=style,
            count=len(flows),
            flows=sentences,
            ref=flows[0].interface.anchor if len(flows) == 1 else None,
        )


def _alt(view: Index, pair: tuple[str, str], interfaces: Sequence[Interface]) -> str:
    said = []
    for giver, taker in (pair, pair[::-1]):
        mine = [title(view, each) for each in interfaces if each.pair[0] == giver]
        if mine:
            names = f"{partners(view, [giver])} to {partners(view, [taker])}"
            said.append(f"{plural(len(mine), 'interface')} from {names}: {', '.join(mine)}.")
    return " ".join(said)
