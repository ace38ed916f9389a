"""The fields of a message, nested by one level, as far as archgen has the definitions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from archgen.model.known_interfaces import InterfaceField, Interfaces
from archgen.views import inline_text
from archgen.views.shapes import Column, Table, Text

_PART_NAMES = {"msg": ("",), "srv": ("request", "answer"), "action": ("goal", "result", "feedback")}


@dataclass(frozen=True, slots=True)
class FieldRow:
    """A field: the part of a service or action that it is in, its name (`header.stamp`), its type, and a remark."""

    part: str
    name: str
    type: str
    remark: str = ""

    @property
    def path(self) -> str:
        """Return the field's name with its part: `request.header.stamp`."""
        return f"{self.part}.{self.name}" if self.part else self.name


def list_field_rows(interfaces: Interfaces, message: str) -> tuple[FieldRow, ...] | None:
    """Return the fields of `pkg/msg/Name`, None if archgen has no definition of it."""
    definition = interfaces.definitions.get(message)
    if definition is None:
        return None
    parts = _PART_NAMES[message.split("/")[1]]
    named_parts = zip(parts, definition.parts, strict=True)
    return tuple(
        row for part, fields in named_parts for field in fields for row in _nested_rows(interfaces, part, field)
    )


def _nested_rows(interfaces: Interfaces, part: str, field: InterfaceField) -> Iterator[FieldRow]:
    inner_definition = interfaces.definitions.get(field.type)
    is_missing = "/" in field.type and inner_definition is None
    yield FieldRow(part, field.name, field.type + field.array, "definition not held" if is_missing else "")
    for inner_field in inner_definition.parts[0] if inner_definition else ():
        yield FieldRow(
            part, f"{field.name}{'[]' if field.array else ''}.{inner_field.name}", inner_field.type + inner_field.array
        )


def field_table(message: str, field_rows: tuple[FieldRow, ...]) -> Table:
    """Return the fields as a table."""
    has_parts = any(row.part for row in field_rows)
    columns = (Column("Field", 1.4), Column("Type", 1.6))
    cells = tuple(
        (
            *((inline_text.to_inlines(row.part),) if has_parts else ()),
            inline_text.to_inlines(Text(row.name, code=True)),
            inline_text.to_inlines(
                Text(row.type, code=True), *([Text(f" {row.remark}", muted=True)] if row.remark else [])
            ),
        )
        for row in field_rows
    )
    shown_columns = (Column("Part", 0.5), *columns) if has_parts else columns
    return Table(f"table:fields/{message}", f"Fields of {message}", shown_columns, cells)
