"""What a type says of its message: its fields as tables and as lines, its values, its type parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import InterfaceConstant
from archgen.model.message_types import ConceptualType, DataConstant, DataField, full_message_name
from archgen.views import inline_text
from archgen.views.element_references import message_link
from archgen.views.shapes import Column, Inlines, Table, Text, drop_empty_columns, make_columns

_PART_TITLES = {"request": "Request", "response": "Answer", "feedback": "Feedback"}


def make_field_tables(architecture: Architecture, conceptual_type: ConceptualType) -> Iterator[Table]:
    """Yield the fields of a type in the project's words, those of a service or an action part by part."""
    name = conceptual_type.name
    parts = [("", conceptual_type.fields or ()), *conceptual_type.part_fields.items()]
    for part, fields in parts:
        if fields:
            caption = f"{_PART_TITLES[part]}: fields" if part else "Fields"
            yield _make_field_table(architecture, fields, f"table:type_fields/{name}/{part}", caption)
    if conceptual_type.constants:
        yield make_constant_table(conceptual_type.constants, f"table:type_constants/{name}")


def _make_field_table(architecture: Architecture, fields: Iterable[DataField], anchor: str, caption: str) -> Table:
    rows = tuple(
        (
            inline_text.to_code(field.name),
            _type_cell(architecture, field),
            inline_text.to_inlines(Text(format_default(field), code=True)) if field.default is not None else (),
            inline_text.to_inlines(field.unit),
            inline_text.to_inlines(field.comment),
        )
        for field in fields
    )
    columns = make_columns(("Field", 1.2), ("Type", 1.5), ("Default", 0.6), ("Unit", 0.5), ("Meaning", 2))
    return drop_empty_columns(Table(anchor, caption, columns, rows))


def _type_cell(architecture: Architecture, field: DataField) -> Inlines:
    """Return the type of a field: a link where it is a conceptual type or a message."""
    if field.element_type in architecture.types:
        return (*inline_text.type_link(field.element_type), Text(field.array))
    message = full_message_name(field.element_type)
    if message:
        return (message_link(message), Text(field.array))
    return inline_text.to_code(field.type) or inline_text.UNKNOWN_INLINES


def make_constant_table(
    constants: Iterable[DataConstant | InterfaceConstant], anchor: str, caption: str = "Constants"
) -> Table:
    """List the constants of a type or of a message."""
    rows = tuple(
        (
            inline_text.to_code(each.name),
            inline_text.to_code(each.value),
            inline_text.to_code(each.type),
            inline_text.to_inlines(each.comment),
        )
        for each in constants
    )
    columns = (Column("Constant", 1.2), Column("Value", 0.8), Column("Type", 0.7), Column("Meaning", 2))
    return drop_empty_columns(Table(anchor, caption, columns, rows))


def list_field_lines(conceptual_type: ConceptualType) -> Iterator[str]:
    """Yield the fields and constants of a type as text: `request.gain: float64 = 0.5 [1/s]`."""
    for part, field in conceptual_type.list_fields():
        name = f"{part}.{field.name}" if part else field.name
        default = f" = {format_default(field)}" if field.default is not None else ""
        yield " ".join(filter(None, (f"{name}: {field.type or '?'}{default}", field.meaning)))
    for each in conceptual_type.constants:
        yield " ".join(filter(None, (f"{each.name}: {each.type} = {each.value}", each.comment)))


def format_default(field: DataField) -> str:
    """Return the default of a field as the project writes it; empty without one."""
    if isinstance(field.default, tuple):
        return f"[{', '.join(field.default)}]"
    return field.default or ""


def describe_content(conceptual_type: ConceptualType) -> Iterator[str]:
    """Yield what a line on a type says of its message: the values of an enumeration, the type parameters."""
    if conceptual_type.values:
        yield f"one of {', '.join(conceptual_type.values)}"
    if conceptual_type.generic:
        yield f"generic in {', '.join(conceptual_type.generic)}"
