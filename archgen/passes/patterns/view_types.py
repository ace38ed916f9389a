"""The conceptual types of a project and of its libraries, as rules see them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compose.library_types import list_libraries
from archgen.diagnostics.element_origins import TreePath
from archgen.passes.patterns.pattern_shapes import ViewValue
from archgen.passes.patterns.view_values import read_view_value
from archgen.passes.project_tree import ProjectTree
from archgen.schema import fold_type_name
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, YamlNode


class ConceptualTypes:
    """The conceptual types of a tree that is edited, read when they are asked for."""

    def __init__(self, tree: ProjectTree) -> None:
        """Take the tree of a merged project."""
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
        sections: list[tuple[TreePath, YamlNode | None]] = [(("types",), self._tree.root.get("types"))]
        for library in list_libraries(self._tree.root):
            body = library.value
            types = body.get("types") if isinstance(body, MappingNode) else None
            sections.append((("libraries", library.key, "types"), types))
        for path, section in sections:
            for entry in section if isinstance(section, MappingNode) else ():
                yield path, entry
