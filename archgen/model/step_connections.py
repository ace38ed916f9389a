"""Find the connections of the architecture that a step of a use case runs along."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.port_media import is_physical
from archgen.model.use_case_steps import Step, StepEnd

StepWay = Literal["topic", "service", "action", "physical", "outside"]


@dataclass(frozen=True, slots=True)
class StepConnection:
    """One connection that a step can run along.

    `output` is the complete id of the leaf's output, the server's for services and actions; None for what a component
    sends whose outputs nobody has written yet, and for what comes in from outside. `input` is that of the reader; None
    for what goes outside.
    """

    way: StepWay
    output: str | None
    input: str | None


class StepConnections:
    """The connections between components and to the outside, indexed once for all steps of a project.

    A composed component has those of everything inside.
    """

    def __init__(self, architecture: Architecture) -> None:
        """Index the connections of an architecture."""
        self.architecture = architecture
        self._between: dict[tuple[str, str], list[StepConnection]] = defaultdict(list)
        """By the component that sends and the one that reads."""
        self._sent: dict[str, list[StepConnection]] = defaultdict(list)
        self._wholes: dict[str, tuple[str, ...]] = {}
        for edge in architecture.edges:
            output, reader = architecture.outputs[edge.output], architecture.inputs[edge.input].component
            self._add_connection(
                output.component, reader, StepConnection(_find_way(architecture, output), edge.output, edge.input)
            )
        for input_port in architecture.inputs.values():
            for connection in input_port.connections:
                if not connection.outputs and connection.kind == "component":
                    stub = StepConnection("topic", None, input_port.id)
                    self._add_connection(connection.target, input_port.component, stub)
        self._outside: dict[str, list[Input | Output]] = defaultdict(list)
        for leaf, ports in _list_outside_ports(architecture).items():
            for component_id in self._list_wholes(leaf):
                self._outside[component_id] += ports

    def find_connections(self, step: Step) -> tuple[StepConnection, ...]:
        """Return what a step can run along, each once, what is sent before what is answered.

        A step that stays with who begins it has nothing, and needs nothing; nor does one between two actors. One with an
        end that names nothing has nothing.
        """
        if not self.needs_connection(step):
            return ()
        if step.source.kind == "actor" or step.target.kind == "actor":
            return tuple(self._list_outside(step))
        sender, reader = step.source.participant, step.target.participant
        # The answer of a server goes to its client as what it sends does; a request goes the other way.
        requests = (each for each in self.list_between(reader, sender) if each.way in {"service", "action"})
        named_outputs = self._name_outputs(step.source) | self._name_outputs(step.target)
        return tuple(
            each
            for each in dict.fromkeys((*self.list_between(sender, reader), *requests))
            if not named_outputs or each.output in named_outputs
        )

    def needs_connection(self, step: Step) -> bool:
        """Whether a step can only happen along a connection."""
        are_actors = step.source.kind == "actor" and step.target.kind == "actor"
        return step.is_resolved and not step.is_inner and not are_actors

    def list_between(self, sender: str, reader: str) -> Sequence[StepConnection]:
        """Return what a component sends that another reads; the output is the server's for services and actions."""
        return self._between.get((sender, reader), ())

    def list_sent(self, component_id: str) -> Sequence[StepConnection]:
        """Return all that a component sends."""
        return self._sent.get(component_id, ())

    def _add_connection(self, sender: str, reader: str, connection: StepConnection) -> None:
        for sending_whole in self._list_wholes(sender):
            self._sent[sending_whole].append(connection)
            for reading_whole in self._list_wholes(reader):
                self._between[sending_whole, reading_whole].append(connection)

    def _list_wholes(self, component_id: str) -> tuple[str, ...]:
        """Return a component and all composed components around it."""
        if component_id not in self._wholes:
            component = self.architecture.find_component(component_id)
            around = self.architecture.list_around(component) if component else ()
            self._wholes[component_id] = (component_id, *(each.id for each in around))
        return self._wholes[component_id]

    def _name_outputs(self, end: StepEnd) -> frozenset[str]:
        if end.kind != "output":
            return frozenset()
        return frozenset(self.architecture.leaf_ports_of("output", end.id))

    def _list_outside(self, step: Step) -> Iterator[StepConnection]:
        """Yield the ports by which an actor reaches a component, or a component an actor."""
        is_sent_out = step.target.kind == "actor"
        end = step.source if is_sent_out else step.target
        named_outputs = self._name_outputs(end)
        for port in self._outside.get(end.participant, ()):
            # What is sent goes out by an output and comes in by an input; calls go both ways.
            is_output = isinstance(port, Output)
            fits = is_output == is_sent_out or _find_way(self.architecture, port) in {"service", "action"}
            if fits and (not named_outputs or port.id in named_outputs):
                yield StepConnection("outside", port.id if is_output else None, None if is_output else port.id)


