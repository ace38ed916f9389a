"""Bring values into normal form for comparing, and into plain data for output."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.path_resolver import title_from_id
from archgen.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class BooleanValue:
    """A parameter that is true or false; to Python these would be equal to 1 and 0."""

    is_true: bool


@dataclass(frozen=True, slots=True)
class ElementTitle:
    """A title; a generated one is made from the id and follows it."""

    text: str
    generated: bool


def normalize_title(element_name: str, text: str) -> ElementTitle:
    """Return the title of an element in normal form. A written title equal to the generated one counts as generated."""
    return ElementTitle(text, text in {title_from_id(element_name), element_name})


def normalize_text(text: str | None) -> str | None:
    """Return a text without line endings of its file and trailing blanks; None for an empty one."""
    # Short cut for most texts, one line of ASCII.
    if text is None or (text.isascii() and "\n" not in text and "\r" not in text):
        return (text or "").strip() or None
    lines = (line.rstrip() for line in text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))
    return "\n".join(lines).strip() or None


def unordered_values(values: Iterable[str]) -> frozenset[str]:
    """Return a list whose order is irrelevant as a set."""
    return frozenset(values)


def is_unset(value: object) -> bool:
    """Whether a key with this value has none: what is false or zero is a value."""
    return value is None or value in (frozenset(), ())


def parameter_leaves(prefix: str, value: object) -> Iterator[tuple[str, object]]:
    """Yield the leaves of a parameter with their paths below `prefix`."""
    if isinstance(value, Mapping) and value:
        for key, inner_value in value.items():
            yield from parameter_leaves(f"{prefix}.{key}", inner_value)
    elif isinstance(value, Mapping):
        # An empty mapping is a leaf: it differs from no parameter at all.
        yield prefix, "{}"
    else:
        yield prefix, freeze_value(value)


def list_data_leaves(prefix: str, data: object) -> Iterator[tuple[str, object]]:
    """Yield the leaves of data with their paths below `prefix`, lists as they are."""
    if isinstance(data, Mapping) and data:
        for key, inner_data in data.items():
            yield from list_data_leaves(f"{prefix}.{key}", inner_data)
    else:
        yield prefix, "{}" if isinstance(data, Mapping) else data


def freeze_value(value: object) -> object:
    """Return the value of a parameter so that equal ones compare equal, and true differs from 1."""
    if isinstance(value, list):
        return tuple(freeze_value(item) for item in value) or "[]"
    if isinstance(value, Mapping):
        return tuple((key, freeze_value(item)) for key, item in value.items())
    if isinstance(value, bool):
        return BooleanValue(value)
    return "null" if value is None else value


def to_plain_data(value: object) -> object:
    """Return a value as plain data: quantities as text, sets as sorted lists."""
    if isinstance(value, (Quantity, ElementTitle)):
        return value.text
    if isinstance(value, Fraction):
        return int(value) if value.denominator == 1 else float(value)
    if isinstance(value, frozenset):
        return sorted(value)
    if isinstance(value, BooleanValue):
        return value.is_true
    if isinstance(value, tuple):
        return [to_plain_data(item) for item in value]
    return value


def last_part(path: str, part_count: int = 1) -> str:
    """Return the last parts of a path."""
    return ".".join(path.split(".")[-part_count:])
