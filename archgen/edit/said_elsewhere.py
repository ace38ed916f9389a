"""What an import brings that the project says already: nothing stands in two files, and what differs is told."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from archgen.edit.slice_update import to_texts
from archgen.syntax.yaml_tree import YamlDocument

KeyPath = tuple[str, ...]


class SaidValue(NamedTuple):
    """A value of the project, and the file that says it."""

    value: object
    file: str


class LeftOut(NamedTuple):
    """A slice without what other files say: equal values are gone, `differences` are told, one line each."""

    data: dict[str, Any]
    differences: list[str]


def list_said_values(documents: Iterable[YamlDocument], own_files: frozenset[str]) -> dict[KeyPath, SaidValue]:
    """Return the values of a project by their paths, but for those of some files."""
    return {
        path: SaidValue(value, entry.key_span.file)
        for document in documents
        for entry in document.root
        if entry.key_span.file not in own_files
        for path, value in _list_leaves(to_texts(entry.value), (entry.key,))
    }


def leave_out_said(
    data: Mapping[str, Any], normal_data: Mapping[str, Any], said: Mapping[KeyPath, SaidValue]
) -> LeftOut:
    """Return a slice without the values that other files say. `normal_data` is what it says in normal form."""
    leaves_below: dict[KeyPath, list[tuple[KeyPath, object]]] = defaultdict(list)
    for path, value in _list_leaves(normal_data, ()):
        for end in range(1, len(path) + 1):
            leaves_below[path[:end]].append((path, value))
    differences: list[str] = []

    def leave_out(part: Mapping[str, Any], place: KeyPath) -> dict[str, Any]:
        kept: dict[str, Any] = {}
        for key, value in part.items():
            path = (*place, key)
            leaves = leaves_below[path]
            if isinstance(value, Mapping) and value:
                if inner := leave_out(value, path):
                    kept[key] = inner
            elif not leaves or any(leaf not in said for leaf, _ in leaves):
                kept[key] = value
            else:
                differences.extend(_describe_differences(leaves, said))
        return kept

    return LeftOut(leave_out(data, ()), differences)


def _describe_differences(leaves: Iterable[tuple[KeyPath, object]], said: Mapping[KeyPath, SaidValue]) -> Iterator[str]:
    for path, value in leaves:
        if str(said[path].value) != str(value):
            yield f"{'.'.join(path)}: `{said[path].value}` in {said[path].file}, `{value}` here"


def _list_leaves(value: object, path: KeyPath) -> Iterator[tuple[KeyPath, object]]:
    """Yield what is written once in a project: all that is no mapping, or an empty one."""
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from _list_leaves(inner, (*path, key))
    elif value is not None:
        yield path, value
