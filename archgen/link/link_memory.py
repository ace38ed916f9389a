"""What linking remembers of one version of a project for the next: parts whose text and surroundings are the same.

A variant is the project with little changed. Its tree shares what is not changed, so that a component or a node whose
entry is the same object, and whose references mean what they meant, is the same; see docs/decisions/0041-parts-that-variants-share.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.frozen import NamedTuple
from archgen.link.reference_resolution import Answer, HeardReference, NameList
from archgen.model.component import Component, Output
from archgen.model.known_parts import KnownParts
from archgen.model.node import Node
from archgen.model.path_resolver import PathIndex, index_paths
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_MAX_INDEXES = 4
"""Indexes of paths that are remembered for each kind: variants differ in few ways."""


class OutlinedPorts(NamedTuple):
    """The ports of a component as outlined from its body."""

    body: MappingNode
    middleware: str
    inputs: dict[str, MappingEntry]
    outputs: dict[str, Output]


class LinkedLeaf(NamedTuple):
    """A component that holds no others, with all that it was made from besides its entry."""

    entry: MappingEntry
    outputs: dict[str, Output]
    group_owners: tuple[str, ...]
    source_media: tuple[str, ...]
    """What the outputs travel over that its inputs read, in the order of connections."""
    names: NameList | None
    answers: tuple[Answer, ...]
    component: Component
    references: tuple[HeardReference, ...] | None = None


class LinkedNode(NamedTuple):
    """A node, with all that it was made from besides its entry."""

    entry: MappingEntry
    components: tuple[Component, ...]
    shared_flags: tuple[bool, ...]
    """For each of its components, whether other nodes implement it, too."""
    container_host: str | None
    names: NameList | None
    answers: tuple[Answer, ...]
    node: Node
    references: tuple[HeardReference, ...] | None = None


class LinkMemory:
    """Parts of the versions of one project that were linked so far, by id. Only parts without findings are kept."""

    def __init__(self) -> None:
        """Start empty."""
        self.ports: KnownParts[OutlinedPorts] = KnownParts()
        self.leaves: KnownParts[LinkedLeaf] = KnownParts()
        self.nodes: KnownParts[LinkedNode] = KnownParts()
        self._indexes: dict[str, list[tuple[tuple[str, ...], PathIndex]]] = {}
        self._name_lists: list[NameList] = []

    def recall_names(self, *spans_by_kind: Mapping[str, Iterable[str]]) -> NameList:
        """Return all names of a version, as the same object where another version has the same."""
        names = tuple((kind, tuple(ids)) for spans in spans_by_kind for kind, ids in spans.items())
        known = next((each for each in self._name_lists if each == names), None)
        if known is None:
            self._name_lists = [names, *self._name_lists[: _MAX_INDEXES - 1]]
        return known or names

    def index_paths(self, kind: str, paths: Iterable[str]) -> PathIndex:
        """Return the index of the ids of a kind; an earlier one where they are the same."""
        ids = tuple(paths)
        known_indexes = self._indexes.setdefault(kind, [])
        for known_ids, index in known_indexes:
            if known_ids == ids:
                return index
        index = index_paths(ids)
        self._indexes[kind] = [(ids, index), *known_indexes[: _MAX_INDEXES - 1]]
        return index
