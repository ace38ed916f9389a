"""In which files an element stands: every slice of it, not only the first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.link import reading
from archgen.syntax.tree import Listing, Table, Value

Places = Mapping[tuple[str, str], tuple[str, ...]]
"""Files by sort (`group`, `component`, `node`) and complete id, in order of appearance."""


def places(merged: Table) -> Places:
    """Give the files of every group, component and node. A group's components stand for themselves."""
    found: dict[tuple[str, str], tuple[str, ...]] = {}
    for name, entry, below in reading.elements(merged, "groups"):
        own = [part.value for part in below if part.key != "components"]
        components = reading.table(below, "components")
        for part in components:
            found["component", f"{name}.{part.key}"] = _files(part.at.file, part.value)
        found["group", name] = _files("" if components and not own else entry.at.file, *own)
    for name, entry, below in reading.elements(merged, "nodes"):
        found["node", name] = _files(entry.at.file, below)
    return found


def _files(first: str, *values: Value) -> tuple[str, ...]:
    return tuple(dict.fromkeys(file for file in (first, *(each for value in values for each in _all(value))) if file))


def _all(value: Value) -> Iterator[str]:
    """Name the file of every value below; merged mappings hold parts of several files."""
    if isinstance(value, Table):
        for entry in value:
            yield entry.at.file
            yield from _all(entry.value)
    elif isinstance(value, Listing):
        yield from (item.at.file for item in value.items)
    else:
        yield value.at.file
