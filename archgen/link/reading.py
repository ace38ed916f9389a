"""Read values off a normal-form table. What is missing, or of another kind than expected, reads as not written."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from functools import lru_cache

from archgen.model import quantity
from archgen.model.component import Layout
from archgen.model.mapping import full_message
from archgen.model.names import made_title
from archgen.model.quantity import Quantity
from archgen.source import NOWHERE, Span
from archgen.syntax.tree import Entry, Listing, Scalar, Table

NOTHING = Table({}, NOWHERE)
_BLANKS = re.compile(r"\s+")


def table(of: Table, key: str) -> Table:
    """Give the table at a key, an empty one where there is none."""
    entry = of.entries.get(key)
    return entry.value if entry is not None and type(entry.value) is Table else NOTHING


def body(entry: Entry) -> Table:
    """Give what stands below an element's key."""
    return entry.value if type(entry.value) is Table else NOTHING


def scalar(of: Table, key: str) -> Scalar | None:
    """Give the scalar at a key, None where nothing is written."""
    entry = of.entries.get(key)
    if entry is None:
        return None
    found = entry.value
    return found if type(found) is Scalar and found.value is not None else None


def text(of: Table, key: str) -> str | None:
    """Give a text as it was written."""
    entry = of.entries.get(key)
    if entry is None:
        return None
    found = entry.value
    return found.text if type(found) is Scalar and found.value is not None else None


def scalars(of: Table, key: str) -> tuple[Scalar, ...]:
    """Give the scalars of a list; one scalar counts as a list of one."""
    found = of.get(key)
    if type(found) is Listing:
        return tuple(item for item in found.items if type(item) is Scalar and item.value is not None)
    return (found,) if type(found) is Scalar and found.value is not None else ()


def texts(of: Table, key: str) -> tuple[str, ...]:
    """Give the texts of a list."""
    return tuple(item.text for item in scalars(of, key))


def whole(of: Table, key: str) -> int | None:
    """Give a whole number."""
    found = scalar(of, key)
    return found.value if found and type(found.value) is int else None


def flag(of: Table, key: str) -> bool:
    """Tell whether `true` stands at a key."""
    found = scalar(of, key)
    return found is not None and found.value is True


def measure(of: Table, key: str, dimension: str) -> Quantity | None:
    """Give a quantity of a dimension."""
    found = scalar(of, key)
    return quantity.parse(found.text, dimension) if found else None


def place(of: Table, key: str) -> Span:
    """Give where the value at a key stands."""
    entry = of.entries.get(key)
    return entry.value.at if entry else NOWHERE


def words(of: Table, key: str) -> Mapping[str, str]:
    """Give a mapping of texts, such as `urls`."""
    found = table(of, key)
    return {e.key: e.value.text for e in found if type(e.value) is Scalar and e.value.value is not None}


def elements(of: Table, key: str) -> Iterator[tuple[str, Entry, Table]]:
    """Give the elements of a section: id, entry, and what stands below."""
    for entry in table(of, key):
        yield entry.key, entry, body(entry)


def layout(of: Table) -> Layout:
    """Give an element's layout."""
    direction = text(table(of, "layout"), "direction")
    return Layout(direction) if direction in {"left-right", "top-bottom"} else Layout()  # type: ignore[arg-type]


def title(of: Table, name: str) -> str:
    """Give an element's title, made from its id where it has none: `object_recognition` is "Object Recognition"."""
    written = text(of, "title")
    return written if written is not None else made_title(name)


@lru_cache(4096)
def type_name(written: str) -> str:
    """Give a type's name: Unicode NFC, blanks folded to one; a message has its full name."""
    folded = _BLANKS.sub(" ", unicodedata.normalize("NFC", written)).strip()
    return full_message(folded) or folded


def message(of: Table) -> str | None:
    """Give the full name of the message written in an element."""
    written = text(of, "message")
    return None if written is None else full_message(written.strip())
