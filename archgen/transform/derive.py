"""Derive the low level where it is not written: planned nodes, endpoints with their absolute names, and topics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from archgen.model.architecture import Architecture
from archgen.model.mapping import Type
from archgen.model.node import Endpoint, Flow, Topic
from archgen.transform import ros_names
from archgen.transform.inside import completed, partners, portless_endpoints
from archgen.transform.planned import planned_nodes
from archgen.transform.readers import read_endpoints, traffic
from archgen.transform.writers import carriers, written_endpoints


def derive(architecture: Architecture) -> Architecture:
    """Add a planned node for each component without any, and the endpoints and topics of all nodes."""
    nodes = dict(architecture.nodes) | {node.id: node for node in planned_nodes(architecture)}
    whole = replace(architecture, nodes=nodes)
    shared = ros_names.shared_names(architecture.shared_topics)
    endpoints = _endpoints(whole, shared)
    return replace(whole, endpoints=endpoints, topics=_topics(endpoints, shared, architecture.types))


def _endpoints(architecture: Architecture, shared: frozenset[str]) -> tuple[Endpoint, ...]:
    """Derive the endpoints of all nodes, in the order of nodes."""
    # All writing endpoints come first: a reader takes its topic's name and message from those that write it.
    parts, shared_keys = carriers(architecture), partners(architecture)
    written = {
        name: [endpoint for carrier in parts[name] for endpoint in written_endpoints(architecture, carrier)]
        for name in architecture.nodes
    }
    portless = {name: list(portless_endpoints(node, shared_keys)) for name, node in architecture.nodes.items()}
    inside = (e for endpoints in portless.values() for e in endpoints if e.use in {"publishes", "serves"})
    found = traffic(architecture, shared, [*(e for endpoints in written.values() for e in endpoints), *inside])
    # For each node: what it writes, what it reads, then what has no port.
    all_of_them: list[Endpoint] = []
    for name in architecture.nodes:
        all_of_them += written[name]
        for carrier in parts[name]:
            all_of_them += read_endpoints(found, carrier)
        all_of_them += (completed(endpoint, found) for endpoint in portless[name])
    return tuple(all_of_them)


@dataclass(slots=True)
class _Users:
    """The endpoints of one topic, service or action."""

    writers: list[Endpoint] = field(default_factory=list)
    readers: list[Endpoint] = field(default_factory=list)


def _topics(endpoints: Iterable[Endpoint], shared: frozenset[str], types: Mapping[str, Type]) -> dict[str, Topic]:
    """Gather endpoints by name and flow. Further flows with the same name get a key of their own: `/name (service)`."""
    users: dict[tuple[str, Flow], _Users] = {}
    for endpoint in endpoints:
        both = users.setdefault((endpoint.name, endpoint.flow), _Users())
        (both.writers if endpoint.use in {"publishes", "serves"} else both.readers).append(endpoint)
    topics: dict[str, Topic] = {}
    for (name, flow), both in users.items():
        key = name if name not in topics else f"{name} ({flow})"
        topics[key] = _topic(name, flow, both, types, shared=flow == "topic" and name in shared)
    return topics


def _topic(name: str, flow: Flow, users: _Users, types: Mapping[str, Type], *, shared: bool) -> Topic:
    """Make a topic. Its types are those of the writers, else of the readers; its size is the largest known one."""
    named = dict.fromkeys(e.type for e in users.writers or users.readers if e.type)
    sizes = [types[one].size for one in named if one in types]
    return Topic(
        name=name,
        flow=flow,
        messages=tuple(dict.fromkeys(e.message for e in (*users.writers, *users.readers) if e.message)),
        types=tuple(named),
        writers=tuple(users.writers),
        readers=tuple(users.readers),
        size=max((size for size in sizes if size), key=lambda size: size.value, default=None),
        shared=shared,
    )
