"""A merged project that passes edit: every value that they write knows what it was made from.

Values that stay keep their spans. A value that is made carries the span of its source, so that a finding about it points at
a line of the user's. Where a new tree is put in the place of another, what stands elsewhere now is found again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics import Span
from archgen.diagnostics.element_origins import Origin, TreePath
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    PlainValue,
    ScalarNode,
    SequenceNode,
    YamlNode,
    copy_node,
)

PlainData = PlainValue | Mapping[str, "PlainData"] | Sequence["PlainData"]


class ProjectTree:
    """A project's tree, a copy of the one that it is made from, and the origins of what passes wrote into it."""

    def __init__(self, root: MappingNode, provenance: Mapping[TreePath, Origin] | None = None) -> None:
        """Take the root of a merged project, which is not changed, and the origins of what passes made in it already."""
        copied_root = copy_node(root, root.span)
        self.root = copied_root if isinstance(copied_root, MappingNode) else root
        self.provenance: dict[TreePath, Origin] = dict(provenance or {})
        """What was made, by its path now; what is inside of it was made with it, unless it is named itself."""
        self.edit_count = 0
        """How many values were written or dropped."""
        self.maker = ""
        """The pass that edits at present."""

    def get(self, path: TreePath) -> YamlNode | None:
        """Return the value at a path, None where there is none."""
        node: YamlNode | None = self.root
        for step in path:
            if isinstance(node, MappingNode) and isinstance(step, str):
                node = node.get(step)
            elif isinstance(node, SequenceNode) and isinstance(step, int) and 0 <= step < len(node.items):
                node = node.items[step]
            else:
                return None
        return node

    def get_mapping(self, path: TreePath) -> Mapping[str, MappingEntry]:
        """Return the entries of the mapping at a path, none where there is no mapping. Copy them before edits."""
        node = self.get(path)
        return node.entries if isinstance(node, MappingNode) else {}

    def get_text(self, path: TreePath) -> str | None:
        """Return the text of the scalar at a path, None where nothing is written."""
        node = self.get(path)
        return node.text if isinstance(node, ScalarNode) and node.value is not None else None

    def find_place(self, path: TreePath) -> Span:
        """Return where a value is written: its key, or the value itself in a list; of what is missing, what is around it."""
        while path:
            key = path[-1]
            holder = self.get(path[:-1])
            if isinstance(holder, MappingNode) and isinstance(key, str) and key in holder.entries:
                return holder.entries[key].key_span
            if (node := self.get(path)) is not None:
                return node.span
            path = path[:-1]
        return self.root.span

    def trace(self, path: TreePath) -> Origin:
        """Return what the value at a path was made from: of what no pass made, itself."""
        for length in range(len(path), 0, -1):
            origin = self.provenance.get(path[:length])
            if origin is not None:
                if length == len(path) or not origin.is_moved:
                    return origin
                return Origin(origin.passes, self.find_place(path), (*origin.path, *path[length:]), is_moved=True)
        return Origin((), self.find_place(path), path)

    def set(self, path: TreePath, value: YamlNode | PlainData, source: TreePath) -> None:
        """Write a value, made from what stands at `source`; mappings on the way to it are made. An equal value stays."""
        node = self.make_node(value, source)
        present = self.get(path)
        if present is not None and have_same_content(present, node):
            return
        origin = self.make_origin(source)
        holder, first_made = self._open_mapping(path[:-1], source)
        key = path[-1]
        if isinstance(key, int):
            sequence = self.get(path[:-1])
            if not isinstance(sequence, SequenceNode):
                raise TypeError(f"no list at {path[:-1]}")
            sequence.items[key] = node
        else:
            present_entry = holder.entries.get(key)
            key_span = present_entry.key_span if present_entry else self.find_place(source)
            holder.entries[key] = MappingEntry(key, key_span, node)
        if isinstance(present, (MappingNode, SequenceNode)):
            self._forget_below(path)
        self.provenance[first_made or path] = origin
        self.edit_count += 1

    def merge(self, path: TreePath, value: YamlNode | PlainData, source: TreePath) -> None:
        """Write a mapping over the one at a path: mappings key by key, all else replaced."""
        node = self.make_node(value, source)
        present = self.get(path)
        if isinstance(node, MappingNode) and node.entries and isinstance(present, MappingNode):
            for entry in node:
                self.merge((*path, entry.key), entry.value, source)
        else:
            self.set(path, node, source)

    def append(self, path: TreePath, value: YamlNode | PlainData, source: TreePath) -> None:
        """Add an item to the list at a path, which is made where there is none; an item that stands there stays alone.

        A scalar in the place of a list is its first item.
        """
        item = self.make_node(value, source)
        present = self.get(path)
        if not isinstance(present, SequenceNode):
            is_item = isinstance(present, ScalarNode) and present.value is not None
            if is_item and present is not None and have_same_content(present, item):
                return
            if is_item and present is not None:
                self._replace(path, SequenceNode([present], present.span))
            else:
                self.set(path, SequenceNode([item], item.span), source)
                return
            present = self.get(path)
        if not isinstance(present, SequenceNode) or any(have_same_content(each, item) for each in present.items):
            return
        present.items.append(item)
        self.provenance[*path, len(present.items) - 1] = self.make_origin(source)
        self.edit_count += 1

    def drop(self, path: TreePath) -> None:
        """Take a key with its value out, or an item out of a list; what is not there needs nothing."""
        holder, key = self.get(path[:-1]), path[-1]
        if isinstance(holder, MappingNode) and isinstance(key, str) and key in holder.entries:
            del holder.entries[key]
        elif isinstance(holder, SequenceNode) and isinstance(key, int) and 0 <= key < len(holder.items):
            del holder.items[key]
        else:
            return
        self._forget_below(path)
        self.provenance.pop(path, None)
        if isinstance(key, int):
            self._shift_items(path[:-1], key)
        self.edit_count += 1

    def mark(self, path: TreePath) -> None:
        """Say that the pass made what stands at a path from itself: it is there, and follows from what is written."""
        if not self.trace(path).passes:
            self.provenance[path] = self.make_origin(path)._replace(is_moved=True)

    def make_node(self, value: YamlNode | PlainData, source: TreePath) -> YamlNode:
        """Return plain data as a tree with the span of what it is made from; a tree stays as it is."""
        if isinstance(value, (ScalarNode, SequenceNode, MappingNode)):
            return value
        source_node = self.get(source)
        span = source_node.span if isinstance(source_node, ScalarNode) else self.find_place(source)
        return make_node(value, span)

    def make_origin(self, source: TreePath) -> Origin:
        """Return the origin of what the pass that edits at present makes from what stands at `source`."""
        traced = self.trace(source)
        passes = traced.passes if self.maker in traced.passes[-1:] else (*traced.passes, self.maker)
        return Origin(passes, traced.at, traced.path)

    def _open_mapping(self, path: TreePath, source: TreePath) -> tuple[MappingNode, TreePath | None]:
        """Return the mapping at a path, made where there is none, and the path of the outermost one that was made."""
        node: YamlNode = self.root
        first_made: TreePath | None = None
        for length, step in enumerate(path, 1):
            inner = self.get(path[:length])
            if inner is None or (isinstance(inner, ScalarNode) and inner.value is None):
                inner = MappingNode({}, self.find_place(source))
                if isinstance(node, MappingNode) and isinstance(step, str):
                    present = node.entries.get(step)
                    node.entries[step] = MappingEntry(step, present.key_span if present else inner.span, inner)
                    first_made = first_made or path[:length]
            node = inner
        if isinstance(node, SequenceNode):
            return MappingNode({}, node.span), first_made
        if not isinstance(node, MappingNode):
            raise TypeError(f"no mapping at {path}")
        return node, first_made

    def _replace(self, path: TreePath, node: YamlNode) -> None:
        """Put a value in the place of another of the same content: its origin stays."""
        holder, key = self.get(path[:-1]), path[-1]
        if isinstance(holder, MappingNode) and isinstance(key, str):
            holder.entries[key].value = node
        elif isinstance(holder, SequenceNode) and isinstance(key, int):
            holder.items[key] = node

    def _forget_below(self, path: TreePath) -> None:
        length = len(path)
        for each in [each for each in self.provenance if len(each) > length and each[:length] == path]:
            del self.provenance[each]

    def _shift_items(self, path: TreePath, dropped: int) -> None:
        """Move the origins of a list's items behind one that was dropped."""
        length = len(path)
        shifted: dict[TreePath, Origin] = {}
        for each, origin in self.provenance.items():
            step = each[length] if len(each) > length and each[:length] == path else None
            is_behind = isinstance(step, int) and step > dropped
            shifted[(*path, step - 1, *each[length + 1 :]) if is_behind and isinstance(step, int) else each] = origin
        self.provenance = shifted


