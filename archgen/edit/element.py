"""The element to be written, as the lines of a block or in braces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from archgen.emit.yaml import flow, scalar

Value = str | tuple[str, ...] | Mapping[str, "Value"] | None


@dataclass(frozen=True, slots=True)
class Element:
    """An id and its body. `hints` are comments behind keys that are still empty: what belongs there."""

    id: str
    body: Mapping[str, Value]
    hints: Mapping[str, str] = field(default_factory=dict)

    def below(self, keys: tuple[str, ...]) -> Element:
        """Return the element nested in mappings that are not written yet."""
        found = self
        for key in reversed(keys):
            found = Element(key, {found.id: found.body}, found.hints)
        return found

    @property
    def data(self) -> object:
        """The body as a parser reads it back."""
        return _data(self.body)

    def inline(self) -> Element:
        """Return the element as it is written in braces, where a key cannot be left empty."""
        return Element(self.id, {key: value for key, value in self.body.items() if value is not None})

    def lines(self, indent: str, unit: int) -> list[str]:
        """Write the element as the lines of a block."""
        return list(_block(self.id, self.body, indent, " " * unit, self.hints))

    def flow(self) -> str:
        """Write the element in braces, on one line."""
        return f"{scalar(self.id)}: {flow(self.body)}"


def _data(value: Value) -> object:
    if isinstance(value, Mapping):
        return {key: _data(inner) for key, inner in value.items()}
    return list(value) if isinstance(value, tuple) else value


def _block(key: str, value: Value, indent: str, unit: str, hints: Mapping[str, str]) -> Iterator[str]:
    if isinstance(value, Mapping) and value:
        yield f"{indent}{scalar(key)}:"
        for inner, below in value.items():
            yield from _block(inner, below, indent + unit, unit, hints)
    elif value is None:
        hint = f"  # {hints[key]}" if key in hints else ""
        yield f"{indent}{scalar(key)}:{hint}"
    else:
        yield f"{indent}{scalar(key)}: {flow(value)}"