def _find_way(architecture: Architecture, port: Input | Output) -> StepWay:
    return "physical" if is_physical(port) else architecture.flow_of(port)


def _list_outside_ports(architecture: Architecture) -> Mapping[str, list[Input | Output]]:
    """Return the ports of each leaf that reach outside, also those through the ports of composed components around."""
    ports_by_leaf: dict[str, dict[str, Input | Output]] = defaultdict(dict)
    for port in architecture.list_ports():
        if port.external is not None:
            ports_by_leaf[port.component][port.id] = port
    for shell in architecture.shells.values():
        for kind, ports in (("input", shell.inputs.values()), ("output", shell.outputs.values())):
            table: Mapping[str, Input | Output] = architecture.inputs if kind == "input" else architecture.outputs
            for port in ports:
                for leaf_port in architecture.leaf_ports_of(kind, port.id) if port.external is not None else ():
                    inner_port = table.get(leaf_port)
                    if inner_port is not None:
                        ports_by_leaf[inner_port.component][inner_port.id] = inner_port
    return {leaf: list(ports.values()) for leaf, ports in ports_by_leaf.items()}


@dataclass(frozen=True, slots=True)
class ConnectedStep:
    """A step with its number in the use case, counted from 1, and all that it can run along."""

    number: int
    step: Step
    connections: tuple[StepConnection, ...]
    needs_connection: bool

    @property
    def is_broken(self) -> bool:
        """Whether it needs a connection, and there is none."""
        return self.needs_connection and not self.connections

    @property
    def way(self) -> StepWay | None:
        """Return how it runs: as its first connection does; None where it has none."""
        return self.connections[0].way if self.connections else None


class UseCaseSteps:
    """The steps of all use cases with their connections. Nothing is computed before somebody asks."""

    def __init__(self, architecture: Architecture) -> None:
        """Compute nothing yet."""
        self._architecture = architecture

    @cached_property
    def by_use_case(self) -> Mapping[str, tuple[ConnectedStep, ...]]:
        """Return the steps of each use case that has any, by its id."""
        use_cases = [use_case for use_case in self._architecture.use_cases.values() if use_case.steps]
        if not use_cases:
            return {}
        connections = StepConnections(self._architecture)
        return {
            use_case.id: tuple(
                ConnectedStep(number, step, connections.find_connections(step), connections.needs_connection(step))
                for number, step in enumerate(use_case.steps, 1)
            )
            for use_case in use_cases
        }

    @cached_property
    def by_component(self) -> Mapping[str, tuple[str, ...]]:
        """Return the ids of the use cases in which each component takes part, by its complete id."""
        use_case_ids: dict[str, dict[str, None]] = defaultdict(dict)
        for use_case in self._architecture.use_cases.values():
            for step in use_case.steps:
                for end in (step.source, step.target):
                    if end.kind in {"component", "output"}:
                        use_case_ids[end.participant][use_case.id] = None
        return {component_id: tuple(ids) for component_id, ids in use_case_ids.items()}
