"""The flow of data between components or between nodes: adjacency, and what is upstream and downstream of an element.

Plain dictionaries and a breadth-first search instead of networkx, whose import takes 116 ms, a third of what a whole
`archgen check` may take (docs/decisions/0001-no-networkx.md).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Connection
from archgen.model.mapping import flow_of


@dataclass(frozen=True, slots=True)
class Graph:
    """The successors and predecessors of each element, by complete id, in order of appearance, without self-loops."""

    after: Mapping[str, tuple[str, ...]]
    before: Mapping[str, tuple[str, ...]]


def components(architecture: Architecture) -> Graph:
    """Build the graph of components.

    Services and actions carry data both ways. A component whose outputs are not known yet feeds its readers.
    """
    return _graph(_component_pairs(architecture))


def nodes(architecture: Architecture) -> Graph:
    """Build the graph of nodes from the topics, services and actions they use; the last two carry data both ways."""
    return _graph(_node_pairs(architecture))


def reach(neighbours: Mapping[str, Collection[str]], starts: Iterable[str], steps: int | None = None) -> dict[str, int]:
    """Return all elements that can be reached, the starts included, each with its least number of steps.

    `steps` limits the number of steps; None is no limit.
    """
    found = dict.fromkeys(starts, 0)
    edge, distance = list(found), 0
    while edge and (steps is None or distance < steps):
        distance += 1
        fresh: list[str] = []
        for element in edge:
            for neighbour in neighbours.get(element, ()):
                if neighbour not in found:
                    found[neighbour] = distance
                    fresh.append(neighbour)
        edge = fresh
    return found


def _graph(pairs: Iterable[tuple[str, str]]) -> Graph:
    # Dictionaries as ordered sets: the result must not depend on hashing.
    after: dict[str, dict[str, None]] = defaultdict(dict)
    before: dict[str, dict[str, None]] = defaultdict(dict)
    for source, target in pairs:
        if source != target:
            after[source][target] = None
            before[target][source] = None
    return Graph(
        {element: tuple(others) for element, others in after.items()},
        {element: tuple(others) for element, others in before.items()},
    )


def _component_pairs(architecture: Architecture) -> Iterator[tuple[str, str]]:
    both_ways = {o.id for o in architecture.outputs.values() if flow_of(architecture.message(o)) != "topic"}
    for edge in architecture.edges:
        server = architecture.outputs[edge.output].component
        reader = architecture.inputs[edge.input].component
        yield server, reader
        # A request flows to the server, the answer back.
        if edge.output in both_ways:
            yield reader, server
    for connection in architecture.connections:
        # A connection without outputs makes no edge: a stub is joined by what refers to it.
        if not connection.outputs:
            reader = architecture.inputs[connection.input].component
            for component in _stubs(architecture, connection):
                yield component, reader


def _stubs(architecture: Architecture, connection: Connection) -> Iterator[str]:
    """Yield the components that a reference takes as a whole and whose outputs are not known yet."""
    if connection.kind == "group":
        members = tuple(architecture.groups[connection.target].components.values())
    elif connection.kind == "component":
        members = (architecture.components[connection.target],)
    else:
        members = ()
    return (component.id for component in members if not component.outputs_known)


def _node_pairs(architecture: Architecture) -> Iterator[tuple[str, str]]:
    for topic in architecture.topics.values():
        for reader in topic.readers:
            for writer in topic.writers:
                # A shared topic such as /tf would connect every node to every other one: there only the outputs count
                # that the reader's input names. timing/arcs has the same rule for its arcs.
                if topic.shared and writer.port not in reader.sources:
                    continue
                yield writer.node, reader.node
                if topic.flow != "topic":
                    yield reader.node, writer.node
