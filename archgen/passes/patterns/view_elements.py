"""The components of a project at any depth, groups and types among them, by the paths under which rules see them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Literal

from archgen.compose.library_types import library_of_type
from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.model.path_resolver import PathResolver
from archgen.passes.patterns.matching import IndexToken, list_tokens
from archgen.passes.patterns.pattern_shapes import PortReference, ViewValue
from archgen.passes.patterns.view_values import read_view_value
from archgen.passes.project_tree import ProjectTree
from archgen.passes.written_places import list_type_sections
from archgen.schema import fold_type_name
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, list_entries

_KINDS = ("group", "component", "output")
_SELF = "self."
_PORT_PATH_LENGTH = 2


class ViewReferences:
    """Resolves references between the elements of a view; `list_outputs` names the outputs of one."""

    def __init__(self, elements: Mapping[str, ViewElement], list_outputs: Callable[[str], Collection[str]]) -> None:
        """Take the elements by path; changes of the mapping are seen after `forget_names`."""
        self._elements = elements
        self._list_outputs = list_outputs
        self._open_names: PathResolver | None = None

    def forget_names(self) -> None:
        """Look the names up again: components or outputs have come or gone."""
        self._open_names = None

    def resolve(self, text: str, writer: str, *, is_output: bool, at: ScalarNode | None = None) -> PortReference | None:
        """Return what a reference means at an input of a component, or at an output that it passes on; None if unclear."""
        shell = writer if is_output else self._elements[writer].parent
        if text.startswith(_SELF):
            name = text.removeprefix(_SELF)
            return PortReference(shell, name, holder=shell, at=at) if shell else None
        for around in self._list_shells(shell):
            found = self._match_inside(around, text, writer, at)
            if found or is_output:
                return found
        if self._elements[writer].type_name is not None:
            return None
        match = self._resolver().resolve_path(text, _KINDS, component_id=writer).unique_element
        if match is not None:
            return self._make_reference(match.kind, match.id, at)
        if text in self._elements:
            return PortReference(text, None, at=at)
        component, _, port = text.rpartition(".")
        is_port = component in self._elements and port in self._list_outputs(component)
        return PortReference(component, port, at=at) if is_port else None

    def write(self, target: PortReference, writer: str, *, is_output: bool) -> str | None:
        """Return the words that mean a port, or a whole component, where a component writes them; None where nothing does."""
        if target.holder is not None:
            shell = writer if is_output else self._elements[writer].parent
            return str(target) if target.holder == shell else None
        component = self._elements.get(target.component)
        if component is None:
            return None
        words = component.id if target.port is None else f"{component.id}.{target.port}"
        shell = writer if is_output else self._elements[writer].parent
        is_in_type = self._elements[writer].type_name is not None
        if component.parent in tuple(self._list_shells(shell)):
            if self.resolve(words, writer, is_output=is_output) == target:
                return words
        elif component.parent is not None and component.parent == self._elements[writer].parent and not is_output:
            # In a group two words may be a component of another group.
            return str(target) if target.port is None or words in self._elements else words
        # A complete path is never taken for anything else, but nothing outside of a type is seen in it.
        return None if is_output or is_in_type or component.type_name is not None else str(target)

    def _list_shells(self, shell: str | None) -> Iterator[str]:
        """Yield the composed components around, from the inside to the outside: groups are none."""
        while shell is not None and self._elements[shell].kind != "group":
            yield shell
            shell = self._elements[shell].parent

    def _is_open(self, element: ViewElement) -> bool:
        if element.type_name is not None:
            return False
        return element.parent is None or self._elements[element.parent].kind == "group"

    def _match_inside(self, shell: str, text: str, writer: str, at: ScalarNode | None) -> PortReference | None:
        words = text.split(".")
        child = f"{shell}.{words[0]}"
        if len(words) > 1:
            is_port = child in self._elements and len(words) == _PORT_PATH_LENGTH
            found = is_port and words[1] in self._list_outputs(child)
            return PortReference(child, words[1], at=at) if found else None
        if child in self._elements and child != writer:
            return PortReference(child, None, at=at)
        children = [key for key, each in self._elements.items() if each.parent == shell and key != writer]
        owners = [key for key in children if text in self._list_outputs(key)]
        return PortReference(owners[0], text, at=at) if len(owners) == 1 else None

    def _resolver(self) -> PathResolver:
        if self._open_names is None:
            open_keys = [
                each.key for each in self._elements.values() if each.kind == "component" and self._is_open(each)
            ]
            self._open_names = PathResolver(
                {
                    "group": [each.key for each in self._elements.values() if each.kind == "group"],
                    "component": open_keys,
                    "output": [f"{key}.{name}" for key in open_keys for name in self._list_outputs(key)],
                }
            )
        return self._open_names

    def _make_reference(self, kind: str, element_id: str, at: ScalarNode | None) -> PortReference:
        if kind != "output":
            return PortReference(element_id, None, at=at)
        component, _, port = element_id.rpartition(".")
        return PortReference(component, port, at=at)


class ComponentIndex:
    """Finds components by tokens. What is stale is read again when somebody asks."""

    def __init__(self, get_component: Callable[[str], Mapping[str, ViewValue] | None]) -> None:
        """Take what says what a component has, None where there is none any more."""
        self._get_component = get_component
        self._order: dict[str, int] = {}
        self._next_number = 0
        self._tokens: dict[str, tuple[IndexToken, ...]] = {}
        self._postings: dict[IndexToken, dict[str, None]] = {}
        self._sorted: dict[IndexToken, list[str]] = {}
        self._stale: dict[str, None] = {}

    def add(self, path: str) -> None:
        """Take up a component, behind all others."""
        self._order[path] = self._next_number
        self._next_number += 1
        self._stale[path] = None

    def mark_stale(self, path: str) -> None:
        """Read a component again: it has changed, or is gone."""
        self._stale[path] = None

    def find_having(self, token: IndexToken) -> Sequence[str]:
        """Return the components that a token finds, in order."""
        self._renew()
        if token not in self._sorted:
            self._sorted[token] = sorted(self._postings.get(token, ()), key=self._order.__getitem__)
        return self._sorted[token]

    def count_having(self, token: IndexToken) -> int:
        """Return how many components a token finds."""
        self._renew()
        return len(self._postings.get(token, ()))

    def _renew(self) -> None:
        if not self._stale:
            return
        stale_paths, self._stale = self._stale, {}
        for path in stale_paths:
            for token in self._tokens.pop(path, ()):
                del self._postings[token][path]
                self._sorted.pop(token, None)
            body = self._get_component(path)
            if body is not None:
                tokens = tuple(dict.fromkeys(list_tokens(body)))
                self._tokens[path] = tokens
                for token in tokens:
                    self._postings.setdefault(token, {})[path] = None
                    self._sorted.pop(token, None)


class ConceptualTypes:
    """The conceptual types of a tree that is edited, read when they are asked for."""

    def __init__(self, tree: ProjectTree) -> None:
        self._tree = tree
        self._bodies: dict[str, dict[str, ViewValue]] | None = None
        self._paths: dict[str, TreePath] = {}

    def list_names(self) -> Sequence[str]:
        """Return the names of all types, in order."""
        return tuple(self._read_bodies())

    def get_body(self, name: str) -> dict[str, ViewValue] | None:
        """Return what a type has, None where there is none."""
        return self._read_bodies().get(name)

    def find_path(self, name: str) -> TreePath:
        """Return where a type stands in the tree; for one that there is not, where it would be written."""
        self._read_bodies()
        return self._paths.get(name, ("types", name))

    def forget_bodies(self) -> None:
        """Read the types again when they are asked for next: the tree was edited."""
        self._bodies = None

    def _read_bodies(self) -> dict[str, dict[str, ViewValue]]:
        if self._bodies is None:
            self._bodies, self._paths = {}, {}
            for path, entry in self._list_entries():
                name = fold_type_name(entry.key)
                # The project's own come first, and hide those of its libraries.
                if name not in self._bodies:
                    value = read_view_value(entry.value, lambda _: None, {})
                    self._bodies[name] = value if isinstance(value, dict) else {}
                    self._paths[name] = (*path, entry.key)
        return self._bodies

    def _list_entries(self) -> Iterator[tuple[TreePath, MappingEntry]]:
        """Yield each type that is written, with the path of the section that it stands in."""
        for path in list_type_sections(self._tree, "types"):
            yield from ((path, entry) for entry in list_entries(self._tree.get(path)))


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
    for group in list_entries(root, "groups"):
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
    for part in list_entries(node, "components"):
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
