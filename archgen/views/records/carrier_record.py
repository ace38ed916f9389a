"""Topics, services, actions and what travels over other media in the resolved record, with the nodes that use them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict

from archgen.model.node import Endpoint, Qos, Topic
from archgen.model.port_media import ROS, name_on_medium
from archgen.views.lookup import Lookup
from archgen.views.records.record_values import drop_unknown, record_quantity


def record_carriers(lookup: Lookup) -> dict[str, object]:
    """Return the sections of topics and of channels, the second only where there are any."""
    architecture = lookup.architecture
    channels = list(_record_shown(lookup, architecture.channels.values()))
    return {
        "topics": list(_record_shown(lookup, architecture.topics.values())),
        **({"channels": channels} if channels else {}),
    }


def _record_shown(lookup: Lookup, carriers: Iterable[Topic]) -> Iterator[dict[str, object]]:
    """Yield what shown nodes use."""
    for carrier in carriers:
        if any(lookup.scope.shows_node(endpoint.node) for endpoint in (*carrier.writers, *carrier.readers)):
            yield drop_unknown(
                {
                    "name": name_on_medium(carrier),
                    "medium": None if carrier.medium == ROS else carrier.medium,
                    "flow": carrier.flow,
                    "messages": list(carrier.messages),
                    "types": list(carrier.types),
                    "writers": list(dict.fromkeys(endpoint.node for endpoint in carrier.writers)),
                    "readers": list(dict.fromkeys(endpoint.node for endpoint in carrier.readers)),
                    "size": record_quantity(carrier.size, "B"),
                }
            )


def record_endpoints(lookup: Lookup, node_id: str) -> list[dict[str, object]]:
    """Return what a node uses over ROS; who generates launch files from it knows nothing else."""
    endpoints = lookup.endpoints_of.get(node_id, ())
    return [_record_endpoint(endpoint) for endpoint in endpoints if endpoint.medium == ROS]


def _record_endpoint(endpoint: Endpoint) -> dict[str, object]:
    return drop_unknown(
        {
            "use": endpoint.use,
            "name": endpoint.name,
            "own_name": endpoint.own_name,
            "flow": endpoint.flow,
            "message": endpoint.message,
            "type": endpoint.type,
            "port": endpoint.port,
            "internal": endpoint.internal or None,
            "sources": list(endpoint.sources),
            "qos": _record_qos(endpoint.qos) if endpoint.flow == "topic" else None,
        }
    )


def _record_qos(qos: Qos) -> dict[str, object]:
    durations = {key: record_quantity(getattr(qos, key), "ns") for key in ("deadline", "lifespan", "lease_duration")}
    # All other fields, so a new field of Qos gets into the record without a line here.
    plain_fields = {k: v for k, v in asdict(qos).items() if k not in {*durations, "at", "written"}}
    return drop_unknown(plain_fields | durations)
