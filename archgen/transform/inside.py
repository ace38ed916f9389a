"""What nodes use that no port stands for: `internal` topics and services, and all that a node without component uses."""

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
"""How many nodes of a component have an internal entry of one name."""
_AS: Mapping[Use, Mapping[bool, Use]] = {
    "publishes": {True: "publishes", False: "serves"},
    "serves": {True: "publishes", False: "serves"},
    "subscribes": {True: "subscribes", False: "calls"},
    "calls": {True: "subscribes", False: "calls"},
}
"""What a use is, for a topic and for a service or action."""


def partners(architecture: Architecture) -> Partners:
    """Count who shares an internal name."""
    found: dict[tuple[str, str], int] = defaultdict(int)
    for node in architecture.nodes.values():
        for key in {use.key for use in node.uses if use.internal}:
            for component in node.implements:
                found[component, key] += 1
    return found


def portless_endpoints(node: Node, shared_keys: Partners) -> Iterator[Endpoint]:
    """Give the endpoints of a node for which no port stands. Readers do not know their message yet."""
    for use in node.uses:
        if use.internal or not node.implements:
            yield from _endpoints(node, use, shared_keys)


def _endpoints(node: Node, use: PortUse, shared_keys: Partners) -> Iterator[Endpoint]:
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
    """Give the component inside which something flows: of several, the one whose other nodes know the name, too."""
    together = [component for component in node.implements if shared_keys[component, key] > 1]
    return next(iter(together or node.implements), None)


def completed(endpoint: Endpoint, found: Traffic) -> Endpoint:
    """Give a reader the message of those who write."""
    if endpoint.message is not None or endpoint.use in {"publishes", "serves"}:
        return endpoint
    flows: tuple[Flow, ...] = ("topic",) if endpoint.flow == "topic" else ("service", "action")
    for kind in flows:
        for writer in found.by_name.get((endpoint.name, kind), ()):
            if writer.message:
                return replace(endpoint, message=writer.message, flow=kind, type=writer.type)
    return endpoint
