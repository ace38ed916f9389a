"""Find the files in which an element is written: every slice of it, not only the first."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.link import mapping_values
from archgen.model.element_ids import ElementFiles
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlNode


def find_element_files(root: MappingNode) -> ElementFiles:
    """Return the files of every group, component and node; those of its components do not count for a group."""
    files: dict[tuple[str, str], tuple[str, ...]] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "groups"):
        own_values = [part.value for part in body if part.key != "components"]
        components = mapping_values.get_mapping(body, "components")
        for part in components:
            files["component", f"{name}.{part.key}"] = _list_distinct_files(part.key_span.file, part.value)
        # A file that only adds components to a group writes the group's id too, but nothing about the group.
        files["group", name] = _list_distinct_files(
            "" if components.entries and not own_values else entry.key_span.file, *own_values
        )
    for name, entry, body in mapping_values.iterate_elements(root, "nodes"):
        files["node", name] = _list_distinct_files(entry.key_span.file, body)
    return files


def _list_distinct_files(first_file: str, *values: YamlNode) -> tuple[str, ...]:
    return tuple(
        dict.fromkeys(
            file
            for file in (first_file, *(value_file for value in values for value_file in _list_files_below(value)))
            if file
        )
    )


def _list_files_below(node: YamlNode) -> Iterator[str]:
    """Yield the file of every value below; a merged mapping holds entries of several files, a list only one file's."""
    if isinstance(node, MappingNode):
        for entry in node:
            yield entry.key_span.file
            yield from _list_files_below(entry.value)
    elif isinstance(node, SequenceNode):
        yield from (item.span.file for item in node.items)
    else:
        yield node.span.file
