"""Find where a new element belongs: the file that holds similar elements."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from archgen.edit.proof import first_file
from archgen.pipeline import Checked
from archgen.project import MARKER
from archgen.syntax import globs
from archgen.syntax.tree import Listing, Scalar, Table, Value


class Place(NamedTuple):
    """A file and the path of the mapping in it that takes the element; `is_new_file`: it does not exist yet."""

    file: str
    path: tuple[str, ...]
    new: bool = False


class NoPlaceError(Exception):
    """No file of the project can take the element. The message says what to do."""


def of_group(checked: Checked, name: str) -> Place:
    """Return a new file in the folder of the groups, or the file that holds all of them. Raise NoPlaceError."""
    held = {file: len(found.entries) for file, found in _tables(checked, "groups")}
    folders = Counter(os.path.dirname(file) for file in held if file != first_file(checked))  # noqa: PTH120 - text, with `/`
    if not folders and held:
        return Place(first_file(checked), ("groups",))
    if first_file(checked) != MARKER:
        return Place(first_file(checked), ("groups",))
    folder = max(folders, key=lambda found: (folders[found], found)) if folders else "groups"
    file = f"{folder}/{name}.yaml" if folder else f"{name}.yaml"
    if not _is_read(checked, file):
        msg = f"`sources` of {MARKER} has no pattern for {file}: add `{folder or '.'}/*.yaml` there first"
        raise NoPlaceError(msg)
    if checked.loaded.files.exists(file):
        msg = f"{file} is there already, and holds no group `{name}`: write the group into it, or rename the file"
        raise NoPlaceError(msg)
    return Place(file, ("groups",), new=True)


def of_component(checked: Checked, group: str) -> Place:
    """Return the file that says most about the group."""
    path = ("groups", group, "components")
    said = {file: _weight(found.get(group)) for file, found in _tables(checked, "groups") if group in found.entries}
    return Place(max(said, key=lambda file: said[file]), path)


def of_node(checked: Checked, components: tuple[str, ...]) -> Place:
    """Return the file with nodes of the same components, else of the same groups, else with most nodes."""
    groups = {component.partition(".")[0] for component in components}
    written = [node for node in checked.architecture.nodes.values() if node.written]
    same = Counter(node.at.file for node in written if set(node.implements) & set(components))
    near = Counter(node.at.file for node in written if groups & {name.partition(".")[0] for name in node.implements})
    for found in (same, near):
        if found:
            return Place(found.most_common(1)[0][0], ("nodes",))
    most = Counter(node.at.file for node in written)
    beside = set(most) <= {file for file, _ in _tables(checked, "groups")}  # nodes stand in the files of their groups
    if groups and beside:
        return Place(of_component(checked, min(groups)).file, ("nodes",))
    return Place(most.most_common(1)[0][0] if most else first_file(checked), ("nodes",))


def _tables(checked: Checked, section: str) -> Iterator[tuple[str, Table]]:
    for document in checked.loaded.documents:
        found = document.root.get(section)
        if isinstance(found, Table):
            yield document.file, found


def _weight(group: Value | None) -> tuple[int, int]:
    """Return how much a slice says about a group: first its components' keys, then its own."""
    found = group.get("components") if isinstance(group, Table) else None
    inner = [e.value for e in found] if isinstance(found, Table) else []
    keys = sum(len(value.entries) for value in inner if isinstance(value, Table))
    return len(inner) + keys, len(group.entries) if isinstance(group, Table) else 0


def _is_read(checked: Checked, file: str) -> bool:
    """Return whether the project will read a file of this name once it exists."""
    patterns = next((d.root.get("sources") for d in checked.loaded.documents if d.file == MARKER), None)
    if not isinstance(patterns, Listing):
        return True
    return any(isinstance(pattern, Scalar) and globs.matches(pattern.text, file) for pattern in patterns.items)
