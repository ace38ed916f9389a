"""Messages that carry their sender: which ports of a program have such, and whom each node listens to."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.model.architecture import Architecture
from archgen.model.message_types import ConceptualType, full_message_name
from archgen.model.node import Endpoint

ANYBODY = "*"
"""Who may send where the architecture names nobody."""
_FIELDS = {"sender", "payload"}


def record_envelope(architecture: Architecture, endpoints: Sequence[Endpoint]) -> dict[str, object] | None:
    """Return what a port of a program knows of the envelopes of its messages; None where they are none.

    `payload` says what is in one, `senders` the full names of the nodes to listen to, by the full name of each node of the
    program that reads.
    """
    first = endpoints[0]
    data_type = architecture.types.get(first.type or "")
    if first.flow != "topic" or data_type is None or not is_envelope(data_type):
        return None
    payload_type = next(each.type or "" for each in data_type.fields or () if each.name == "payload")
    payload = architecture.types.get(payload_type)
    message = (payload.message if payload else None) or full_message_name(payload_type)
    senders = {}
    for endpoint in endpoints:
        if endpoint.use == "subscribes":
            senders[architecture.nodes[endpoint.node].full_name] = _list_senders(architecture, endpoint)
    return {"payload": message or payload_type, "senders": senders}


def is_envelope(data_type: ConceptualType) -> bool:
    """Whether messages of a type carry their sender: it has the fields `sender`, a text, and `payload`, and no others."""
    fields = {each.name: each.type for each in data_type.fields or ()}
    return fields.keys() == _FIELDS and fields["sender"] == "string"


def _list_senders(architecture: Architecture, endpoint: Endpoint) -> list[str]:
    topic = architecture.topics.get(endpoint.label)
    writers = topic.writers if topic else ()
    nodes = [architecture.nodes[each.node].full_name for each in writers if each.port in endpoint.sources]
    return sorted(set(nodes)) or [ANYBODY]