def make_node(value: PlainData, span: Span) -> YamlNode:
    """Return plain data as a tree in which everything has one span."""
    if isinstance(value, Mapping):
        return MappingNode({key: MappingEntry(key, span, make_node(each, span)) for key, each in value.items()}, span)
    if isinstance(value, Sequence) and not isinstance(value, str):
        return SequenceNode([make_node(each, span) for each in value], span)
    text = value if isinstance(value, str) else "" if value is None else str(value).lower()
    return ScalarNode(value, text, span)


def have_same_content(first: YamlNode, second: YamlNode) -> bool:
    """Whether two trees hold the same, wherever it is written."""
    if isinstance(first, MappingNode) and isinstance(second, MappingNode):
        return first.entries.keys() == second.entries.keys() and all(
            have_same_content(entry.value, second.entries[entry.key].value) for entry in first
        )
    if isinstance(first, SequenceNode) and isinstance(second, SequenceNode):
        return len(first.items) == len(second.items) and all(map(have_same_content, first.items, second.items))
    if isinstance(first, ScalarNode) and isinstance(second, ScalarNode):
        return first.text == second.text and (first.value is None) == (second.value is None)
    return False


def walk_tree(node: YamlNode, path: TreePath = ()) -> Iterator[tuple[TreePath, MappingEntry | None, YamlNode]]:
    """Yield every value inside of a tree with its path, outer ones first, and with its entry where it stands in a mapping."""
    if isinstance(node, MappingNode):
        for entry in node:
            yield (*path, entry.key), entry, entry.value
            yield from walk_tree(entry.value, (*path, entry.key))
    elif isinstance(node, SequenceNode):
        for number, item in enumerate(node.items):
            yield (*path, number), None, item
            yield from walk_tree(item, (*path, number))


def list_paths(node: YamlNode, path: TreePath = ()) -> Iterator[tuple[TreePath, YamlNode]]:
    """Yield every value of a tree with its path, outer ones first."""
    yield path, node
    yield from ((inner_path, inner) for inner_path, _, inner in walk_tree(node, path))


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
