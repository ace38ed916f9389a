"""Bring values into normal form for comparing, and into plain data for output."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from archgen.model.names import made_title
from archgen.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Flag:
    """A parameter that is true or false; to Python these would be equal to 1 and 0."""

    on: bool


@dataclass(frozen=True, slots=True)
class Title:
    """A title; a generated one is made from the id and follows it."""

    text: str
    made: bool


def title(name: str, text: str) -> Title:
    """Return the title of an element in normal form. A written title equal to the generated one counts as generated."""
    return Title(text, text in {made_title(name), name})


def prose(text: str | None) -> str | None:
    """Return a text without line endings of its file and trailing blanks; None for an empty one."""
    # Short cut for most texts, one line of ASCII.
    if text is None or (text.isascii() and "\n" not in text and "\r" not in text):
        return text and (text.strip() or None)
    lines = (line.rstrip() for line in text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))
    return "\n".join(lines).strip() or None


def words(values: Iterable[str]) -> frozenset[str]:
    """Return a list whose order is irrelevant as a set."""
    return frozenset(values)


def known(values: Mapping[str, object]) -> dict[str, object]:
    """Drop the keys that have no value."""
    return {key: value for key, value in values.items() if value is not None and value not in (frozenset(), ())}


def leaves(prefix: str, value: object) -> Iterator[tuple[str, object]]:
    """Yield the leaves of a parameter with their paths below `prefix`."""
    if isinstance(value, Mapping) and value:
        for key, below in value.items():
            yield from leaves(f"{prefix}.{key}", below)
    elif isinstance(value, Mapping):
        # An empty mapping is a leaf: it differs from no parameter at all.
        yield prefix, "{}"
    else:
        yield prefix, _frozen(value)


def _frozen(value: object) -> object:
    if isinstance(value, list):
        return tuple(_frozen(item) for item in value) or "[]"
    if isinstance(value, Mapping):
        return tuple((key, _frozen(item)) for key, item in value.items())
    if isinstance(value, bool):
        return Flag(value)
    return "null" if value is None else value


def plain(value: object) -> object:
    """Return a value as plain data: quantities as text, sets as sorted lists."""
    if isinstance(value, (Quantity, Title)):
        return value.text
    if isinstance(value, Fraction):
        return int(value) if value.denominator == 1 else float(value)
    if isinstance(value, frozenset):
        return sorted(value)
    if isinstance(value, Flag):
        return value.on
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return value
