"""The tree of a YAML file: mappings, sequences and scalars, each with its span. Built by `yaml_parser` in one walk.

Nodes are mutable: validation takes wrong values out of the tree, and short forms are replaced in place.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import dataclass
from archgen.source import Span

Plain = str | int | float | bool | None


@dataclass(slots=True)
class Scalar:
    """A scalar. `text` is what was written, with quotes and blocks resolved.

    `value` is what YAML 1.2's core schema makes of it: quoted and block scalars are text; an empty plain scalar, `~`
    and `null` are None. `is_plain` is whether it was written without quotes and not as a block.
    """

    value: Plain
    text: str
    at: Span
    plain: bool = True


@dataclass(slots=True)
class Listing:
    """A sequence of nodes, in brackets or line by line."""

    items: list[Value]
    at: Span


@dataclass(slots=True)
class Entry:
    """One key of a mapping with its value. `key_span` is the span of the key alone."""

    key: str
    at: Span
    value: Value


@dataclass(slots=True)
class Table:
    """A mapping: its entries by key, in the order in which they were written."""

    entries: dict[str, Entry]
    at: Span

    def get(self, key: str) -> Value | None:
        """Return the value at a key, or None."""
        entry = self.entries.get(key)
        return entry.value if entry else None

    def __iter__(self) -> Iterator[Entry]:
        """Iterate over the entries (not the keys), in order."""
        return iter(self.entries.values())


Value = Scalar | Listing | Table


@dataclass(frozen=True, slots=True)
class Ignore:
    """A comment `# archgen: ignore[rule, other] why` with the rules that it names."""

    rules: tuple[str, ...]
    why: str
    at: Span


@dataclass(slots=True)
class Document:
    """One parsed file."""

    file: str
    root: Table
    ignores: tuple[Ignore, ...] = ()


def plain(value: Value) -> object:
    """Turn a tree into dicts, lists and plain values as the core schema reads them."""
    if isinstance(value, Table):
        return {entry.key: plain(entry.value) for entry in value}
    if isinstance(value, Listing):
        return [plain(item) for item in value.items]
    return value.value
