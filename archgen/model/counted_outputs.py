"""Which output a reader counts on: that of a leaf, or the port of the composed component that it names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_passed_shell, list_written_connections
from archgen.model.promise import Deprecation


class CountedOutput(NamedTuple):
    """An output that an input reads, with the connection that names it.

    `port` says what the reader may count on: of a composed component its port; `leaf` sends the data.
    """

    reader: Input
    connection: Connection
    port: Output
    leaf: Output


def list_counted_outputs(architecture: Architecture) -> Iterator[CountedOutput]:
    """Yield what all inputs read, those of composed components included."""
    for reader, connection in list_written_connections(architecture):
        for output_id in connection.outputs:
            if leaf := architecture.outputs.get(output_id):
                yield CountedOutput(reader, connection, find_counted_output(architecture, connection, leaf), leaf)


def find_counted_output(architecture: Architecture, connection: Connection, leaf: Output) -> Output:
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
        return next((port for port in shell.outputs.values() if _carries(architecture, port, leaf)), None)
    holder = architecture.shells.get(shell_port.rpartition(".")[0])
    return holder.outputs.get(shell_port.rpartition(".")[2]) if holder else None


def _carries(architecture: Architecture, port: Output, leaf: Output) -> bool:
    return leaf.id in architecture.leaf_ports_of("output", port.id)


def list_described_outputs(architecture: Architecture) -> Iterator[tuple[Component, Output]]:
    """Yield the outputs of composed components, then those of leaves; what is open of a composed one is not told twice."""
    for component in architecture.list_described_components():
        yield from ((component, output) for output in component.outputs.values())


def find_replacement(architecture: Architecture, kind: str, deprecated: Deprecation) -> str | None:
    """Return what is to be used in the end, where what replaces something is deprecated itself; None if nothing is named.

    `kind` is `output`, `type` or `component_type`. In a circle nothing can be used: that is reported elsewhere.
    """
    seen: set[str] = set()
    current: Deprecation | None = deprecated
    while current is not None and current.target is not None:
        if current.target in seen:
            return None
        seen.add(current.target)
        following = find_deprecation(architecture, kind, current.target)
        if following is None or following.target is None:
            return current.target
        current = following
    return None


def find_deprecation(architecture: Architecture, kind: str, name: str) -> Deprecation | None:
    """Return what is said of an output, a type or a component type that is going away; None for any other."""
    if kind == "output":
        component = architecture.find_component(name.rpartition(".")[0])
        output = component.outputs.get(name.rpartition(".")[2]) if component else None
        return output.deprecated if output else None
    holder = (architecture.types if kind == "type" else architecture.component_types).get(name)
    return holder.deprecated if holder else None


def list_deprecated_kinds(architecture: Architecture, component: Component) -> Iterator[str]:
    """Yield what of a component is going away: an `output` of its own, a `type` that its ports name, its `component_type`."""
    if any(output.deprecated for output in component.outputs.values()):
        yield "output"
    type_names = (port.type for port in component.ports if port.type)
    if any(find_deprecation(architecture, "type", name) for name in type_names):
        yield "type"
    origins = architecture.list_types_of(component)
    if any(find_deprecation(architecture, "component_type", name) for name in origins):
        yield "component_type"
