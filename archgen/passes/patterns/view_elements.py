"""The components of a project at any depth, groups and types among them, by the paths under which rules see them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple

from archgen.compose.library_types import library_of_type
from archgen.diagnostics.element_origins import TreePath
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, YamlNode

ElementKind = Literal["group", "type", "component"]
TYPE_PREFIX = "component_types."
"""Stands before the path of a component type, and of what is in it, where a group or component has the same path."""
_TYPE_REFERENCES = frozenset({"is", "same_as"})


class ViewElement(NamedTuple):
    """A component as rules see it: where it stands, and where in the tree it is written."""

    key: str
    """Its path, by which rules know it."""
    id: str
    kind: ElementKind
    parent: str | None
    path: TreePath
    type_name: str | None
    """The component type that it is, or stands in."""
    inner_ids: tuple[str, ...] = ()
    """Its way from the type down, where it stands in one."""


def list_view_elements(
    root: MappingNode, type_entries: Mapping[str, MappingEntry], inherited_ids: Mapping[str, frozenset[str]]
) -> Iterator[ViewElement]:
    """Yield component types, then groups, each before what stands in it.

    `inherited_ids` are the components that a type has from the type that it is made from: they are seen there.
    """
    groups = list(_list_groups(root))
    taken_keys = {each.key for each in groups}
    for name, entry in type_entries.items():
        key = f"{TYPE_PREFIX}{name}" if name in taken_keys else name
        path = path_of_type(name)
        yield ViewElement(key, name.rpartition(".")[2], "type", None, path, name)
        yield from list_inside(entry.value, key, path, name, (), inherited_ids.get(name, frozenset()))
    yield from groups


def path_of_type(name: str) -> TreePath:
    """Return where in the tree a component type is written."""
    library = library_of_type(name)
    if library is None:
        return ("component_types", name)
    return ("libraries", library, "component_types", name.removeprefix(f"{library}."))


def _list_groups(root: MappingNode) -> Iterator[ViewElement]:
    groups = root.get("groups")
    for group in groups if isinstance(groups, MappingNode) else ():
        path = ("groups", group.key)
        yield ViewElement(group.key, group.key, "group", None, path, None)
        yield from list_inside(group.value, group.key, path, None, (), frozenset())


def list_inside(  # noqa: PLR0913, PLR0917 - what the recursion carries
    node: YamlNode | None,
    parent: str,
    path: TreePath,
    type_name: str | None,
    inner_ids: tuple[str, ...],
    left_out: frozenset[str],
) -> Iterator[ViewElement]:
    """Yield what stands inside of a component, to any depth; nothing of an instance."""
    # What an instance writes of components inside belongs to its type.
    if not isinstance(node, MappingNode) or (len(path) > 2 and is_instance(node) and not _is_type(path)):  # noqa: PLR2004
        return
    components = node.get("components")
    for part in components if isinstance(components, MappingNode) else ():
        if part.key in left_out:
            continue
        key, inner_path = f"{parent}.{part.key}", (*path, "components", part.key)
        ids = (*inner_ids, part.key)
        yield ViewElement(key, part.key, "component", parent, inner_path, type_name, ids)
        yield from list_inside(part.value, key, inner_path, type_name, ids, frozenset())


def _is_type(path: TreePath) -> bool:
    return (path[0] == "component_types" and len(path) == 2) or (path[0] == "libraries" and len(path) == 4)  # noqa: PLR2004


def is_instance(node: YamlNode | None) -> bool:
    """Whether a component is made from a type."""
    return isinstance(node, MappingNode) and not _TYPE_REFERENCES.isdisjoint(node.entries)
