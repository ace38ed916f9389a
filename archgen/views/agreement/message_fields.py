"""The fields and constants of a message with what is said of them, nested by one level, as far as archgen has the
definitions.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import dataclass
from archgen.model.known_interfaces import InterfaceConstant, InterfaceField, Interfaces
from archgen.views import inline_text
from archgen.views.shapes import Column, Inlines, Table, Text

_PART_WORDS = {"response": "answer"}


@dataclass(frozen=True, slots=True)
class FieldRow:
    """A field or a constant: the part of a service or action that it is in, its name (`header.stamp`) and type.

    `value` is that of a constant, or the default of a field; `meaning` is what the definition says of it; `remark` is
    archgen's own.
    """

    part: str
    name: str
    type: str
    remark: str = ""
    value: str = ""
    meaning: str = ""

    @property
    def path(self) -> str:
        """Return the field's name with its part: `request.header.stamp`."""
        return f"{self.part}.{self.name}" if self.part else self.name

    @property
    def terms(self) -> str:
        """Return all that two partners agree on: type, value and meaning, on one line."""
        type_and_value = f"{self.type} = {self.value}" if self.value else self.type
        return f"{type_and_value}: {self.meaning}" if self.meaning else type_and_value


def list_field_rows(interfaces: Interfaces, message: str) -> tuple[FieldRow, ...] | None:
    """Return the fields of `pkg/msg/Name`, those of each part before its constants; None without a definition."""
    definition = interfaces.definitions.get(message)
    if definition is None:
        return None
    constants = definition.constants or ((),) * len(definition.parts)
    named_parts = zip(definition.part_names, definition.parts, constants, strict=True)
    return tuple(
        row
        for part, part_fields, part_constants in named_parts
        for row in (
            *(row for field in part_fields for row in _nested_rows(interfaces, _PART_WORDS.get(part, part), field)),
            *(_constant_row(_PART_WORDS.get(part, part), constant) for constant in part_constants),
        )
    )


def _constant_row(part: str, constant: InterfaceConstant) -> FieldRow:
    return FieldRow(part, constant.name, constant.type, value=constant.value, meaning=constant.comment)


def _nested_rows(interfaces: Interfaces, part: str, field: InterfaceField) -> Iterator[FieldRow]:
    inner_definition = interfaces.definitions.get(field.type)
    remark = "definition not at hand" if "/" in field.type and inner_definition is None else ""
    yield FieldRow(part, field.name, field.type + field.array, remark, field.default, field.comment)
    prefix = f"{field.name}{'[]' if field.array else ''}"
    for inner_field in inner_definition.parts[0] if inner_definition else ():
        yield FieldRow(
            part,
            f"{prefix}.{inner_field.name}",
            inner_field.type + inner_field.array,
            value=inner_field.default,
            meaning=inner_field.comment,
        )
    # Named by their message, as programs do: one value of it may stand in several fields.
    for constants in inner_definition.constants[:1] if inner_definition else ():
        for constant in constants:
            yield FieldRow(
                part, f"{prefix}.{constant.name}", constant.type, value=constant.value, meaning=constant.comment
            )


def field_table(message: str, field_rows: tuple[FieldRow, ...]) -> Table:
    """Return the fields and constants as a table. Columns in which nothing would stand are left out."""
    has_parts = any(row.part for row in field_rows)
    has_meanings = any(row.meaning for row in field_rows)
    columns = [Column("Part", 0.5)] if has_parts else []
    columns += [Column("Field", 1.4), Column("Type", 1.6)]
    columns += [Column("Meaning", 2.0)] if has_meanings else []
    cells = tuple(
        (
            *((inline_text.to_inlines(row.part),) if has_parts else ()),
            inline_text.to_code(row.name),
            _type_cell(row),
            *((inline_text.to_inlines(row.meaning),) if has_meanings else ()),
        )
        for row in field_rows
    )
    return Table(f"table:fields/{message}", f"Fields of {message}", tuple(columns), cells, numbered=False)


def _type_cell(row: FieldRow) -> Inlines:
    type_text = f"{row.type} = {row.value}" if row.value else row.type
    remark = [Text(f" {row.remark}", muted=True)] if row.remark else []
    return (field_type_run(row.type, type_text), *remark)


def field_type_run(field_type: str, text: str) -> Text:
    """Return the type of a field, written as `text`: a link where it is a message, or several (`pkg/msg/Name[]`)."""
    message = field_type.partition("[")[0]
    return Text(text, ref=f"message:{message}" if "/" in message else None, code=True)
