"""The fields of the messages that a program sends and takes, as far as the project says them: own code names them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.plugin.model import Architecture, ConceptualType

_PARTS: Mapping[str, Mapping[str, str]] = {
    "srv": {"request": "/Request", "response": "/Response"},
    "action": {"request": "/Goal", "response": "/Result", "feedback": "/Feedback"},
}
"""The classes of a service's and an action's parts, behind its own."""


def list_message_fields(architecture: Architecture, type_names: Iterable[str]) -> list[dict[str, str]]:
    """Return the fields of types and of what is in them: each with its message in front, and with the message that it is, if any."""
    fields: dict[str, str] = {}
    waiting, seen = sorted(type_names), set[str]()
    while waiting:
        type_name = waiting.pop()
        data_type = architecture.types.get(type_name)
        if data_type is None or type_name in seen or not data_type.message:
            continue
        seen.add(type_name)
        for class_name, name, inner_name in _list_fields(data_type, data_type.message):
            inner = architecture.types.get(inner_name)
            fields[f"{class_name}.{name}"] = (inner.message if inner else None) or ""
            waiting.append(inner_name)
    return [{"name": name, "message": message} for name, message in sorted(fields.items())]


def _list_fields(data_type: ConceptualType, message: str) -> Iterator[tuple[str, str, str]]:
    """Yield each field of a type: its class, its name, and its type, without what makes a list of it."""
    parts = _PARTS.get(message.split("/")[1], {})
    for part, each in data_type.list_fields():
        yield f"{message}{parts.get(part, '')}", each.name, (each.type or "").partition("[")[0]
