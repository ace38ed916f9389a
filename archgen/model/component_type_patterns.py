"""What component types say to their instances, as components that say nothing of their own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from archgen.frozen import dataclass
from archgen.model.component import Component
from archgen.model.node import Node

PATTERN_GROUP = "component types"
"""The group of patterns: a name that no group of a project can have."""


@dataclass(frozen=True, slots=True)
class TypePatterns:
    """Patterns by the id of their type; of what is inside of a type by the path: `arm.shoulder`."""

    components: Mapping[str, Component] = field(default_factory=dict)
    """Composed ones and leaves."""
    nodes: Mapping[str, Node] = field(default_factory=dict)
    """The nodes that components bring along, by the id of their pattern as it was linked."""

    def list_parts(self, type_id: str) -> Iterator[tuple[str, Component]]:
        """Yield what is inside of a type, to any depth, each with its path below the type."""
        # A type of a library has a dot in its id, so that the path is what follows it, not what follows the first dot.
        return self._list_parts_below(type_id, "")

    def _list_parts_below(self, type_id: str, path: str) -> Iterator[tuple[str, Component]]:
        pattern = self.components.get(f"{type_id}{path}")
        for child in pattern.children if pattern else ():
            inner_path = f"{path}.{child.rpartition('.')[2]}"
            inner_pattern = self.components.get(f"{type_id}{inner_path}")
            if inner_pattern is not None:
                yield inner_path.removeprefix("."), inner_pattern
                yield from self._list_parts_below(type_id, inner_path)
