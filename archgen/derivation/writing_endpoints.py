"""Endpoints that write (publish, serve): the outputs of a node's components, under their written or default names."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import field

from archgen.derivation import ros_names
from archgen.derivation.wire.remap_rules import NodeNames
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Output
from archgen.model.message_types import flow_of
from archgen.model.node import Endpoint, FlowKind, Node, PortUse, Qos, UseKind
from archgen.model.port_media import uses_ros

UNWRITTEN_USE = PortUse("publishes", "", None)
"""The entry of a port that its node does not list. Compared by identity: a written entry may look the same."""
DEFAULT_QOS = Qos()


@dataclass(frozen=True, slots=True)
class NodePart:
    """A node as an implementation of one component: its entries for the component's ports.

    `is_only_node`: no other node implements the component, so that the node carries all of its ports.
    """

    node: Node
    component: Component
    uses_by_port: Mapping[str, tuple[PortUse, ...]]
    """The entries by the port's complete id. Those of the node's other components are among them."""
    is_only_node: bool
    names: NodeNames
    given_ports: Mapping[str, str] = field(default_factory=dict)
    """Of a node that is all of a composed component: its outputs by the leaves' outputs that they pass on."""


def find_node_parts(architecture: Architecture) -> dict[str, tuple[NodePart, ...]]:
    """Return one `NodePart` for each component that a node implements, by node id, in the order of `implements`."""
    node_counts: dict[str, int] = {}
    for node in architecture.nodes.values():
        for component in node.implements:
            node_counts[component] = node_counts.get(component, 0) + 1
    node_parts: dict[str, tuple[NodePart, ...]] = {}
    for node in architecture.nodes.values():
        uses: dict[str, list[PortUse]] = {}
        for use in node.uses:
            if use.port and not use.internal:
                uses.setdefault(use.port, []).append(use)
        by_port = {port: tuple(port_uses) for port, port_uses in uses.items()}
        names = NodeNames(node, architecture.distro)
        node_parts[node.id] = tuple(
            NodePart(
                node,
                architecture.components[component_id],
                by_port,
                node_counts[component_id] == 1,
                names,
                _find_given_ports(architecture, node) if node.wholes else {},
            )
            for component_id in node.implements
        )
    return node_parts


def _find_given_ports(architecture: Architecture, node: Node) -> dict[str, str]:
    return {
        leaf: output.id
        for whole in node.wholes
        for output in architecture.shells[whole].outputs.values()
        for leaf in architecture.leaf_ports_of("output", output.id)
    }


def derive_writing_endpoints(architecture: Architecture, node_part: NodePart) -> Iterator[Endpoint]:
    """Yield what a node writes for a component: one endpoint for each output and each of its names."""
    for output in node_part.component.outputs.values():
        uses = filter_uses(node_part.uses_by_port.get(output.id, ()), {"publishes", "serves"})
        if not uses_ros(output) or not (uses or node_part.is_only_node):
            continue
        for use in uses or (UNWRITTEN_USE,):
            if not use.is_open:
                continue
            yield from _endpoints_of_output(architecture, node_part, output, use)


def filter_uses(uses: Iterable[PortUse], use_kinds: Collection[UseKind]) -> tuple[PortUse, ...]:
    """Return the entries of some sections: an input and an output may have the same name, and so the same id."""
    return tuple(use for use in uses if use.use in use_kinds)


def invents_names(node: Node) -> bool:
    """Whether archgen may say what a port is called: of a program that exists, nobody but itself knows."""
    return node.status != "existing"


def flow_of_use(message: str | None, use: PortUse) -> FlowKind:
    """Return the kind of flow by the message; if unknown, by the section that the entry is written in."""
    if message is None and use.use in {"serves", "calls"}:
        return "service"
    return flow_of(message)


def _endpoints_of_output(
    architecture: Architecture, node_part: NodePart, output: Output, use: PortUse
) -> Iterator[Endpoint]:
    """Yield the endpoints of one output for one entry."""
    message = use.message or architecture.message_of(output)
    flow_kind = flow_of_use(message, use)
    default_name = ros_names.default_port_name(node_part.given_ports.get(output.id, output.id))
    for wire in node_part.names.name_use(use, flow_kind, default_name if invents_names(node_part.node) else None):
        yield Endpoint(
            node=node_part.node.id,
            use="publishes" if flow_kind == "topic" else "serves",
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow=flow_kind,
            port=output.id,
            component=node_part.component.id,
            message=message,
            type=output.type,
            qos=use.qos or DEFAULT_QOS,
            own_name=use.own_name,
            written=use is not UNWRITTEN_USE,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )
