"""Draw a part: what a selector names, with its neighbours in grey, at either level. The project's views are such parts.

A small part is one flow with a label at each arrow. A large one has frames, and its neighbours are folded by group.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from archgen.model.architecture import View
from archgen.model.component import Component
from archgen.model.selector import Selection
from archgen.views.graphs import boxes, nodes, ros
from archgen.views.graphs.flows import Flow, flows_at, merged
from archgen.views.graphs.folding import fold
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Graph
from archgen.views.words import plural

_SMALL = (26, 45)
"""The most boxes and arrows of a small picture."""
_PER_BOX = 3


def functional(view: Index, name: str, title: str, chosen: Collection[str]) -> Graph:
    """Draw selected components and their neighbours."""
    found = [component for component in view.architecture.components.values() if component.id in chosen]
    touching = flows_at(view.architecture, chosen)
    around = dict.fromkeys(end for flow in touching for end in (flow.tail, flow.head) if end not in chosen)
    small = len(found) + len(around) <= _SMALL[0] and len(touching) <= _SMALL[1]
    graph = (_small if small else _large)(view, found, touching, list(around))
    said = f"{plural(len(found), 'component')}: {', '.join(component.title for component in found[:12])}"
    return fold(
        with_legend(
            replace(
                graph,
                id=name,
                title=title,
                direction=view.architecture.layout.direction or "left-right",
                alt=f"{said}{', ...' if len(found) > 12 else ''}. {plural(len(around), 'neighbour')} in grey.",  # noqa: PLR2004
            )
        )
    )


def _small(view: Index, found: Sequence[Component], touching: Sequence[Flow], around: Sequence[str]) -> Graph:
    architecture = view.architecture
    titles = {group.id: group.title for group in architecture.groups.values()}
    shown = [replace(boxes.component(view, each, lines=(titles[each.group],)), cluster=None) for each in found]
    grey = [boxes.neighbour(view, architecture.components[each], None) for each in around]
    arrows = merged(touching, lambda flow: (flow.tail, flow.head), labels=True)
    return Graph("", "", "flow", (*shown, *grey), arrows, asked=len(touching))


def _large(view: Index, found: Sequence[Component], touching: Sequence[Flow], around: Sequence[str]) -> Graph:
    chosen = {component.id for component in found}
    groups = dict.fromkeys(component.group for component in found)
    outside = dict.fromkeys(each.split(".", 1)[0] for each in around)

    def home(component: str) -> str:
        group = component.split(".", 1)[0]
        return group if component in chosen else f"around {group}"

    def ends(flow: Flow) -> tuple[str, str]:
        tail, head = home(flow.tail), home(flow.head)
        return (flow.tail, flow.head) if tail == head else (tail, head)

    grey = [_around(view, group, [c for c in around if c.split(".", 1)[0] == group]) for group in outside]
    inside = merged([flow for flow in touching if home(flow.tail) == home(flow.head)], ends, labels=False)
    outer = merged(
        [flow for flow in touching if home(flow.tail) != home(flow.head)], ends, labels=False, by_style=False
    )
    coloured = tuple(_hued(view, arrow) for arrow in outer)
    return Graph(
        "",
        "",
        "two-step",
        (*(boxes.component(view, each) for each in found), *grey),
        (*inside, *coloured),
        tuple(boxes.frame(view, group) for group in groups),
        asked=len(touching),
    )


def _hued(view: Index, arrow: Arrow) -> Arrow:
    return replace(arrow, colour=boxes.hue(view, arrow.tail)) if arrow.tail in view.hues else replace(arrow, faded=True)


def _around(view: Index, group: str, members: Sequence[str]) -> Box:
    """Return the neighbours in one group as one grey box."""
    titles = [view.architecture.components[each].title for each in members]
    shown = titles if len(titles) <= _PER_BOX + 1 else [*titles[:_PER_BOX], f"and {len(titles) - _PER_BOX} more"]
    whole = boxes.whole_group(view, group)
    return replace(whole, id=f"around {group}", emphasis="neighbour", lines=tuple(shown), tooltip="\n".join(titles))


def implementation(view: Index, name: str, title: str, chosen: Collection[str]) -> Graph:
    """Draw selected nodes with what runs to and from them. A small part has its topics as boxes."""
    running = [each for each in nodes.passes(view.architecture) if each.tail in chosen or each.head in chosen]
    around = dict.fromkeys(end for each in running for end in (each.tail, each.head) if end not in chosen)
    topics = dict.fromkeys(each.topic.name for each in running)
    if len(chosen) + len(around) + len(topics) > _SMALL[1]:
        return ros.between(view, name, title, chosen)
    known = view.architecture.nodes
    shown = [nodes.node(view, node, subject=False) for node in known.values() if node.id in chosen]
    grey = [replace(nodes.node(view, known[each]), emphasis="neighbour", badge=None) for each in around]
    arrows = {}
    for each in running:
        style = "data" if each.topic.flow == "topic" else each.topic.flow
        box = f"topic {each.topic.name}"
        # Several flows share a topic's box: its arrows are drawn once, with the sentence of the last flow.
        for tail, head in ((each.tail, box), (box, each.head)):
            arrow = Arrow(f"{tail}>{head}", tail, head, style=style, flows=(each.sentence,))
            arrows[arrow.id] = arrow
    graph = Graph(
        name,
        title,
        "flow",
        (*shown, *(nodes.topic(view.architecture.topics[topic]) for topic in topics), *grey),
        tuple(arrows.values()),
        direction=view.architecture.layout.direction or "left-right",
        alt=f"{plural(len(shown), 'node')} with {plural(len(topics), 'topic')} and {plural(len(grey), 'neighbour')} in grey.",
        asked=len(arrows),
    )
    return fold(with_legend(graph))


def of_view(view: Index, asked: View, chosen: Selection) -> Graph:
    """Draw one of the project's views."""
    name = f"views/{asked.id}"
    if asked.level == "implementation":
        graph = implementation(view, name, asked.title, chosen.nodes)
    else:
        graph = functional(view, name, asked.title, chosen.components)
    if asked.layout.direction:
        graph = replace(graph, direction=asked.layout.direction)
    return coloured(view, graph, asked.colour) if asked.colour and asked.colour != "group" else graph


