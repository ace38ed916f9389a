"""The element to be written, as the lines of a block or in braces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from archgen.syntax.yaml_writer import format_flow, format_scalar

ElementValue = str | tuple[str, ...] | Mapping[str, "ElementValue"] | None


@dataclass(frozen=True, slots=True)
class NewElement:
    """An id and its body. `hints` are comments behind keys that are still empty: what belongs there."""

    id: str
    body: Mapping[str, ElementValue]
    hints: Mapping[str, str] = field(default_factory=dict)

    def nested_below(self, keys: tuple[str, ...]) -> NewElement:
        """Return the element nested in mappings that are not written yet."""
        element = self
        for key in reversed(keys):
            element = NewElement(key, {element.id: element.body}, element.hints)
        return element

    @property
    def parsed_body(self) -> object:
        """The body as a parser reads it back."""
        return _parsed_value(self.body)

    def without_empty_keys(self) -> NewElement:
        """Return the element as it is written in braces, where a key cannot be left empty."""
        return NewElement(self.id, _drop_empty_keys(self.body))

    def to_block(self, indent: str, unit: int) -> list[str]:
        """Write the element as the lines of a block."""
        return list(_block_lines(self.id, self.body, indent, " " * unit, self.hints))

    def to_flow(self) -> str:
        """Write the element in braces, on one line."""
        return f"{format_scalar(self.id)}: {format_flow(self.body)}"


def _drop_empty_keys(body: Mapping[str, ElementValue]) -> dict[str, ElementValue]:
    """Return a body without keys that are empty, and without mappings in which all are."""
    compact_body = {
        key: _drop_empty_keys(value) if isinstance(value, Mapping) else value for key, value in body.items()
    }
    return {key: value for key, value in compact_body.items() if value is not None and value != {}}


def _parsed_value(value: ElementValue) -> object:
    if isinstance(value, Mapping):
        return {key: _parsed_value(inner) for key, inner in value.items()}
    return list(value) if isinstance(value, tuple) else value


def _block_lines(key: str, value: ElementValue, indent: str, unit: str, hints: Mapping[str, str]) -> Iterator[str]:
    if isinstance(value, Mapping) and value:
        yield f"{indent}{format_scalar(key)}:"
        for inner_key, inner_value in value.items():
            yield from _block_lines(inner_key, inner_value, indent + unit, unit, hints)
    elif value is None:
        hint = f"  # {hints[key]}" if key in hints else ""
        yield f"{indent}{format_scalar(key)}:{hint}"
    else:
        yield f"{indent}{format_scalar(key)}: {format_flow(value)}"
