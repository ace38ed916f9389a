"""Find where a new element belongs: the file that holds similar elements."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

from archgen.edit.edit_proof import first_file_of, list_written_nodes
from archgen.frozen import NamedTuple
from archgen.pipeline import CheckedProject
from archgen.project import PROJECT_FILE
from archgen.syntax import file_patterns
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode, find_value, list_entries


class ElementPlace(NamedTuple):
    """A file and the path of the mapping in it that takes the element; `is_new_file`: it does not exist yet."""

    file: str
    path: tuple[str, ...]
    is_new_file: bool = False


class NoPlaceError(Exception):
    """No file of the project can take the element. The message says what to do."""


def place_for_group(checked_project: CheckedProject, name: str) -> ElementPlace:
    """Return a new file in the folder of the groups, or the file that holds all of them. Raise NoPlaceError."""
    group_counts = {file: len(table.entries) for file, table in _section_tables(checked_project, "groups")}
    folders = Counter(os.path.dirname(file) for file in group_counts if file != first_file_of(checked_project))  # noqa: PTH120 - text, with `/`
    if not folders and group_counts:
        return ElementPlace(first_file_of(checked_project), ("groups",))
    if first_file_of(checked_project) != PROJECT_FILE:
        return ElementPlace(first_file_of(checked_project), ("groups",))
    folder = max(folders, key=lambda table: (folders[table], table)) if folders else "groups"
    file = f"{folder}/{name}.yaml" if folder else f"{name}.yaml"
    if not _is_source(checked_project, file):
        msg = f"`sources` of {PROJECT_FILE} has no pattern for {file}: add `{folder or '.'}/*.yaml` there first"
        raise NoPlaceError(msg)
    if checked_project.loaded_project.files.has_path(file):
        msg = f"{file} is there already, and holds no group `{name}`: write the group into it, or rename the file"
        raise NoPlaceError(msg)
    return ElementPlace(file, ("groups",), is_new_file=True)


def place_in_section(checked_project: CheckedProject, section: str) -> ElementPlace:
    """Return the file with most elements of a section, such as `partners`; the first one where none has any."""
    counts = {file: len(table.entries) for file, table in _section_tables(checked_project, section)}
    file = max(counts, key=lambda name: counts[name], default=first_file_of(checked_project))
    return ElementPlace(file, (section,))


def place_for_component(checked_project: CheckedProject, holder_id: str) -> ElementPlace:
    """Return the file that says most about what takes the component: a group, or a composed component."""
    group, *inner_ids = holder_id.split(".")
    weights = {
        file: [_weigh_slice(part) for part in _follow_ids(table, (group, *inner_ids))]
        for file, table in _section_tables(checked_project, "groups")
        if group in table.entries
    }
    # Of files that say the same of the innermost, the one that says most about what is around it.
    file = max(weights, key=lambda name: (len(weights[name]), weights[name][::-1]))
    return ElementPlace(
        file, ("groups", group, "components", *(key for id_ in inner_ids for key in (id_, "components")))
    )


def _follow_ids(groups: MappingNode, ids: tuple[str, ...]) -> Iterator[YamlNode]:
    """Yield a group and the components inside of one another that a file writes, from the outside to the inside."""
    table: YamlNode | None = groups
    for element_id in ids:
        part = find_value(table, element_id)
        if part is None:
            return
        yield part
        table = find_value(part, "components")


def place_for_node(checked_project: CheckedProject, components: tuple[str, ...]) -> ElementPlace:
    """Return the file with nodes of the same components, else of the same groups, else with most nodes."""
    groups = {component.partition(".")[0] for component in components}
    leaves = {leaf for component in components for leaf in checked_project.architecture.leaves_of(component)}
    written_nodes = list_written_nodes(checked_project)
    same_components = Counter(node.at.file for node in written_nodes if leaves.intersection(node.implements))
    same_groups = Counter(
        node.at.file for node in written_nodes if groups & {name.partition(".")[0] for name in node.implements}
    )
    for node_counts in (same_components, same_groups):
        if node_counts:
            return ElementPlace(node_counts.most_common(1)[0][0], ("nodes",))
    all_counts = Counter(node.at.file for node in written_nodes)
    in_group_files = set(all_counts) <= {
        file for file, _ in _section_tables(checked_project, "groups")
    }  # nodes stand in the files of their groups
    if groups and in_group_files:
        return ElementPlace(place_for_component(checked_project, min(groups)).file, ("nodes",))
    return ElementPlace(all_counts.most_common(1)[0][0] if all_counts else first_file_of(checked_project), ("nodes",))


def _section_tables(checked_project: CheckedProject, section: str) -> Iterator[tuple[str, MappingNode]]:
    for document in checked_project.loaded_project.documents:
        table = document.root.get(section)
        if isinstance(table, MappingNode):
            yield document.file, table


def _weigh_slice(holder: YamlNode) -> tuple[int, int]:
    """Return how much a file says about a group or component: first its components' keys, then its own."""
    component_values = [entry.value for entry in list_entries(holder, "components")]
    keys = sum(len(value.entries) for value in component_values if isinstance(value, MappingNode))
    return len(component_values) + keys, len(holder.entries) if isinstance(holder, MappingNode) else 0


def _is_source(checked_project: CheckedProject, file: str) -> bool:
    """Return whether the project will read a file of this name once it exists."""
    patterns = next(
        (
            document.root.get("sources")
            for document in checked_project.loaded_project.documents
            if document.file == PROJECT_FILE
        ),
        None,
    )
    if not isinstance(patterns, SequenceNode):
        return True
    return any(
        isinstance(pattern, ScalarNode) and file_patterns.matches_pattern(pattern.text, file)
        for pattern in patterns.items
    )
