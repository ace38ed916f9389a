"""How the fields of conceptual types are read for comparing.

What a type with fields sends is compared as the definition of its message. Here is what no definition says: that a field
holds another conceptual type with the same message, and what is in a generic type, which is no message by itself.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.kinds.key_spec import ReadContext
from archgen.model.message_types import ConceptualType, DataField


def is_own_type(conceptual_type: ConceptualType) -> bool:
    """Whether the project declares a type."""
    return conceptual_type.origin == "project" and bool(conceptual_type.at.file)


def read_fields(conceptual_type: ConceptualType, context: ReadContext) -> Mapping[str, str]:
    """Return the conceptual types that fields hold, by the field; of a generic type all that is written."""
    if not is_own_type(conceptual_type):
        return {}
    types = context.architecture.types
    values = {
        f"{part}.{field.name}" if part else field.name: _describe_field(field, context)
        for part, field in conceptual_type.list_fields()
        if conceptual_type.generic or field.element_type in types
    }
    if conceptual_type.generic:
        values |= {each.name: f"{each.type} {each.value}" for each in conceptual_type.constants}
        values |= {name: str(number) for number, name in enumerate(conceptual_type.values)}
    return values


def _describe_field(field: DataField, context: ReadContext) -> str:
    if field.element_type in context.architecture.types:
        return f"{context.common_id('type', field.element_type)}{field.array}"
    default = field.default if isinstance(field.default, str | None) else f"[{', '.join(field.default)}]"
    return " ".join(filter(None, (field.type, default, field.meaning)))
