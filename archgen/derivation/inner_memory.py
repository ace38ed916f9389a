"""What passes between components of one node stays in its memory: nobody publishes it, and no message is asked for."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TypeVar

from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group, Input, Output
from archgen.model.port_media import MEMORY, uses_ros

_Port = TypeVar("_Port", Input, Output)


def mark_inner_memory(architecture: Architecture) -> Architecture:
    """Give ports the medium `memory` where all that they exchange stays within one node, and nobody wrote otherwise.

    A port that the node lists, with a topic of its own or not, is published or read over ROS.
    """
    only_nodes = _find_only_nodes(architecture)
    if not only_nodes:
        return architecture
    listed = {
        (use.use in {"publishes", "serves"}, use.port) for node in architecture.nodes.values() for use in node.uses
    }
    outside: tuple[set[str], set[str]] = set(), set()
    inside: tuple[set[str], set[str]] = set(), set()
    for edge in architecture.edges:
        output, entry = architecture.outputs[edge.output], architecture.inputs[edge.input]
        node = only_nodes.get(output.component)
        is_inside = (
            node is not None
            and node == only_nodes.get(entry.component)
            and not (_is_settled(output) or _is_settled(entry))
            and (True, output.id) not in listed
            and (False, entry.id) not in listed
        )
        written, read = inside if is_inside else outside
        written.add(output.id)
        read.add(entry.id)
    outputs, inputs = inside[0] - outside[0], inside[1] - outside[1]
    return _replace_ports(architecture, inputs, outputs) if inputs or outputs else architecture


def _is_settled(port: Input | Output) -> bool:
    """Whether a port's medium is not open any more: it is written, is no ROS, or reaches outside of the system."""
    return port.medium_written or not uses_ros(port) or port.external is not None


def _find_only_nodes(architecture: Architecture) -> Mapping[str, str]:
    """Return the node of each component that has one alone, as far as it implements others besides."""
    nodes_by_component: dict[str, list[str]] = {}
    for node in architecture.nodes.values():
        for component in node.implements:
            nodes_by_component.setdefault(component, []).append(node.id)
    shared = {node.id for node in architecture.nodes.values() if len(node.implements) > 1}
    return {
        component: nodes[0] for component, nodes in nodes_by_component.items() if len(nodes) == 1 and nodes[0] in shared
    }


def _replace_ports(architecture: Architecture, inputs: Collection[str], outputs: Collection[str]) -> Architecture:
    """Return the architecture with the medium `memory` at these ports."""
    changed = {name.rpartition(".")[0] for name in (*inputs, *outputs)}
    components = dict(architecture.components)
    for name in sorted(changed):
        component = components[name]
        components[name] = replace(
            component, inputs=_mark_ports(component.inputs, inputs), outputs=_mark_ports(component.outputs, outputs)
        )
    return replace(
        architecture,
        components=components,
        groups={name: _replace_components(group, components, changed) for name, group in architecture.groups.items()},
        inputs={name: components[port.component].inputs[port.name] for name, port in architecture.inputs.items()},
        outputs={name: components[port.component].outputs[port.name] for name, port in architecture.outputs.items()},
    )


def _mark_ports(ports: Mapping[str, _Port], ids: Collection[str]) -> dict[str, _Port]:
    return {name: replace(port, medium=MEMORY) if port.id in ids else port for name, port in ports.items()}


def _replace_components(group: Group, components: Mapping[str, Component], changed: Collection[str]) -> Group:
    members = {name: components[each.id] for name, each in group.components.items()}
    return replace(group, components=members) if any(each.id in changed for each in members.values()) else group
