"""The flow of data between components or between nodes, as adjacency: what each element feeds, and what feeds it."""

from __future__ import annotations

import functools
import operator
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Connection
from archgen.model.graph_search import find_reach_masks, find_reachable


@dataclass(frozen=True, slots=True)
class FlowGraph:
    """The successors and predecessors of each element, by complete id, in order of appearance, without self-loops."""

    successors: Mapping[str, tuple[str, ...]]
    predecessors: Mapping[str, tuple[str, ...]]


def build_component_graph(architecture: Architecture) -> FlowGraph:
    """Build the graph of components.

    Services and actions carry data both ways. A component whose outputs are not known yet feeds its readers.
    """
    return _build_graph(_component_flow_pairs(architecture))


def build_node_graph(architecture: Architecture) -> FlowGraph:
    """Build the graph of nodes from the topics, services and actions they use; the last two carry data both ways."""
    return _build_graph(_node_flow_pairs(architecture))


class ComponentReach:
    """Whom components feed in the end. Nothing is computed before somebody asks."""

    def __init__(self, architecture: Architecture) -> None:
        """Compute nothing yet."""
        self._architecture = architecture

    @cached_property
    def _flows(self) -> FlowGraph:
        return build_component_graph(self._architecture)

    @cached_property
    def _masks(self) -> Mapping[str, int]:
        return find_reach_masks(self._flows.successors)

    def find_fed(self, component_ids: Collection[str], enough: int | None = None) -> dict[str, int]:
        """Return the other components that some feed in the end, nearest first, each with its number of steps.

        No more than up to the step with which they are `enough`; None is all of them.
        """
        wanted = None if enough is None else enough + len(component_ids)
        steps = find_reachable(self._flows.successors, component_ids, enough=wanted)
        return {name: count for name, count in steps.items() if count}

    def count_fed(self, component_ids: Collection[str]) -> int:
        """Return how many other components some feed in the end."""
        masks = [self._masks[name] for name in component_ids if name in self._masks]
        return functools.reduce(operator.or_, masks, 0).bit_count() - len(masks)


def _build_graph(pairs: Iterable[tuple[str, str]]) -> FlowGraph:
    # Dictionaries as ordered sets: the result must not depend on hashing.
    successors: dict[str, dict[str, None]] = defaultdict(dict)
    predecessors: dict[str, dict[str, None]] = defaultdict(dict)
    for source, target in pairs:
        if source != target:
            successors[source][target] = None
            predecessors[target][source] = None
    return FlowGraph(
        {element: tuple(neighbours) for element, neighbours in successors.items()},
        {element: tuple(neighbours) for element, neighbours in predecessors.items()},
    )


def _component_flow_pairs(architecture: Architecture) -> Iterator[tuple[str, str]]:
    both_ways = {o.id for o in architecture.outputs.values() if architecture.flow_of(o) != "topic"}
    for edge in architecture.edges:
        writer = architecture.outputs[edge.output].component
        reader = architecture.inputs[edge.input].component
        yield writer, reader
        # A request flows to the server, the answer back.
        if edge.output in both_ways:
            yield reader, writer
    for connection in architecture.connections:
        # A connection without outputs makes no edge: a stub is joined by what refers to it.
        if not connection.outputs:
            reader = architecture.inputs[connection.input].component
            for component in _stub_components(architecture, connection):
                yield component, reader


def _stub_components(architecture: Architecture, connection: Connection) -> Iterator[str]:
    """Yield the components that a reference takes as a whole and whose outputs are not known yet."""
    if connection.kind == "group":
        members = tuple(architecture.groups[connection.target].components.values())
    elif connection.kind == "component":
        members = (architecture.components[connection.target],)
    else:
        members = ()
    return (component.id for component in members if not component.outputs_known)


def _node_flow_pairs(architecture: Architecture) -> Iterator[tuple[str, str]]:
    for topic in (*architecture.topics.values(), *architecture.channels.values()):
        for reader in topic.readers:
            for writer in topic.writers:
                # A shared topic such as /tf would connect every node to every other one: there only the outputs count
                # that the reader's input names. timing/arcs has the same rule for its arcs.
                if topic.shared and writer.port not in reader.sources:
                    continue
                yield writer.node, reader.node
                if topic.flow != "topic":
                    yield reader.node, writer.node
