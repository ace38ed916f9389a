"""Find the files in which an element is written: every slice of it, not only the first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.link import reading
from archgen.syntax.tree import Listing, Table, Value

Places = Mapping[tuple[str, str], tuple[str, ...]]
"""Files by kind (`group`, `component`, `node`) and complete id, in order of appearance."""


def places(merged: Table) -> Places:
    """Return the files of every group, component and node; those of its components do not count for a group."""
    found: dict[tuple[str, str], tuple[str, ...]] = {}
    for name, entry, below in reading.elements(merged, "groups"):
        own = [part.value for part in below if part.key != "components"]
        components = reading.table(below, "components")
        for part in components:
            found["component", f"{name}.{part.key}"] = _files(part.at.file, part.value)
        # A file that only adds components to a group writes the group's id too, but nothing about the group.
        found["group", name] = _files("" if components and not own else entry.at.file, *own)
    for name, entry, below in reading.elements(merged, "nodes"):
        found["node", name] = _files(entry.at.file, below)
    return found


def _files(first: str, *values: Value) -> tuple[str, ...]:
    return tuple(dict.fromkeys(file for file in (first, *(each for value in values for each in _all(value))) if file))


def _all(value: Value) -> Iterator[str]:
    """Yield the file of every value below; a merged mapping holds entries of several files, a list only one file's."""
    if isinstance(value, Table):
        for entry in value:
            yield entry.at.file
            yield from _all(entry.value)
    elif isinstance(value, Listing):
        yield from (item.at.file for item in value.items)
    else:
        yield value.at.file
