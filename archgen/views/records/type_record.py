"""A conceptual type in the resolved record: its mapping, and the fields that make its message."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.model.known_interfaces import InterfaceField, Interfaces
from archgen.model.message_types import ConceptualType, DataField
from archgen.views.records.promise_record import record_life
from archgen.views.records.record_values import drop_unknown, pick_fields, record_quantity

_PART_NAMES = {"request": ("request", "goal"), "response": ("response", "result"), "feedback": ("feedback",)}
"""What definitions of services and actions call the parts."""


def record_type(conceptual_type: ConceptualType, interfaces: Interfaces) -> dict[str, object]:
    """Return a type. A field has what it holds in the project's words (`type`) and in those of ROS (`ros_type`)."""
    definition = interfaces.definitions.get(conceptual_type.message or "") if conceptual_type.has_content else None
    ros_fields = (
        {
            (part, field.name): field
            for part, fields in zip(definition.part_names, definition.parts, strict=True)
            for field in fields
        }
        if definition
        else {}
    )
    parts = {part: _record_fields(fields, part, ros_fields) for part, fields in conceptual_type.part_fields.items()}
    constants = {each.name: pick_fields(each, "type", "value", "comment") for each in conceptual_type.constants}
    keys = ("message", "comment", "status", "request", "response", "feedback", "frame", "values", "generic")
    return pick_fields(conceptual_type, *keys) | drop_unknown(
        {
            **record_life(conceptual_type),
            "size": record_quantity(conceptual_type.size, "B"),
            "fields": _record_fields(conceptual_type.fields or (), "", ros_fields),
            "part_fields": parts,
            "constants": constants,
        }
    )


def _record_fields(
    fields: Iterable[DataField], part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]
) -> list[dict[str, object]]:
    return [_record_field(field, part, ros_fields) for field in fields]


def _record_field(
    field: DataField, part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]
) -> dict[str, object]:
    names = _PART_NAMES.get(part, ("",))
    ros_field = next((ros_fields[name, field.name] for name in names if (name, field.name) in ros_fields), None)
    ros_type = f"{ros_field.type}{ros_field.array}" if ros_field else None
    return pick_fields(field, "name", "type", "default", "unit", "comment") | drop_unknown({"ros_type": ros_type})
