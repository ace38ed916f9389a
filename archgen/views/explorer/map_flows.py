"""Make the tables of what flows: ports and connections of components, and topics between nodes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.model import flow_graph
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.port_media import ROS, label_of_medium, name_on_medium
from archgen.views.explorer.map_shapes import Row
from archgen.views.graphs.drawn_level import flow_style, list_flows, warn_of_outputs
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import join_entry_parts

_OPTIONAL, _MADE = 1, 2
_STYLES = ("data", "physical", "service", "action")

Numbers = Mapping[str, int]
"""The positions of elements in their table, by id."""


def make_flow_tables(
    lookup: Lookup, components: Numbers, nodes: Numbers, shells: Iterable[Component]
) -> dict[str, tuple[Row, ...]]:
    """Make the tables of ports, of flows between shown components, and of topics between shown nodes."""
    architecture = lookup.architecture
    types = {name: number for number, name in enumerate(architecture.types)}
    outputs = [port for port in architecture.outputs.values() if port.component in components]
    inputs = [port for port in architecture.inputs.values() if port.component in components]
    output_numbers = {port.id: number for number, port in enumerate(outputs)}
    input_numbers = {port.id: number for number, port in enumerate(inputs)}
    flows = tuple(_list_flow_rows(architecture, input_numbers, output_numbers))
    topics: dict[str, int] = {}
    links = tuple(_list_link_rows(architecture, nodes, topics))
    return {
        "outputs": tuple((*_port_row(port, components, types), warn_of_outputs(lookup, (port,))) for port in outputs),
        "inputs": tuple((*_port_row(port, components, types), _mark_input(port)) for port in inputs),
        "rims": tuple(_list_rim_rows(architecture, shells, types, {"input": input_numbers, "output": output_numbers})),
        "flows": flows,
        "extra": tuple(_list_extra_steps(architecture, components, flows, outputs, inputs)),
        "topics": tuple(_make_carrier_rows(architecture, topics)),
        "links": links,
    }


def _port_row(port: Input | Output, components: Numbers, types: Numbers) -> Row:
    note = join_entry_parts(port.external, label_of_medium(port))
    return (components[port.component], port.name, types.get(port.type or "", -1), note)


def _mark_input(port: Input) -> int:
    """Return what is special about an input, as bits. `autoconnect` joins only what has no source: all of it is made, or none."""
    is_made = bool(port.connections) and all(connection.is_made for connection in port.connections)
    return _OPTIONAL * port.optional + _MADE * is_made


def _list_rim_rows(
    architecture: Architecture, shells: Iterable[Component], types: Numbers, leaf_numbers: Mapping[str, Numbers]
) -> Iterator[Row]:
    """Yield the ports of composed components, with the ports of leaves that stand behind each."""
    for number, shell in enumerate(shells):
        ports: tuple[Input | Output, ...] = (*shell.inputs.values(), *shell.outputs.values())
        for port in ports:
            kind = "input" if isinstance(port, Input) else "output"
            behind = architecture.leaf_ports_of(kind, port.id)
            numbers = tuple(leaf_numbers[kind][each] for each in behind if each in leaf_numbers[kind])
            marks = _mark_input(port) if isinstance(port, Input) else 0
            _, *values = _port_row(port, {shell.id: number}, types)
            yield (number, int(kind == "output"), *values, marks, numbers, _list_sources(port, leaf_numbers["output"]))


def _list_sources(port: Input | Output, outputs: Numbers) -> tuple[int, ...]:
    """Return the outputs that feed an input from outside."""
    connections = port.connections if isinstance(port, Input) else ()
    return tuple(outputs[each] for connection in connections for each in connection.outputs if each in outputs)


def _list_flow_rows(architecture: Architecture, inputs: Numbers, outputs: Numbers) -> Iterator[Row]:
    """Yield each flow between two shown components. It runs from its outputs, a call from the input to them."""
    for flow in list_flows(architecture):
        connection = flow.connection
        producer = flow.head if flow.style in {"service", "action"} else flow.tail
        numbers = tuple(
            outputs[output]
            for output in connection.outputs
            if output in outputs and architecture.outputs[output].component == producer
        )
        if numbers and connection.input in inputs:
            style = flow_style(
                architecture,
                next(name for name in connection.outputs if architecture.outputs[name].component == producer),
            )
            row = (_STYLES.index(style), inputs[connection.input], numbers)
            yield (*row, flow.medium) if flow.medium else row


def _list_extra_steps(
    architecture: Architecture, components: Numbers, flows: tuple[Row, ...], outputs: list[Output], inputs: list[Input]
) -> Iterator[Row]:
    """Yield the steps that selectors take and no flow shows: from components of which no output is known yet, ..."""
    known_steps = set()
    for style, reader, numbers, *_ in flows:
        for number in numbers:  # type: ignore[attr-defined]
            ends = (outputs[number].component, inputs[reader].component)  # type: ignore[call-overload]
            known_steps.add(ends)
            if style in {_STYLES.index("service"), _STYLES.index("action")}:
                known_steps.add(ends[::-1])
    for tail, heads in flow_graph.build_component_graph(architecture).successors.items():
        for head in heads:
            if tail in components and head in components and (tail, head) not in known_steps:
                yield (components[tail], components[head])


def _list_link_rows(architecture: Architecture, nodes: Numbers, topics: dict[str, int]) -> Iterator[Row]:
    """Yield what runs between two shown nodes over a topic, a call from client to server; add to `topics` which."""
    seen_links = set()
    for key, topic in architecture.list_carriers():
        for writer in topic.writers:
            for reader in topic.readers:
                # As in `model.flow_graph`: of a shared topic only what the reader's input names.
                if (topic.shared and writer.port not in reader.sources) or writer.node == reader.node:
                    continue
                ends = (writer.node, reader.node) if topic.flow == "topic" else (reader.node, writer.node)
                if ends[0] in nodes and ends[1] in nodes and (*ends, key) not in seen_links:
                    seen_links.add((*ends, key))
                    yield (nodes[ends[0]], nodes[ends[1]], topics.setdefault(key, len(topics)))


def _make_carrier_rows(architecture: Architecture, keys: Iterable[str]) -> Iterator[Row]:
    """Yield the rows of topics, and of what runs over other media."""
    carriers = dict(architecture.list_carriers())
    for key in keys:
        carrier = carriers[key]
        row = (f"topic:{key}" if carrier.medium == ROS else f"channel:{key}", name_on_medium(carrier), carrier.flow)
        yield (*row, label) if (label := label_of_medium(carrier)) else row
