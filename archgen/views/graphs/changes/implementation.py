"""The picture of changed nodes: what they publish, subscribe, serve and call, with topics as boxes in between."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace

from archgen.compare import Change, Comparison
from archgen.compare.names import Names
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Topic
from archgen.views.changes.telling import SIGNS, textual
from archgen.views.graphs import nodes
from archgen.views.graphs.changes.budget import Budget
from archgen.views.graphs.changes.folded import fits
from archgen.views.graphs.changes.lines import Line, arrows
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index, index
from archgen.views.shapes import Box, Changed, Graph

NAME = "changes/nodes"
Key = tuple[str, str, str]
"""A node, a topic, and how the node uses it."""


@dataclass(frozen=True, slots=True)
class _Both:
    """The two versions of the nodes, by common ids."""

    before: Index
    after: Index
    names: Names
    kinds: dict[str, Changed]
    said: defaultdict[str, list[str]]
    lines: tuple[Line, ...]

    @property
    def topics(self) -> dict[str, Topic]:
        """Return all topics of both versions, the later one where both have it."""
        return {**self.before.architecture.topics, **self.after.architecture.topics}


def implementation(found: Comparison, budget: Budget) -> Graph | None:
    """Draw what changed and its surroundings; None if no node changed, or if it does not fit the budget."""
    kinds, said, ports = _happened(found)
    if not kinds:
        return None
    lines = tuple(_lines(found, ports))
    both = _Both(
        index(found.before.architecture), index(found.after.architecture, found.new), found.names, kinds, said, lines
    )
    drawn = _drawn(both, budget)
    ends = {end for line in drawn for end in line.ends} | {f"node {name}" for name in kinds}
    graph = Graph(
        NAME,
        "What changed: nodes and topics",
        "flow",
        tuple(_box(both, end) for end in sorted(ends)),
        arrows(drawn),
        direction=found.after.architecture.layout.direction or "left-right",
        notes=("Only what changed is drawn.",) if len(drawn) < len(_around(both)) else (),
        alt="; ".join(f"{SIGNS[kind]} {name}" for name, kind in sorted(kinds.items())) + ".",
    )
    # Nodes have no groups to fold.
    if not fits(graph, budget):
        return None
    return with_legend(replace(graph, asked=sum(arrow.count for arrow in graph.arrows)))


def _around(both: _Both) -> list[Line]:
    """Return what the changed nodes use, and who else uses what changed of it."""
    subjects = {f"node {name}" for name in both.kinds}
    touched = {end for line in both.lines if line.change for end in line.ends if end.startswith("topic ")}
    return [line for line in both.lines if not subjects.isdisjoint(line.ends) or not touched.isdisjoint(line.ends)]


def _drawn(both: _Both, budget: Budget) -> list[Line]:
    around = _around(both)
    boxes = {end for line in around for end in line.ends}
    return around if len(boxes) <= budget.around else [line for line in around if line.change]


def _happened(found: Comparison) -> tuple[dict[str, Changed], defaultdict[str, list[str]], dict[Key, list[str]]]:
    """Sort the changes of nodes: their kinds and sentences by node, and the sentences by node, use and port."""
    kinds: dict[str, Changed] = {}
    said: defaultdict[str, list[str]] = defaultdict(list)
    ports: defaultdict[Key, list[str]] = defaultdict(list)
    for change in _all(found.changes):
        if textual(change) or change.sort not in {"node", "port"}:
            continue
        name = found.names.to("node", change.element) if change.kind == "removed" else change.element
        node = name if change.sort == "node" else name.partition(".")[0]
        said[node].append(change.text)
        kind: Changed = "renamed" if change.kind == "moved" else change.kind
        if change.sort == "node" and kind != "changed":
            kinds[node] = kind
        kinds.setdefault(node, "changed")
        if change.sort == "port":
            use, _, port = name.partition(".")[2].removeprefix("internal.").partition(".")
            ports[node, use, port].append(change.text)
    return kinds, said, ports


def _all(changes: tuple[Change, ...]) -> Iterator[Change]:
    for change in changes:
        yield change
        # Ports that hang on a component belong to the picture of components.
        if change.sort not in {"component", "group", "input", "output"}:
            yield from _all(change.parts)


def _ends(found: Architecture, names: Names) -> dict[Key, Endpoint]:
    return {(names.to("node", each.node), each.name, each.use): each for each in found.endpoints}


def _lines(found: Comparison, ports: dict[Key, list[str]]) -> Iterator[Line]:
    """Yield each use of a topic in either version with its change."""
    old, new = _ends(found.before.architecture, found.names), _ends(found.after.architecture, Names())
    for key in (*new, *(key for key in old if key not in new)):
        end = new.get(key) or old[key]
        said = tuple(_about(key, end, ports))
        kind: Changed | None = "changed" if said else None
        if (key in new) != (key in old):
            kind = "added" if key in new else "removed"
        yield _line(key, end, kind, said)


def _about(key: Key, end: Endpoint, ports: dict[Key, list[str]]) -> Iterator[str]:
    node, topic, use = key
    # A use is named by its port, by component and port if the node has several components, or by its internal key.
    names = {
        (end.port or topic).rpartition(".")[2],
        ".".join((end.port or "").split(".")[-2:]),
        topic.rpartition("/")[2],
    }
    for (owner, how, port), said in ports.items():
        if (owner, how) == (node, use) and port in names:
            yield from said


def _line(key: Key, end: Endpoint, kind: Changed | None, said: tuple[str, ...]) -> Line:
    node, topic, use = key
    tail, head = f"node {node}", f"topic {topic}"
    if use in {"subscribes", "serves"}:
        tail, head = head, tail
    plain = f"{node} {use} {topic}"
    style = "data" if end.flow == "topic" else end.flow
    sentence = "\n".join((f"{SIGNS[kind]} {plain}" if kind else plain, *said))
    return Line(tail, head, style, use if kind else "", kind, sentence)


def _box(both: _Both, end: str) -> Box:
    sort, _, name = end.partition(" ")
    return _topic(both, name) if sort == "topic" else _node(both, name)


def _node(both: _Both, name: str) -> Box:
    item = both.after.architecture.nodes.get(name)
    view = both.after if item else both.before
    if item is None:
        item = both.before.architecture.nodes[both.names.back.get("node", {}).get(name, name)]
    drawn = nodes.node(view, item)
    common = replace(drawn, id=f"node {name}", status=None, ref="changes:Nodes")
    kind = both.kinds.get(name) or _planned(both, name)
    if kind is None:
        return replace(common, emphasis="neighbour", badge=None)
    tooltip = "\n".join((*both.said.get(name, ()), drawn.tooltip))
    return replace(common, title=f"{SIGNS[kind]} {drawn.title}", change=kind, tooltip=tooltip)


def _planned(both: _Both, name: str) -> Changed | None:
    """Return whether a node that nobody wrote was added or removed with its component, None for neither."""
    was = both.names.back.get("node", {}).get(name, name)
    old, new = was in both.before.architecture.nodes, name in both.after.architecture.nodes
    return None if old and new else "added" if new else "removed"


def _topic(both: _Both, name: str) -> Box:
    old, new = both.before.architecture.topics.get(name), both.after.architecture.topics.get(name)
    drawn = replace(nodes.topic(both.topics[name]), id=f"topic {name}", ref=None)
    kind: Changed | None = "added" if old is None else "removed" if new is None else None
    if old and new and old.messages != new.messages:
        kind = "changed"
    return replace(drawn, title=f"{SIGNS[kind]} {name}", change=kind) if kind else drawn
