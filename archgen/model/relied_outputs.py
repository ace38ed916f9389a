"""Which output a reader counts on: that of a leaf, or the port of the composed component that it names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_passed_shell, list_written_connections


class ReliedOutput(NamedTuple):
    """An output that an input reads, with the connection that names it.

    `port` says what the reader may count on: of a composed component its port; `leaf` sends the data.
    """

    reader: Input
    connection: Connection
    port: Output
    leaf: Output


def list_relied_outputs(architecture: Architecture) -> Iterator[ReliedOutput]:
    """Yield what all inputs read, those of composed components included."""
    for reader, connection in list_written_connections(architecture):
        for output_id in connection.outputs:
            if leaf := architecture.outputs.get(output_id):
                yield ReliedOutput(reader, connection, find_relied_output(architecture, connection, leaf), leaf)


def find_relied_output(architecture: Architecture, connection: Connection, leaf: Output) -> Output:
    """Return the output whose word counts for a connection to an output of a leaf."""
    current, seen_inputs = connection, {connection.input}
    while current.shell_port is not None:
        reader_id = current.input.rpartition(".")[0]
        shell_id = find_passed_shell(architecture, reader_id, current)
        if shell_id is None:
            return _find_port(architecture, current.shell_port, leaf) or leaf
        # It comes through an input of what is around: what that one names counts.
        passing = architecture.shells[shell_id].inputs[current.shell_port.rpartition(".")[2]]
        outer = next((each for each in passing.connections if leaf.id in each.outputs), None)
        if outer is None or outer.input in seen_inputs:
            return leaf
        seen_inputs.add(outer.input)
        current = outer
    return leaf


def _find_port(architecture: Architecture, shell_port: str, leaf: Output) -> Output | None:
    """Return the output of a composed component that is named, or of a component that is named as a whole."""
    shell = architecture.shells.get(shell_port)
    if shell is not None:
        return next((port for port in shell.outputs.values() if _is_passed_on(architecture, port, leaf)), None)
    holder = architecture.shells.get(shell_port.rpartition(".")[0])
    return holder.outputs.get(shell_port.rpartition(".")[2]) if holder else None


def _is_passed_on(architecture: Architecture, port: Output, leaf: Output) -> bool:
    return leaf.id in architecture.leaf_ports_of("output", port.id)


def list_described_outputs(architecture: Architecture) -> Iterator[tuple[Component, Output]]:
    """Yield the outputs of composed components, then those of leaves; what is open of a composed one is not told twice."""
    for component in architecture.list_described_components():
        yield from ((component, output) for output in component.outputs.values())
