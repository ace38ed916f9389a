"""Endpoints without a port: `internal` topics and services, and everything that a node without a component uses."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.derivation import ros_names
from archgen.derivation.port_endpoints import DEFAULT_QOS, WriterIndex, flow_of_use
from archgen.derivation.wire.remap_rules import NodeNames
from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, FlowKind, Node, PortUse, UseKind

SharedKeyCounts = Mapping[tuple[str, str], int]
"""The number of nodes with an internal entry, by component id and the entry's key."""
_USE_BY_FLOW: Mapping[UseKind, Mapping[bool, UseKind]] = {
    "publishes": {True: "publishes", False: "serves"},
    "serves": {True: "publishes", False: "serves"},
    "subscribes": {True: "subscribes", False: "calls"},
    "calls": {True: "subscribes", False: "calls"},
}
"""What a use becomes for a topic (True) and for a service or action (False): the direction stays as written."""


def count_shared_keys(architecture: Architecture) -> SharedKeyCounts:
    """Count the nodes of each component that have an internal entry with the same key."""
    node_counts: dict[tuple[str, str], int] = defaultdict(int)
    for node in architecture.nodes.values():
        for key in dict.fromkeys(use.key for use in node.uses if use.internal):
            for component in node.implements:
                node_counts[component, key] += 1
    return node_counts


def derive_portless_endpoints(node: Node, distro: str | None, shared_keys: SharedKeyCounts) -> Iterator[Endpoint]:
    """Yield the endpoints of a node that have no port. `complete_message` adds the messages of readers later."""
    portless_uses = [use for use in node.uses if use.is_open and (use.internal or not node.implements)]
    if portless_uses:
        names = NodeNames(node, distro)
        for use in portless_uses:
            yield from _endpoints_of_use(node, names, use, shared_keys)


def _endpoints_of_use(node: Node, names: NodeNames, use: PortUse, shared_keys: SharedKeyCounts) -> Iterator[Endpoint]:
    """Yield the endpoints of one entry, one for each name that it lists."""
    # Below the component's name, so that internal topics of two components with the same key never meet.
    component = _find_owning_component(node, use.key, shared_keys) if use.internal else None
    default_name = ros_names.default_port_name(f"{component}.{use.key}") if component else names.expand(use.key)
    flow_kind = flow_of_use(use.message, use)
    for wire in names.name_use(use, flow_kind, default_name):
        yield Endpoint(
            node=node.id,
            use=_USE_BY_FLOW[use.use][flow_kind == "topic"],
            name=wire.name,
            program_name=wire.program_name,
            evidence=wire.evidence,
            flow=flow_kind,
            port=None,
            component=component,
            message=use.message,
            qos=use.qos or DEFAULT_QOS,
            own_name=use.own_name,
            internal=use.internal,
            written=True,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )


def _find_owning_component(node: Node, key: str, shared_keys: SharedKeyCounts) -> str | None:
    """Return the component of an internal entry: the first one of which another node has the same entry, if any."""
    shared_components = [component for component in node.implements if shared_keys[component, key] > 1]
    return next(iter(shared_components or node.implements), None)


def complete_message(endpoint: Endpoint, writer_index: WriterIndex) -> Endpoint:
    """Add the message, type and flow of a writer with the same name to a reading endpoint that has no message."""
    if endpoint.message is not None or endpoint.name is None or endpoint.use in {"publishes", "serves"}:
        return endpoint
    # A caller without a message does not say whether it calls a service or an action.
    flows: tuple[FlowKind, ...] = ("topic",) if endpoint.flow == "topic" else ("service", "action")
    for flow_kind in flows:
        for writer in writer_index.by_name.get((endpoint.name, flow_kind), ()):
            if writer.message:
                return replace(endpoint, message=writer.message, flow=flow_kind, type=writer.type)
    return endpoint
