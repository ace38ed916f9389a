"""Which components (or nodes) data reaches from which: adjacency, and what lies before and after."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Connection
from archgen.model.mapping import flow_of


@dataclass(frozen=True, slots=True)
class Graph:
    """Who feeds whom, by complete id, in order of appearance. Nobody feeds itself."""

    after: Mapping[str, tuple[str, ...]]
    before: Mapping[str, tuple[str, ...]]


def components(architecture: Architecture) -> Graph:
    """Join components. Services and actions carry data both ways; a stub whose outputs are not known yet feeds its readers."""
    return _graph(_component_pairs(architecture))


def nodes(architecture: Architecture) -> Graph:
    """Join nodes by the topics, services and actions that they use; the last two carry data both ways."""
    return _graph(_node_pairs(architecture))


def reach(neighbours: Mapping[str, Collection[str]], starts: Iterable[str], steps: int | None = None) -> dict[str, int]:
    """Give all that is reached from some elements, themselves included, each with its number of steps (at most `steps`)."""
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
        if edge.output in both_ways:
            yield reader, server
    for connection in architecture.connections:
        if not connection.outputs:
            reader = architecture.inputs[connection.input].component
            for component in _stubs(architecture, connection):
                yield component, reader


def _stubs(architecture: Architecture, connection: Connection) -> Iterator[str]:
    """Name the components that a reference takes whole, and whose outputs nobody has written yet."""
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
                # What all nodes share would join all of them: there only what an input names counts.
                if topic.shared and writer.port not in reader.sources:
                    continue
                yield writer.node, reader.node
                if topic.flow != "topic":
                    yield reader.node, writer.node
