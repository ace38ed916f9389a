"""Read values off a mapping in normal form. What is missing, or of an unexpected kind, reads as not written.

Types are compared with `type(...) is`, not isinstance: these functions run for every key of every element.
"""

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
    """Return the mapping at a key, an empty one where there is none."""
    entry = of.entries.get(key)
    return entry.value if entry is not None and type(entry.value) is Table else NOTHING


def body(entry: Entry) -> Table:
    """Return an element's body: the mapping at its key, an empty one where there is none."""
    return entry.value if type(entry.value) is Table else NOTHING


def scalar(of: Table, key: str) -> Scalar | None:
    """Return the scalar at a key, None where nothing is written."""
    entry = of.entries.get(key)
    if entry is None:
        return None
    found = entry.value
    return found if type(found) is Scalar and found.value is not None else None


def text(of: Table, key: str) -> str | None:
    """Return the text at a key as it was written (`1.10` is not 1.1), None where nothing is written."""
    # The same as get_scalar(...).text, without the second call: the most frequent function of linking.
    entry = of.entries.get(key)
    if entry is None:
        return None
    found = entry.value
    return found.text if type(found) is Scalar and found.value is not None else None


def scalars(of: Table, key: str) -> tuple[Scalar, ...]:
    """Return the scalars of a list; a single scalar counts as a list of one."""
    found = of.get(key)
    if type(found) is Listing:
        return tuple(item for item in found.items if type(item) is Scalar and item.value is not None)
    return (found,) if type(found) is Scalar and found.value is not None else ()


def texts(of: Table, key: str) -> tuple[str, ...]:
    """Return the texts of a list."""
    return tuple(item.text for item in scalars(of, key))


def whole(of: Table, key: str) -> int | None:
    """Return a whole number, None for any other value."""
    found = scalar(of, key)
    return found.value if found and type(found.value) is int else None


def flag(of: Table, key: str) -> bool:
    """Whether the value at a key is `true`."""
    found = scalar(of, key)
    return found is not None and found.value is True


def measure(of: Table, key: str, dimension: str) -> Quantity | None:
    """Return a quantity of a dimension such as `duration`, None where it is not written or malformed."""
    found = scalar(of, key)
    return quantity.parse(found.text, dimension) if found else None


def place(of: Table, key: str) -> Span:
    """Return the span of the value at a key, `NOWHERE` where it is not written."""
    entry = of.entries.get(key)
    return entry.value.at if entry else NOWHERE


def words(of: Table, key: str) -> Mapping[str, str]:
    """Return a mapping of texts, such as `urls`."""
    found = table(of, key)
    return {e.key: e.value.text for e in found if type(e.value) is Scalar and e.value.value is not None}


def elements(of: Table, key: str) -> Iterator[tuple[str, Entry, Table]]:
    """Yield the elements of a section: id, entry and body."""
    for entry in table(of, key):
        yield entry.key, entry, body(entry)


def layout(of: Table) -> Layout:
    """Return an element's layout."""
    direction = text(table(of, "layout"), "direction")
    return Layout(direction) if direction in {"left-right", "top-bottom"} else Layout()  # type: ignore[arg-type]


def title(of: Table, name: str) -> str:
    """Return an element's title, made from its id if it has none: `object_recognition` is "Object Recognition"."""
    written = text(of, "title")
    return written if written is not None else made_title(name)


@lru_cache(4096)
def type_name(written: str) -> str:
    """Return a type's name in the form in which names are compared: NFC, blanks folded to one, messages in full."""
    folded = _BLANKS.sub(" ", unicodedata.normalize("NFC", written)).strip()
    return full_message(folded) or folded


def message(of: Table) -> str | None:
    """Return the full name of the message that an element names, None where there is none."""
    written = text(of, "message")
    return None if written is None else full_message(written.strip())