def coloured(view: Index, graph: Graph, by: str) -> Graph:
    """Colour a graph by another criterion than the group (`owner`, `role`, ...), and say so in the legend."""
    values = {box.id: value for box in graph.boxes if (value := _value(view, box, by)) and box.emphasis != "neighbour"}
    hues = {value: at % 10 for at, value in enumerate(dict.fromkeys(values.values()))}
    painted = tuple(
        replace(box, colour=hues[values[box.id]] if box.id in values else None) if box.emphasis != "neighbour" else box
        for box in graph.boxes
    )
    # Hues of groups would be read as values of the criterion, so frames and arrows lose theirs.
    plain = tuple(replace(cluster, colour=None) for cluster in graph.clusters)
    arrows = tuple(replace(arrow, colour=None) for arrow in graph.arrows)
    legend = tuple((hue, f"{by}: {value}") for value, hue in hues.items())
    return replace(graph, boxes=painted, clusters=plain, arrows=arrows, legend_colours=legend)


def _value(view: Index, box: Box, by: str) -> str | None:
    component = view.architecture.components.get(box.id)
    node = view.architecture.nodes.get(box.id)
    item = component or node
    if item is None:
        return None
    # Functions, so that only the one that is asked for is evaluated.
    values: dict[str, Callable[[], str | None]] = {
        "owner": lambda: boxes.owners(view, item.owners) or None,
        "role": lambda: component.role if component else None,
        "status": lambda: node.status if node else _status(view, box.id),
        "host": lambda: node.host if node else None,
        "package": lambda: node.package if node else None,
        "tag": lambda: ", ".join(item.tags) or None,
    }
    return values.get(by, lambda: None)()


def _status(view: Index, component: str) -> str | None:
    found = dict.fromkeys(node.status for node in view.nodes_of.get(component, ()) if node.status)
    return ", ".join(found) or None
