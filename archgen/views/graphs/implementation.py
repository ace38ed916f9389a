"""Draw one component at the implementation level: its nodes in the middle, topics as boxes between them and others.

Publishers and clients are at the left, subscribers and servers at the right. The topic's box replaces a label at the
arrow: it never overlaps another, and it is a link. Where a component takes all topics of a neighbour, one box with an
asterisk stands for them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from archgen.model.node import Endpoint, Topic
from archgen.views.graphs import nodes
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Graph
from archgen.views.words import plural

_STARS = 3
"""From this many topics on, if all are taken, an asterisk stands for them."""
_READERS = 8
"""How many topics the asterisk's box lists."""


@dataclass(frozen=True, slots=True)
class _End:
    """One arrow between a node (its id; of a neighbour with `<` or `>`, its side, before it) and a topic."""

    node: str
    topic: str
    style: str
    to_topic: bool


def implementation(view: Index, name: str) -> Graph:
    """Draw the nodes of one component, what they publish and subscribe to, and with whom."""
    component = view.architecture.components[name]
    subjects = {node.id for node in view.nodes_of.get(name, ())}
    # A node may use a topic at several endpoints: still one arrow.
    ends = list(dict.fromkeys(_ends(view, subjects)))
    stars = _stars(view, ends)
    drawn = [replace(end, topic=stars.get(end.topic, end.topic)) for end in ends]
    arrows = tuple(_arrow(end) for end in dict.fromkeys(drawn))
    topics = {box.id: box for box in _topics(view, ends, stars, subjects)}
    around = {end.node: _neighbour(view, end.node) for end in drawn if end.node not in subjects}
    middle = tuple(nodes.node(view, view.architecture.nodes[each], subject=True) for each in sorted(subjects))
    graph = Graph(
        f"implementation/{name}",
        f"{component.title}: implementation",
        "flow",
        (*middle, *topics.values(), *around.values()),
        arrows,
        alt=_alt(component.title, sorted(subjects), [box.title for box in topics.values()]),
        asked=len(arrows),
    )
    return with_legend(graph, *(["star"] if stars else []))


def _ends(view: Index, subjects: set[str]) -> Iterator[_End]:
    used = [each for subject in sorted(subjects) for each in view.endpoints_of.get(subject, ())]
    for name in dict.fromkeys(endpoint.name for endpoint in used):
        topic = view.architecture.topics.get(name)
        if topic is not None:
            yield from _at(topic, subjects)


def _at(topic: Topic, subjects: set[str]) -> Iterator[_End]:
    """Yield the arrows at a topic: into it from publishers and clients, out of it to subscribers and servers."""
    into, out = (topic.writers, topic.readers) if topic.flow == "topic" else (topic.readers, topic.writers)
    mine_into = [each for each in into if each.node in subjects]
    mine_out = [each for each in out if each.node in subjects]
    # Others that write are drawn only where the component reads, and the reverse: co-publishers are not its neighbours.
    for endpoint in into if mine_out else mine_into:
        yield _End(_place(endpoint, subjects, "<"), topic.name, _style(endpoint), to_topic=True)
    for endpoint in out if mine_into else mine_out:
        yield _End(_place(endpoint, subjects, ">"), topic.name, _style(endpoint), to_topic=False)


def _place(endpoint: Endpoint, subjects: set[str], side: str) -> str:
    return endpoint.node if endpoint.node in subjects else side + endpoint.node


def _style(endpoint: Endpoint) -> str:
    if endpoint.flow != "topic":
        return endpoint.flow
    return "internal" if endpoint.internal else "data"


def _stars(view: Index, ends: list[_End]) -> dict[str, str]:
    """Find the neighbours all of whose topics go to the same nodes. Map each such topic to its common name."""
    found: dict[str, str] = {}
    for neighbour in dict.fromkeys(end.node for end in ends if end.node[0] == "<" and end.style == "data"):
        node = neighbour[1:]
        published = {e.name for e in view.endpoints_of.get(node, ()) if e.use == "publishes" and not e.internal}
        taken = {end.topic for end in ends if end.node == neighbour and end.style == "data"}
        users = {name: {end.node for end in ends if end.topic == name} for name in taken}
        alone = all(user == next(iter(users.values())) for user in users.values())
        # All of the neighbour's topics, and each used by the same nodes: else the asterisk would show flows that are
        # not there.
        if len(published) >= _STARS and published == taken and alone:
            found.update(dict.fromkeys(sorted(taken), f"* {node}"))
    return found


def _topics(view: Index, ends: list[_End], stars: dict[str, str], subjects: set[str]) -> Iterator[Box]:
    for name in dict.fromkeys(end.topic for end in ends):
        topic = view.architecture.topics[name]
        if name not in stars:
            mine = [each for each in (*topic.writers, *topic.readers) if each.node in subjects]
            yield replace(nodes.topic(topic, mine), id=f"topic {name}")
    for star in dict.fromkeys(stars.values()):
        names = [name for name, stands in stars.items() if stands == star]
        shown = names if len(names) <= _READERS else [*names[: _READERS - 1], f"and {len(names) - _READERS + 1} more"]
        yield Box(
            f"topic {star}",
            f"* all topics of {star[2:]}",
            tuple(shown),
            style="topic",
            ref=f"node:{star[2:]}",
            tooltip="\n".join(names),
        )


def _neighbour(view: Index, name: str) -> Box:
    return nodes.neighbour(view, view.architecture.nodes[name[1:]], "left" if name[0] == "<" else "right")


def _arrow(end: _End) -> Arrow:
    box = f"topic {end.topic}"
    tail, head = (end.node, box) if end.to_topic else (box, end.node)
    said = f"{end.node.lstrip('<>')} {'to' if end.to_topic else 'from'} {end.topic}"
    return Arrow(f"{tail}>{head}", tail, head, style=end.style, flows=(said,))  # type: ignore[arg-type]


def _alt(title: str, subjects: list[str], topics: list[str]) -> str:
    said = f"{title} is implemented by {', '.join(subjects)}." if subjects else f"No node implements {title}."
    return (
        f"{said} It uses {plural(len(topics), 'topic, service or action')[2:] if len(topics) == 1 else len(topics)}"
        + (f": {', '.join(topics)}." if topics else " topics.")
    )
