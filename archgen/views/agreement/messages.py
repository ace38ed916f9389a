"""The fields of a message, nested by one level, as far as archgen has the definitions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from archgen.model.interfaces import Field, Interfaces
from archgen.views import words
from archgen.views.shapes import Column, Table, Text

_PARTS = {"msg": ("",), "srv": ("request", "answer"), "action": ("goal", "result", "feedback")}


@dataclass(frozen=True, slots=True)
class Row:
    """A field: the part of a service or action that it is in, its name (`header.stamp`), its type, and a remark."""

    part: str
    name: str
    type: str
    remark: str = ""

    @property
    def path(self) -> str:
        """Return the field's name with its part: `request.header.stamp`."""
        return f"{self.part}.{self.name}" if self.part else self.name


def rows(interfaces: Interfaces, message: str) -> tuple[Row, ...] | None:
    """Return the fields of `pkg/msg/Name`, None if archgen has no definition of it."""
    found = interfaces.definitions.get(message)
    if found is None:
        return None
    parts = _PARTS[message.split("/")[1]]
    named = zip(parts, found.parts, strict=True)
    return tuple(row for part, fields in named for each in fields for row in _nested(interfaces, part, each))


def _nested(interfaces: Interfaces, part: str, each: Field) -> Iterator[Row]:
    inner = interfaces.definitions.get(each.type)
    unheld = "/" in each.type and inner is None
    yield Row(part, each.name, each.type + each.array, "definition not held" if unheld else "")
    for below in inner.parts[0] if inner else ():
        yield Row(part, f"{each.name}{'[]' if each.array else ''}.{below.name}", below.type + below.array)


def table(message: str, found: tuple[Row, ...]) -> Table:
    """Return the fields as a table."""
    parts = any(row.part for row in found)
    columns = (Column("Field", 1.4), Column("Type", 1.6))
    cells = tuple(
        (
            *((words.text(row.part),) if parts else ()),
            words.text(Text(row.name, code=True)),
            words.text(Text(row.type, code=True), *([Text(f" {row.remark}", muted=True)] if row.remark else [])),
        )
        for row in found
    )
    shown = (Column("Part", 0.5), *columns) if parts else columns
    return Table(f"table:fields/{message}", f"Fields of {message}", shown, cells)
