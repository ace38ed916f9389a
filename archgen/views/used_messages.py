"""The messages, services and actions in use: those of types and topics, and the messages inside of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import InterfaceField
from archgen.model.message_types import ConceptualType
from archgen.model.node import Topic


def collect_messages(
    architecture: Architecture, types: Iterable[ConceptualType], topics: Iterable[Topic]
) -> dict[str, tuple[str, ...]]:
    """Return the messages that these types and topics use, and those inside of them, with the anchors of who uses each."""
    users: defaultdict[str, list[str]] = defaultdict(list)
    for conceptual_type in types:
        if conceptual_type.message:
            users[conceptual_type.message].append(f"type:{conceptual_type.name}")
    for topic in topics:
        for message in topic.messages:
            users[message].append(f"topic:{topic.name}")
    # A message that another one contains is used where that one is. The list grows while it is walked.
    pending = list(users)
    for message in pending:
        for field in list_fields(architecture, message):
            if "/" in field.type and field.type not in users:
                users[field.type] = list(users[message])
                pending.append(field.type)
    return {message: tuple(anchors) for message, anchors in users.items()}


def list_fields(architecture: Architecture, message: str) -> tuple[InterfaceField, ...]:
    """Return the fields of all parts of a message; none where its definition is not at hand."""
    definition = architecture.interfaces.definitions.get(message)
    return tuple(field for part in definition.parts for field in part) if definition else ()
