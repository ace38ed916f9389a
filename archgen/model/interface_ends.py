"""Who answers for the ends of an interface: the owners of a component, and of the nodes that carry its ports."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.node import Endpoint, Node


def foreign_owners(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """Return a node's owners if somebody wrote others than those of its components."""
    component_owners = {owner for component in node.implements for owner in architecture.components[component].owners}
    return node.owners if set(node.owners) != component_owners else ()


@dataclass(frozen=True, slots=True)
class InterfaceEnds:
    """What all pairs of partners look up: the endpoints of each port by `(writes, port)`, and the owners of nodes that
    differ from those of their components. `positions` are those of the outputs in the architecture.
    """

    architecture: Architecture
    endpoints_by_port: Mapping[tuple[bool, str], list[Endpoint]]
    foreign_owners: Mapping[str, tuple[str, ...]]
    positions: Mapping[str, int]

    def list_port_owners(self, port: Input | Output) -> set[str]:
        """Return all who may answer for a port: the owners of its component, and of the nodes that carry it."""
        endpoints = self.endpoints_by_port.get((isinstance(port, Output), port.id), ())
        foreign = (owner for endpoint in endpoints for owner in self.foreign_owners[endpoint.node])
        return {*self.architecture.components[port.component].owners, *foreign}

    def list_endpoint_owners(self, endpoint: Endpoint) -> tuple[str, ...]:
        """Return who answers for an endpoint."""
        written_owners = (
            self.architecture.components[endpoint.component].owners
            if endpoint.component
            else self.architecture.nodes[endpoint.node].owners
        )
        return (*written_owners, *self.foreign_owners[endpoint.node])


def list_interface_ends(architecture: Architecture) -> InterfaceEnds:
    """Return who answers for what in an architecture."""
    endpoints_by_port: dict[tuple[bool, str], list[Endpoint]] = {}
    for endpoint in architecture.list_endpoints():
        if endpoint.port is not None:
            key = endpoint.use in {"publishes", "serves"}, endpoint.port
            endpoints_by_port.setdefault(key, []).append(endpoint)
    owners_by_node = {node.id: foreign_owners(architecture, node) for node in architecture.nodes.values()}
    positions = {output: position for position, output in enumerate(architecture.outputs)}
    return InterfaceEnds(architecture, endpoints_by_port, owners_by_node, positions)
