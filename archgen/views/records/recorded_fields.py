"""The fields of conceptual types for the resolved record: in the project's words, and in those of ROS."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.frozen import dataclass
from archgen.model.known_interfaces import InterfaceField
from archgen.model.message_types import ConceptualType, DataField
from archgen.views.lookup import Lookup

_PART_NAMES = {"request": ("request", "goal"), "response": ("response", "result"), "feedback": ("feedback",)}
"""What definitions of services and actions call the parts."""


@dataclass(frozen=True, slots=True)
class RecordedField:
    """A field with what it holds in the project's words (`type`) and in those of ROS (`ros_type`)."""

    name: str
    type: str | None
    default: str | tuple[str, ...] | None
    unit: str | None
    comment: str | None
    ros_type: str | None


def list_type_fields(conceptual_type: ConceptualType, lookup: Lookup) -> list[RecordedField]:
    """Return the fields that make the message of a type."""
    return _list_recorded(conceptual_type.fields or (), "", _find_ros_fields(conceptual_type, lookup))


def list_part_fields(conceptual_type: ConceptualType, lookup: Lookup) -> dict[str, list[RecordedField]]:
    """Return the fields of the parts of a service or an action, by part."""
    ros_fields = _find_ros_fields(conceptual_type, lookup)
    return {part: _list_recorded(fields, part, ros_fields) for part, fields in conceptual_type.part_fields.items()}


def _find_ros_fields(conceptual_type: ConceptualType, lookup: Lookup) -> Mapping[tuple[str, str], InterfaceField]:
    """Return the fields of the type's message by part and name."""
    definitions = lookup.architecture.interfaces.definitions
    definition = definitions.get(conceptual_type.message or "") if conceptual_type.has_content else None
    if definition is None:
        return {}
    return {
        (part, field.name): field
        for part, fields in zip(definition.part_names, definition.parts, strict=True)
        for field in fields
    }


def _list_recorded(
    fields: Iterable[DataField], part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]
) -> list[RecordedField]:
    return [_record_field(field, part, ros_fields) for field in fields]


def _record_field(field: DataField, part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]) -> RecordedField:
    names = _PART_NAMES.get(part, ("",))
    ros_field = next((ros_fields[name, field.name] for name in names if (name, field.name) in ros_fields), None)
    ros_type = f"{ros_field.type}{ros_field.array}" if ros_field else None
    return RecordedField(field.name, field.type, field.default, field.unit, field.comment, ros_type)
