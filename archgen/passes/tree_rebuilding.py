"""Put a new tree in the place of one that passes edit: what stands elsewhere now is found again, and keeps its origin."""

from __future__ import annotations

from archgen.diagnostics import Span
from archgen.diagnostics.element_origins import Origin, TreePath
from archgen.passes.project_tree import ProjectTree, have_same_content, walk_tree
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, copy_node


def rebuild_tree(tree: ProjectTree, new_root: MappingNode) -> None:
    """Make a new root the tree's, made of entries of the old one and of others with their places."""
    places = _OldPlaces(tree)
    origins: dict[TreePath, Origin] = {}
    _trace_mapping(new_root, (), (), places, origins)
    copied_root = copy_node(new_root, new_root.span)
    if isinstance(copied_root, MappingNode):
        tree.root = copied_root
    tree.provenance = origins
    tree.edit_count += 1


class _OldPlaces:
    """Where everything stands in the old tree, by identity and, for what was copied since, by place and key."""

    def __init__(self, tree: ProjectTree) -> None:
        self.tree = tree
        self._item_origins = _index_items(tree.provenance)
        self._by_identity: dict[int, TreePath] = {}
        self._by_place: dict[tuple[Span, str], TreePath] = {}
        self._components_by_place: dict[Span, TreePath] = {}
        for path, entry, _ in walk_tree(tree.root):
            if entry is None:
                continue
            self._by_identity[id(entry)] = path
            self._by_identity.setdefault(id(entry.value), path)
            self._by_place.setdefault((entry.key_span, str(path[-1])), path)
            if len(path) > 1 and path[-2] == "components":
                self._components_by_place.setdefault(entry.key_span, path)

    def find(self, entry: MappingEntry, *, is_component: bool) -> TreePath | None:
        """Return where an entry, or one made from it, stood. A component may be called otherwise now."""
        found = self._by_identity.get(id(entry)) or self._by_identity.get(id(entry.value))
        found = found or self._by_place.get((entry.key_span, entry.key))
        return found or (self._components_by_place.get(entry.key_span) if is_component else None)

    def make_origin(self, old_path: TreePath) -> Origin:
        """Return the origin of what was moved by the pass that edits at present."""
        origin = self.tree.make_origin(old_path)
        traced = self.tree.trace(old_path)
        return origin._replace(is_moved=not traced.passes or traced.is_moved)

    def is_rewritten(self, old_path: TreePath, value: YamlNode) -> bool:
        """Whether a leaf holds something else than before."""
        old_value = self.tree.get(old_path)
        return not isinstance(value, MappingNode) and old_value is not None and not have_same_content(old_value, value)

    def find_item_origins(self, old_path: TreePath) -> list[tuple[TreePath, Origin]]:
        """Return the origins inside of a list, by the rest of their paths."""
        return self._item_origins.get(old_path, [])


def _index_items(provenance: dict[TreePath, Origin]) -> dict[TreePath, list[tuple[TreePath, Origin]]]:
    """Return the origins inside of lists by the path of the outermost list, with the rest of their paths."""
    indexed: dict[TreePath, list[tuple[TreePath, Origin]]] = {}
    for path, origin in provenance.items():
        length = next((number for number, step in enumerate(path) if isinstance(step, int)), len(path))
        if length < len(path):
            indexed.setdefault(path[:length], []).append((path[length:], origin))
    return indexed


def _trace_mapping(
    node: MappingNode, path: TreePath, old_path: TreePath, places: _OldPlaces, origins: dict[TreePath, Origin]
) -> None:
    """Write down the origins of what stands in a mapping; `old_path` is where the mapping is taken to have stood."""
    for entry in node:
        inner_path, expected_path = (*path, entry.key), (*old_path, entry.key)
        found_path = places.find(entry, is_component=path[-1:] == ("components",))
        if found_path is not None and found_path != expected_path:
            is_unmoved = found_path == inner_path
            origins[inner_path] = places.tree.trace(found_path) if is_unmoved else places.make_origin(found_path)
        elif found_path is not None and places.is_rewritten(found_path, entry.value):
            origins[inner_path] = places.make_origin(found_path)._replace(is_moved=False)
        elif found_path is not None and (own_origin := places.tree.provenance.get(found_path)) is not None:
            origins[inner_path] = own_origin
        now_expected = found_path or expected_path
        if isinstance(entry.value, MappingNode):
            _trace_mapping(entry.value, inner_path, now_expected, places, origins)
        elif isinstance(entry.value, (SequenceNode, ScalarNode)) and found_path is not None:
            for rest, origin in places.find_item_origins(found_path):
                origins[*inner_path, *rest] = origin
