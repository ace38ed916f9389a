"""What a YAML file says: mappings, lists and scalars, each with its place. Made in one walk over the parser's events."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import dataclass
from archgen.source import Span

Plain = str | int | float | bool | None


@dataclass(slots=True)
class Scalar:
    """A scalar. `text` is what was written (blocks and quotes resolved); `value` what the YAML 1.2 core schema makes of it
    (quoted and block scalars are text; an empty plain scalar, `~` and `null` are None).
    """

    value: Plain
    text: str
    at: Span
    plain: bool = True


@dataclass(slots=True)
class Listing:
    """A list."""

    items: list[Value]
    at: Span


@dataclass(slots=True)
class Entry:
    """One key of a mapping with its value. `at` is the key's place."""

    key: str
    at: Span
    value: Value


@dataclass(slots=True)
class Table:
    """A mapping, in the order in which it was written."""

    entries: dict[str, Entry]
    at: Span

    def get(self, key: str) -> Value | None:
        """Give the value at a key, or None."""
        entry = self.entries.get(key)
        return entry.value if entry else None

    def __iter__(self) -> Iterator[Entry]:
        """Give the entries in order."""
        return iter(self.entries.values())


Value = Scalar | Listing | Table


@dataclass(frozen=True, slots=True)
class Ignore:
    """A comment `# archgen: ignore[rule, other] why`, and the rules that it names."""

    rules: tuple[str, ...]
    why: str
    at: Span


@dataclass(slots=True)
class Document:
    """One file, read."""

    file: str
    root: Table
    ignores: tuple[Ignore, ...] = ()


def plain(value: Value) -> object:
    """Turn a tree into dicts, lists and scalars, as the core schema reads them."""
    if isinstance(value, Table):
        return {entry.key: plain(entry.value) for entry in value}
    if isinstance(value, Listing):
        return [plain(item) for item in value.items]
    return value.value
