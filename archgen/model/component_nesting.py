"""Where components stand: what is directly inside of a group or a composed component, and what is around.

Which output a reader counts on: that of a leaf, or the port of the composed component that it names.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output


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
        return next(
            (port for port in shell.outputs.values() if leaf.id in architecture.leaf_ports_of("output", port.id)), None
        )
    holder = architecture.shells.get(shell_port.rpartition(".")[0])
    return holder.outputs.get(shell_port.rpartition(".")[2]) if holder else None


def list_described_outputs(architecture: Architecture) -> Iterator[tuple[Component, Output]]:
    """Yield the outputs of composed components, then those of leaves; what is open of a composed one is not told twice."""
    for component in architecture.list_described_components():
        yield from ((component, output) for output in component.outputs.values())


def find_component(architecture: Architecture, component_id: str) -> Component:
    """Return a component by its complete id; of a composed one the whole, with all of its ports."""
    # Shells first: one that is not designed to its end is among the leaves as well, with the open ports only.
    return architecture.shells.get(component_id) or architecture.components[component_id]


def list_surrounding(architecture: Architecture, component_id: str) -> tuple[str, ...]:
    """Return the composed components around a component, the outermost first."""
    around: list[str] = []
    parent = find_component(architecture, component_id).parent if architecture.shells else None
    while parent is not None and parent in architecture.shells:
        around.insert(0, parent)
        parent = architecture.shells[parent].parent
    return tuple(around)


def find_closed(architecture: Architecture, component_id: str, open_shells: Collection[str] = ()) -> str:
    """Return what stands for a component where these composed components are open: the outermost closed one around it."""
    around = list_surrounding(architecture, component_id)
    return next((shell for shell in around if shell not in open_shells), component_id)


def list_members(architecture: Architecture, group_id: str, open_shells: Collection[str] = ()) -> tuple[str, ...]:
    """Return the components directly in a group, composed ones closed but for the open ones, in the order of the group."""
    leaves = (component.id for component in architecture.groups[group_id].components.values())
    members = dict.fromkeys(find_closed(architecture, leaf, open_shells) for leaf in leaves)
    members |= dict.fromkeys(
        shell.id
        for shell in architecture.shells.values()
        if shell.group == group_id and shell.parent is None and shell.id not in open_shells
    )
    return tuple(members)


def list_written_connections(architecture: Architecture) -> Iterator[tuple[Input, Connection]]:
    """Yield the connections of all inputs, those of composed components included."""
    for connection in architecture.connections:
        yield architecture.inputs[connection.input], connection
    for shell in architecture.shells.values():
        for port in shell.inputs.values():
            if port.id not in architecture.inputs:
                yield from ((port, connection) for connection in port.connections)


def find_passed_shell(architecture: Architecture, reader_id: str, connection: Connection) -> str | None:
    """Return the composed component around the reader through whose input a connection comes (`self.x`)."""
    port_id = connection.shell_port
    holder = port_id.rpartition(".")[0] if port_id else ""
    if port_id is None or holder != find_component(architecture, reader_id).parent:
        return None
    # A component inside may be called as the input is; `self` tells them apart.
    is_component = port_id in architecture.shells and not connection.written.startswith("self.")
    input_ids = () if is_component else [port.id for port in architecture.shells[holder].inputs.values()]
    return holder if port_id in input_ids else None
