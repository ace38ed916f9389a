"""Draw the whole: the groups, and all groups with their components (the first and the widest picture)."""

from __future__ import annotations

from dataclasses import replace

from archgen.views.graphs import boxes
from archgen.views.graphs.flows import Flow, flows, merged
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Graph
from archgen.views.words import plural


def overview(view: Index) -> Graph:
    """Draw the groups, with one arrow for all that flows from one to another."""
    architecture = view.architecture
    between = _between(view)
    arrows = _coloured(view, merged(between, _groups, labels=False, by_style=False))
    graph = Graph(
        "overview",
        f"{architecture.project.title}: groups",
        "overview",
        tuple(boxes.whole_group(view, group) for group in architecture.groups),
        arrows,
        direction=architecture.layout.direction or "left-right",
        alt=_alt(view, f"{plural(len(architecture.groups), 'group')} of components", arrows),
        asked=len(between),
    )
    return with_legend(graph)


def components(view: Index) -> Graph:
    """Draw all groups with their components: flows inside a group one by one, between groups merged and counted."""
    architecture = view.architecture
    inside = [flow for flow in flows(architecture) if _group(flow.tail) == _group(flow.head)]
    between = _between(view)
    arrows = merged(inside, lambda flow: (flow.tail, flow.head), labels=False)
    arrows += _coloured(view, merged(between, _groups, labels=False, by_style=False))
    counted = f"{plural(len(architecture.components), 'component')} in {plural(len(architecture.groups), 'group')}"
    graph = Graph(
        "components",
        f"{architecture.project.title}: all components",
        "two-step",
        tuple(boxes.component(view, component) for component in architecture.components.values()),
        arrows,
        tuple(boxes.frame(view, group) for group in architecture.groups),
        direction=architecture.layout.direction or "left-right",
        alt=_alt(view, counted, arrows),
        asked=len(inside) + len(between),
    )
    return with_legend(graph)


def _between(view: Index) -> list[Flow]:
    """Return the flows between groups. A connection to a whole group counts once."""
    found: dict[tuple[int, str], Flow] = {}
    for flow in flows(view.architecture):
        if _group(flow.tail) != _group(flow.head):
            # By identity of the connection, and by source: one connection may take from several groups.
            found.setdefault((id(flow.connection), _group(flow.tail)), flow)
    return list(found.values())


def _group(component: str) -> str:
    return component.split(".", 1)[0]


def _groups(flow: Flow) -> tuple[str, str]:
    return _group(flow.tail), _group(flow.head)


def _coloured(view: Index, arrows: tuple[Arrow, ...]) -> tuple[Arrow, ...]:
    """Colour each arrow with the hue of the group that it comes from."""
    return tuple(replace(arrow, colour=boxes.hue(view, arrow.tail)) for arrow in arrows)


def _alt(view: Index, what: str, arrows: tuple[Arrow, ...]) -> str:
    strongest = sorted((arrow for arrow in arrows if arrow.tail in view.architecture.groups), key=lambda a: -a.count)
    titles = {key: group.title for key, group in view.architecture.groups.items()}
    told = "; ".join(f"{titles[a.tail]} to {titles[a.head]} ({a.count})" for a in strongest[:5])
    return f"{what}. Most runs from {told}." if told else f"{what}. Nothing runs between groups yet."
