"""Draw one group: its components in the middle, grey neighbours at the left where they feed it, at the right where they
read.

A neighbour that does both is at both sides, so that nothing runs backwards. Above `MAX_FLOWS` flows the neighbours are
folded, a box for each of their groups.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Literal

from archgen.views.graphs import boxes
from archgen.views.graphs.flows import Flow, flows_at, merged
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Graph
from archgen.views.words import plural

MANY = 45
"""With more flows the neighbours are folded by group."""


def group(view: Index, name: str) -> Graph:
    """Draw one group with its neighbours."""
    found = view.architecture.groups[name]
    mine = {component.id for component in found.components.values()}
    touching = flows_at(view.architecture, mine)
    fold = len(touching) > MANY
    placed = [_placed(flow, mine, fold=fold) for flow in touching]
    around = _neighbours(view, placed, mine, fold=fold)
    # By identity: hashing a flow would hash its connection with all that it holds.
    ends = {id(flow): (tail, head) for flow, tail, head in placed}
    arrows = merged(touching, lambda flow: ends[id(flow)], labels=not fold)
    arrows = tuple(_counted(view, arrow, mine, name, fold=fold) for arrow in arrows)
    graph = Graph(
        f"groups/{name}",
        found.title,
        "group",
        # Without a hue: all of them are in the same group, and its frame has it.
        (*(replace(boxes.component(view, each), colour=None) for each in found.components.values()), *around),
        arrows,
        (boxes.frame(view, name),),
        direction=found.layout.direction or view.architecture.layout.direction or "left-right",
        notes=("Neighbours are folded: a box for each group, with the number of flows.",) if fold else (),
        alt=_alt(view, name, touching, mine),
        asked=len(touching),
    )
    return with_legend(graph)


def _placed(flow: Flow, mine: set[str], *, fold: bool) -> tuple[Flow, str, str]:
    """Return a flow with the ids of the boxes that it joins: neighbours are at the left where they feed, at the right
    where they read.
    """
    tail = flow.tail if flow.tail in mine else _outer(flow.tail, "<", fold=fold)
    head = flow.head if flow.head in mine else _outer(flow.head, ">", fold=fold)
    return flow, tail, head


def _outer(component: str, side: str, *, fold: bool) -> str:
    return side + (component.split(".", 1)[0] if fold else component)


def _neighbours(view: Index, placed: Sequence[tuple[Flow, str, str]], mine: set[str], *, fold: bool) -> Iterable[Box]:
    names = dict.fromkeys(end for _, tail, head in placed for end in (tail, head) if end not in mine)
    for name in names:
        side: Literal["left", "right"] = "left" if name[0] == "<" else "right"
        if fold:
            members = {flow.tail if side == "left" else flow.head for flow, *ends in placed if name in ends}
            titles = [c.title for c in view.architecture.components.values() if c.id in members]
            yield replace(
                boxes.whole_group(view, name[1:]), id=name, emphasis="neighbour", side=side, lines=_listed(titles)
            )
        else:
            component = view.architecture.components[name[1:]]
            yield replace(boxes.neighbour(view, component, side), id=name)


def _listed(titles: Sequence[str]) -> tuple[str, ...]:
    """Shorten the list of components that a folded group stands for; the tooltip of the group has them all."""
    return tuple(titles) if len(titles) <= 6 else (*titles[:5], f"and {len(titles) - 5} more")  # noqa: PLR2004


def _counted(view: Index, arrow: Arrow, mine: set[str], name: str, *, fold: bool) -> Arrow:
    inside = arrow.tail in mine and arrow.head in mine
    label = str(arrow.count) if fold and arrow.count > 1 else arrow.label
    return replace(arrow, label=label, colour=boxes.hue(view, name) if inside else None)


def _alt(view: Index, name: str, touching: Sequence[Flow], mine: set[str]) -> str:
    found = view.architecture.groups[name]
    titles = {key: each.title for key, each in view.architecture.groups.items()}
    feeders = _groups(titles, [flow.tail for flow in touching if flow.tail not in mine])
    readers = _groups(titles, [flow.head for flow in touching if flow.head not in mine])
    inside = sum(flow.tail in mine and flow.head in mine for flow in touching)
    said = [f"{found.title} with {plural(len(mine), 'component')} and {plural(inside, 'flow')} among them."]
    said += [f"It is fed by {', '.join(feeders)}."] if feeders else []
    said += [f"It is read by {', '.join(readers)}."] if readers else []
    return " ".join(said)


def _groups(titles: dict[str, str], components: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(titles[each.split(".", 1)[0]] for each in components))
