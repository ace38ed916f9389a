"""Endpoints without a port: `internal` topics and services, and everything that a node without a component uses."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Flow, Node, PortUse, Use
from archgen.transform import ros_names
from archgen.transform.readers import Traffic
from archgen.transform.writers import DEFAULT, flow

Partners = Mapping[tuple[str, str], int]
"""The number of nodes with an internal entry, by component id and the entry's key."""
_AS: Mapping[Use, Mapping[bool, Use]] = {
    "publishes": {True: "publishes", False: "serves"},
    "serves": {True: "publishes", False: "serves"},
    "subscribes": {True: "subscribes", False: "calls"},
    "calls": {True: "subscribes", False: "calls"},
}
"""What a use becomes for a topic (True) and for a service or action (False): the direction stays as written."""


def partners(architecture: Architecture) -> Partners:
    """Count the nodes of each component that have an internal entry with the same key."""
    found: dict[tuple[str, str], int] = defaultdict(int)
    for node in architecture.nodes.values():
        for key in {use.key for use in node.uses if use.internal}:
            for component in node.implements:
                found[component, key] += 1
    return found


def portless_endpoints(node: Node, shared_keys: Partners) -> Iterator[Endpoint]:
    """Yield the endpoints of a node that have no port. `complete_message` adds the messages of readers later."""
    for use in node.uses:
        if use.internal or not node.implements:
            yield from _endpoints(node, use, shared_keys)


def _endpoints(node: Node, use: PortUse, shared_keys: Partners) -> Iterator[Endpoint]:
    """Yield the endpoints of one entry, one for each name that it lists."""
    # Below the component's name, so that internal topics of two components with the same key never meet.
    component = _component(node, use.key, shared_keys) if use.internal else None
    default = ros_names.of_port(f"{component}.{use.key}") if component else ros_names.absolute(use.key, node)
    kind = flow(use.message, use)
    for name in [ros_names.absolute(topic, node) for topic in use.topics] or [default]:
        yield Endpoint(
            node=node.id,
            use=_AS[use.use][kind == "topic"],
            name=name,
            flow=kind,
            port=None,
            component=component,
            message=use.message,
            qos=use.qos or DEFAULT,
            internal=use.internal,
            written=True,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )


def _component(node: Node, key: str, shared_keys: Partners) -> str | None:
    """Return the component of an internal entry: the first one of which another node has the same entry, if any."""
    together = [component for component in node.implements if shared_keys[component, key] > 1]
    return next(iter(together or node.implements), None)


def completed(endpoint: Endpoint, found: Traffic) -> Endpoint:
    """Add the message, type and flow of a writer with the same name to a reading endpoint that has no message."""
    if endpoint.message is not None or endpoint.use in {"publishes", "serves"}:
        return endpoint
    # A caller without a message does not say whether it calls a service or an action.
    flows: tuple[Flow, ...] = ("topic",) if endpoint.flow == "topic" else ("service", "action")
    for kind in flows:
        for writer in found.by_name.get((endpoint.name, kind), ()):
            if writer.message:
                return replace(endpoint, message=writer.message, flow=kind, type=writer.type)
    return endpoint
