"""What a program publishes, subscribes to, serves and calls: its topics with their messages, settings and methods."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.bringup.program_names import choose_own_name, find_common_message, group_endpoints
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.code_names import PYTHON_KEYWORDS
from archgen.model.message_types import ConceptualType, full_message_name
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.quantity import Quantity
from archgen.views.generation.generation_context import tell_left_out, write_place

PORT_SECTIONS: Mapping[tuple[str, str], str] = {
    ("publishes", "topic"): "publishers",
    ("subscribes", "topic"): "subscriptions",
    ("serves", "service"): "services",
    ("calls", "service"): "clients",
    ("serves", "action"): "action_servers",
    ("calls", "action"): "action_clients",
}
"""The lists that a program has, by what it does and with what."""


def record_ports(
    architecture: Architecture, nodes: Sequence[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> tuple[dict[str, list[dict[str, object]]], list[Diagnostic]]:
    """Return what the nodes of one program use, by section, and what is left out.

    Nodes of one program use the same ports. Where their topics differ, the program has a name of its own for the port,
    which each node remaps.
    """
    sections: dict[str, list[dict[str, object]]] = {name: [] for name in PORT_SECTIONS.values()}
    findings: list[Diagnostic] = []
    for (use, flow, key), port_endpoints in group_endpoints(nodes, endpoints).items():
        if find_common_message(port_endpoints) is None:
            findings.append(_tell_unknown_message(port_endpoints[0], {each.message for each in port_endpoints}))
            continue
        if str(port_endpoints[0].message).rpartition("/")[2] in PYTHON_KEYWORDS:
            findings.append(_tell_bad_message(port_endpoints[0]))
            continue
        sections[PORT_SECTIONS[use, flow]].append(
            _record_port(architecture, key, port_endpoints, is_shared=len(nodes) > 1)
        )
    return sections, findings


def _tell_unknown_message(endpoint: Endpoint, messages: set[str | None]) -> Diagnostic:
    named = f"`{endpoint.port or endpoint.label}` of the node `{endpoint.node}`"
    if len(messages) > 1:
        shown = " and ".join(sorted(f"`{each}`" for each in messages if each))
        return tell_left_out(
            f"{named} is left out: nodes of one program use it with several messages, {shown or 'one of them unknown'}",
            endpoint.at,
            element=endpoint.node,
            help_line="give one of the nodes an `executable` of its own",
        )
    return tell_left_out(
        f"{named} is left out: nobody says which message it has",
        endpoint.at,
        element=endpoint.node,
        help_line="map its type to a message below `types`, or give the type `fields`",
    )


def _tell_bad_message(endpoint: Endpoint) -> Diagnostic:
    return tell_left_out(
        f"`{endpoint.port or endpoint.label}` of the node `{endpoint.node}` is left out: no class can be called as its "
        f"message `{endpoint.message}`",
        endpoint.at,
        element=endpoint.node,
        help_line="give its type another name, or another `message`",
    )


def _record_port(
    architecture: Architecture, key: str, endpoints: Sequence[Endpoint], *, is_shared: bool
) -> dict[str, object]:
    first = endpoints[0]
    package, kind, name = (first.message or "//").split("/")
    port = architecture.outputs.get(first.port or "") or architecture.inputs.get(first.port or "")
    if first.use in {"subscribes", "calls"}:
        port = architecture.inputs.get(first.port or "") or port
    data_type = architecture.types.get(first.type or "")
    return {
        "key": key,
        "topic": choose_own_name(key, endpoints, is_shared=is_shared),
        "topics": {each.node: each.name or "" for each in endpoints},
        "port": first.port or "",
        "internal": first.internal,
        "message": first.message,
        "package": package,
        "kind": kind,
        "name": name,
        "type": first.type or "",
        "description": (port.description if port else None) or (data_type.comment if data_type else None) or "",
        "sources": list(first.sources),
        "envelope": record_envelope(architecture, endpoints),
        "qos": record_qos(first.qos),
        "place": write_place(port.at if port else first.at),
    }


def record_qos(qos: Qos) -> dict[str, object]:
    """Return the settings of a topic as plain data: durations in ns, None where the middleware chooses."""
    return {
        "reliability": qos.reliability,
        "durability": qos.durability,
        "history": qos.history,
        "depth": qos.depth,
        "deadline_ns": _round_quantity(qos.deadline),
        "lifespan_ns": _round_quantity(qos.lifespan),
        "liveliness": qos.liveliness,
        "lease_duration_ns": _round_quantity(qos.lease_duration),
    }


def _round_quantity(quantity: Quantity | None) -> int | None:
    return None if quantity is None else round(quantity.value)


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
