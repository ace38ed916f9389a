"""Values in normal form, and as plain data."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from archgen.model.names import made_title
from archgen.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Flag:
    """A parameter that is true or false; to Python these are 1 and 0."""

    on: bool


@dataclass(frozen=True, slots=True)
class Title:
    """A title; one that nobody wrote is made from the id, and follows it."""

    text: str
    made: bool


def title(name: str, text: str) -> Title:
    """Give the title of an element."""
    return Title(text, text in {made_title(name), name})


def prose(text: str | None) -> str | None:
    """Give a text without what its form in the file adds: line ends, and blanks at the end of lines and of the text."""
    if text is None or (text.isascii() and "\n" not in text and "\r" not in text):
        return text and (text.strip() or None)
    lines = (line.rstrip() for line in text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))
    return "\n".join(lines).strip() or None


def words(values: Iterable[str]) -> frozenset[str]:
    """Give a list of which the order says nothing."""
    return frozenset(values)


def known(values: Mapping[str, object]) -> dict[str, object]:
    """Leave out what nobody said."""
    return {key: value for key, value in values.items() if value is not None and value not in (frozenset(), ())}


def leaves(prefix: str, value: object) -> Iterator[tuple[str, object]]:
    """Give what a parameter holds, leaf by leaf."""
    if isinstance(value, Mapping) and value:
        for key, below in value.items():
            yield from leaves(f"{prefix}.{key}", below)
    elif isinstance(value, Mapping):
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
    """Give a value as plain data: quantities as text, sets as sorted lists."""
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
