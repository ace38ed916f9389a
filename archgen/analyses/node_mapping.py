"""Do nodes cover the components? Components without nodes, nodes without components, ports that no node takes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label, Severity
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input
from archgen.model.node import Node
from archgen.model.port_media import uses_ros


def nodes_of_components(architecture: Architecture) -> Mapping[str, tuple[Node, ...]]:
    """Return the nodes that implement each component, by component id, without planned nodes that archgen adds."""
    nodes_by_component: dict[str, list[Node]] = defaultdict(list)
    for node in architecture.nodes.values():
        if node.written:
            for component in dict.fromkeys(node.implements):
                nodes_by_component[component].append(node)
    return {component: tuple(nodes) for component, nodes in nodes_by_component.items()}


def unmapped_component(architecture: Architecture) -> Iterator[Diagnostic]:
    """No node implements a component."""
    # The node may be in the file that could not be read.
    if architecture.partial:
        return
    nodes = nodes_of_components(architecture)
    for component in architecture.components.values():
        if (
            component.id in nodes
            or component.id in architecture.suspected_ids
            or (component.ports and not any(map(uses_ros, component.ports)))
        ):
            continue
        yield Diagnostic(
            "unmapped-component",
            f"no node implements `{component.id}`",
            component.at,
            help=f"write a node with `implements: {component.id}` (`status: planned` if it does not exist yet)",
            element=component.id,
        )


def unjustified_node(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node implements no component."""
    managers = {node.start.by.id for node in architecture.nodes.values() if node.start and node.start.by}
    for node in architecture.nodes.values():
        serves_start = node.id in managers or "program" in node.kinds or (node.start is not None and node.start.once)
        # `implements` that resolves to nothing is reported by the linker.
        if node.written and not node.implements and not node.implements_written and not serves_start:
            yield Diagnostic(
                "unjustified-node",
                f"the node `{node.id}` implements no component",
                node.at,
                help="name the component in `implements`, or add a component for what the node is there for",
                element=node.id,
            )


def unpublished_output(architecture: Architecture) -> Iterator[Diagnostic]:
    """Several nodes implement a component, and none of them publishes (or serves) one of its outputs."""
    for component, nodes, carried_ports in _find_shared_components(architecture):
        for output in component.outputs.values():
            if not uses_ros(output) or output.id in carried_ports:
                continue
            names = " and ".join(f"`{node.id}`" for node in nodes)
            yield Diagnostic(
                "unpublished-output",
                f"none of the nodes of `{component.id}` publishes `{output.name}`",
                output.at,
                labels=tuple(Label(node.at, "a node of it") for node in nodes),
                help=f"name `{output.name}` in `publishes` (a service or action in `serves`) of {names}",
                element=component.id,
            )


def unsubscribed_input(architecture: Architecture) -> Iterator[Diagnostic]:
    """Several nodes implement a component, and none of them subscribes to (or calls) one of its inputs."""
    for component, nodes, carried_ports in _find_shared_components(architecture):
        for entry in component.inputs.values():
            if entry.id in carried_ports or not _receives_messages(architecture, entry):
                continue
            names = " and ".join(f"`{node.id}`" for node in nodes)
            yield Diagnostic(
                "unsubscribed-input",
                f"none of the nodes of `{component.id}` reads `{entry.name}`",
                entry.at,
                labels=tuple(Label(node.at, "a node of it") for node in nodes),
                help=f"name `{entry.name}` in `subscribes` (a service or action in `calls`) of {names}",
                element=component.id,
            )


def _find_shared_components(architecture: Architecture) -> Iterator[tuple[Component, tuple[Node, ...], frozenset[str]]]:
    """Yield each component that several nodes implement, those nodes, and the ids of all ports that nodes carry."""
    if architecture.partial:
        return
    # A component with one node is never looked at: that node carries all of its ports by definition.
    shared_components = {
        component: nodes for component, nodes in nodes_of_components(architecture).items() if len(nodes) > 1
    }
    endpoint_ports = {e.port for e in architecture.endpoints if e.component in shared_components and e.port}
    for component, nodes in shared_components.items():
        named_ports = {use.port for node in nodes for use in node.uses if use.port}
        # What an unresolved reference probably meant counts as carried, since the reference itself is reported.
        yield (
            architecture.components[component],
            nodes,
            frozenset(named_ports | endpoint_ports) | architecture.suspected_ids,
        )


def _receives_messages(architecture: Architecture, entry: Input) -> bool:
    outputs = (architecture.outputs[o] for connection in entry.connections for o in connection.outputs)
    return uses_ros(entry) and any(uses_ros(output) for output in outputs)


RULES = (
    (unmapped_component, Severity.WARNING),
    (unjustified_node, Severity.WARNING),
    (unpublished_output, Severity.WARNING),
    (unsubscribed_input, Severity.WARNING),
)
