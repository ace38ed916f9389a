"""Where in a tree the components stand that its instances are made from: in groups, in component types, in what is laid over."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compose.expanded_project import parse_type_expression
from archgen.compose.type_table import list_generic_names
from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.selector_keys import find_component_status
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.project_tree import ProjectTree
from archgen.project.library_reading import SHIPPED_ID
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, find_value, list_entries

MAX_DEPTH = 60
"""So deep components are followed, as deep as they are written out."""


class Holder(NamedTuple):
    """What holds components: a group, a component type or a composed component, by its path."""

    path: TreePath
    entry: MappingEntry


def list_holders(tree: ProjectTree) -> Iterator[Holder]:
    """Yield all groups, component types and components, outer ones first; those of libraries last."""
    yield from _list_section(tree, ("groups",))
    yield from list_typed_holders(tree)


def list_typed_holders(tree: ProjectTree) -> Iterator[Holder]:
    """Yield all component types with what stands in them, those of libraries last."""
    for path in list_type_sections(tree):
        yield from _list_section(tree, path)


def list_type_sections(tree: ProjectTree, section: str = "component_types") -> list[TreePath]:
    """Return the paths of the mappings that hold component types, or `types`: the project's own, then its libraries'."""
    return [(section,), *(("libraries", name, section) for name in tree.get_mapping(("libraries",)))]


def find_type_path(tree: ProjectTree, name: str) -> TreePath | None:
    """Return the path of a component type by the name under which the project knows it, None where there is none."""
    library, dot, inner = name.partition(".")
    path: TreePath = ("libraries", library, "component_types", inner) if dot else ("component_types", name)
    return path if tree.get(path) is not None else None


def find_type_of(tree: ProjectTree, path: TreePath) -> TreePath | None:
    """Return the path of the type that a component, or a component type, at a path names; None where it names none."""
    for key in ("same_as", "is"):
        text = tree.get_text((*path, key))
        expression = parse_type_expression(text) if text else None
        if expression is not None:
            # Types of a library see only one another.
            prefix = f"{path[1]}." if path[0] == "libraries" else ""
            return find_type_path(tree, prefix + expression.name)
    return None


def name_probe_type(path: TreePath, entry: MappingEntry) -> str:
    """Return the name of the component type at a path as an instance of it writes it, generic names for themselves."""
    name = f"{path[1]}.{entry.key}" if path[0] == "libraries" else entry.key
    generic_names = list_generic_names(entry)
    return f"{name}<{', '.join(generic_names)}>" if generic_names else name


def _list_section(tree: ProjectTree, path: TreePath) -> Iterator[Holder]:
    section = tree.get(path)
    for entry in list_entries(section):
        yield from _list_inside(Holder((*path, entry.key), entry))


def _list_inside(holder: Holder) -> Iterator[Holder]:
    yield holder
    components = find_value(holder.entry.value, "components")
    if isinstance(components, MappingNode) and len(holder.path) < 2 * MAX_DEPTH:
        for part in list(components):
            yield from _list_inside(Holder((*holder.path, "components", part.key), part))


def is_written(node: object) -> bool:
    """Whether a node says something: an empty key does not."""
    return node is not None and not (isinstance(node, ScalarNode) and node.value is None)


_EXISTING = "existing"


def is_existing(tree: ProjectTree, path: TreePath) -> bool:
    """Whether what is written of a component, of its node, or of what it stands in, says that it exists."""
    around = [path[:length] for length in range(len(path), 1, -2)]
    return any(
        tree.get_text((*each, *key)) == _EXISTING for each in around for key in (("status",), ("node", "status"))
    )


def list_existing_components(linked: LinkedTree) -> set[str]:
    """Return the components that exist already, by what they, what is around them, their nodes or their library say."""
    architecture = linked.architecture
    existing = {
        component_id
        for node in architecture.nodes.values()
        if node.status == _EXISTING
        for component_id in node.implements
    }
    components = (*architecture.components.values(), *architecture.shells.values())
    return existing | {each.id for each in components if _says_existing(architecture, each)}


def _says_existing(architecture: Architecture, component: Component) -> bool:
    if find_component_status(architecture, component) == _EXISTING:
        return True
    around = (component, *architecture.list_around(component))
    return any((each.component_type or "").startswith(f"{SHIPPED_ID}.") for each in around)


def path_of_component(component_id: str) -> TreePath:
    """Return the path at which an instance changes what is inside of it, by the complete id of what it changes."""
    group_id, *names = component_id.split(".")
    return ("groups", group_id, *(step for name in names for step in ("components", name)))
