"""Find the interfaces between two partners: each output of one that the other reads, with all its readers.

An end belongs to the owners of its component, and to those of the nodes that carry the port if they differ. If both
ends of a flow belong to both partners, it is theirs together and not between them. Topics that join nodes of both
without a connection (/tf, for instance) are interfaces too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.mapping import flow_of
from archgen.model.node import Endpoint, Node, Topic
from archgen.views.index import Index

Flow = Literal["topic", "service", "action", "physical"]
Pair = tuple[str, str]
"""Ids of two partners; for an interface: the giver, then the taker."""


@dataclass(frozen=True, slots=True)
class Interface:
    """What one partner gives another: an output, or (`output` is None) a topic that only their nodes share.

    `key` is the output's complete id, or the topic's name. `giver_endpoints` and `taker_endpoints` are endpoints of
    nodes, the latter only of this partner; `inputs` are the taker's ports; `other_inputs` those of everybody else.
    """

    key: str
    pair: Pair
    flow: Flow
    output: Output | None = None
    inputs: tuple[Input, ...] = ()
    others: tuple[Input, ...] = ()
    givers: tuple[Endpoint, ...] = ()
    takers: tuple[Endpoint, ...] = ()
    type: str | None = None
    message: str | None = None

    @property
    def anchor(self) -> str:
        """Return the anchor of its section; it includes the giver, since a topic may flow both ways."""
        return f"interface:{self.key}:{self.pair[0]}"

    @property
    def names(self) -> tuple[str, ...]:
        """Return the topics (services, actions) that carry it."""
        return tuple(dict.fromkeys(end.name for end in self.givers))


def between(view: Index, first: str, second: str) -> tuple[Interface, ...]:
    """Return the interfaces between two partners, those the first one gives before those of the second."""
    found = _Between(view, (first, second))
    made = [*found.of_outputs(), *found.of_topics()]
    return tuple(each for giver in (first, second) for each in made if each.pair[0] == giver)


def guests(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """Return a node's owners if somebody wrote others than those of its components."""
    inherited = {owner for component in node.implements for owner in architecture.components[component].owners}
    return node.owners if set(node.owners) != inherited else ()


@dataclass(frozen=True, slots=True)
class _Between:
    view: Index
    pair: Pair
    _ends: dict[str, list[Endpoint]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for end in self.view.architecture.endpoints:
            if end.port is not None:
                self._ends.setdefault(f"{end.use in {'publishes', 'serves'}} {end.port}", []).append(end)

    def of_outputs(self) -> Iterator[Interface]:
        """Yield an interface for each output and direction: the connections between components."""
        found = self.view.architecture
        readers: dict[tuple[str, Pair], dict[str, None]] = {}
        others: dict[str, dict[str, None]] = {}
        for edge in found.edges:
            way = self._way(found.outputs[edge.output], found.inputs[edge.input])
            if way:
                readers.setdefault((edge.output, way), {})[edge.input] = None
            else:
                others.setdefault(edge.output, {})[edge.input] = None
        order = {output: at for at, output in enumerate(found.outputs)}
        for (output, way), inputs in sorted(readers.items(), key=lambda each: order[each[0][0]]):
            yield self._interface(found.outputs[output], way, list(inputs), list(others.get(output, ())))

    def _interface(self, output: Output, way: Pair, inputs: Iterable[str], others: Iterable[str]) -> Interface:
        found = self.view.architecture
        mine = [found.inputs[each] for each in inputs]
        message = found.message(output)
        return Interface(
            output.id,
            way,
            "physical" if output.physical else flow_of(message),
            output,
            tuple(mine),
            tuple(found.inputs[each] for each in others),
            self._writing(output),
            tuple(end for port in mine for end in self._reading(port, output)),
            output.type,
            message,
        )

    def _writing(self, output: Output) -> tuple[Endpoint, ...]:
        return tuple(self._ends.get(f"True {output.id}", ()))

    def _reading(self, port: Input, output: Output) -> tuple[Endpoint, ...]:
        return tuple(end for end in self._ends.get(f"False {port.id}", ()) if output.id in end.sources)

    def _way(self, output: Output, port: Input) -> Pair | None:
        """Return who gives whom: by the components' owners, else by those of their nodes as well."""
        found = self.view.architecture
        giver, taker = found.components[output.component], found.components[port.component]
        if set(self.pair) <= set(giver.owners) and set(self.pair) <= set(taker.owners):
            return None
        return self._direction(giver.owners, taker.owners) or self._direction(
            (*giver.owners, *self._hosted(self._writing(output))),
            (*taker.owners, *self._hosted(self._reading(port, output))),
        )

    def _hosted(self, ends: Iterable[Endpoint]) -> Iterator[str]:
        found = self.view.architecture
        return (owner for end in ends for owner in guests(found, found.nodes[end.node]))

    def _direction(self, givers: Collection[str], takers: Collection[str]) -> Pair | None:
        first, second = self.pair
        # Owned together at both ends: nothing flows between them.
        if {first, second} <= set(givers) and {first, second} <= set(takers):
            return None
        if first in givers and second in takers:
            return first, second
        return (second, first) if second in givers and first in takers else None

    def of_topics(self) -> Iterator[Interface]:
        """Yield an interface for each topic that joins nodes of both partners without a connection."""
        for topic in self.view.architecture.topics.values():
            ends: dict[Pair, tuple[dict[int, Endpoint], dict[int, Endpoint]]] = {}
            for writer in filter(self._mine, topic.writers):
                for reader in filter(self._mine, topic.readers):
                    way = self._joined(writer, reader)
                    if way:
                        givers, takers = ends.setdefault(way, ({}, {}))
                        # By object identity: endpoints are not hashable by value, and each must be listed once.
                        givers[id(writer)], takers[id(reader)] = writer, reader
            for way, (givers, takers) in ends.items():
                yield self._topic(topic, way, tuple(givers.values()), tuple(takers.values()))

    def _joined(self, writer: Endpoint, reader: Endpoint) -> Pair | None:
        # What is connected as ports is an interface of the output already.
        if writer.node == reader.node or (writer.port is not None and writer.port in reader.sources):
            return None
        return self._direction(self._owners(writer), self._owners(reader))

    def _mine(self, end: Endpoint) -> bool:
        return not set(self.pair).isdisjoint(self._owners(end))

    def _owners(self, end: Endpoint) -> tuple[str, ...]:
        found = self.view.architecture
        own = found.components[end.component].owners if end.component else found.nodes[end.node].owners
        return (*own, *guests(found, found.nodes[end.node]))

    def _topic(self, topic: Topic, way: Pair, givers: tuple[Endpoint, ...], takers: tuple[Endpoint, ...]) -> Interface:
        message = topic.messages[0] if len(topic.messages) == 1 else None
        type_ = topic.types[0] if len(topic.types) == 1 else None
        return Interface(topic.name, way, topic.flow, givers=givers, takers=takers, type=type_, message=message)


def components(view: Index, interface: Interface) -> tuple[tuple[Component, ...], tuple[Component, ...]]:
    """Return the giving and the taking components, each once."""
    found = view.architecture
    giving = [interface.output.component] if interface.output else [end.component for end in interface.givers]
    taking = [end.component for end in (interface.inputs or interface.takers)]
    known: Mapping[str, Component] = found.components
    return (
        tuple(known[name] for name in dict.fromkeys(giving) if name),
        tuple(known[name] for name in dict.fromkeys(taking) if name),
    )
