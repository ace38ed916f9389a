"""Where a value of a component belongs: to its own place in the tree, or to that of a type that it is made from."""

from __future__ import annotations

from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.pattern_shapes import ViewValue
from archgen.passes.patterns.type_layers import Layer
from archgen.syntax.yaml_tree import ScalarNode, find_value

TYPE_NAME_KEYS = frozenset({"is", "same_as"})
"""The keys whose values name a component type."""
DataPath = tuple[str, ...]
"""The keys that lead to a value of a component."""
_DECLARED_SECTIONS = frozenset({"inputs", "outputs", "parameters", "operations"})
"""What an instance has from its type alone: what is new there goes to the type."""
_WIRING_KEYS = frozenset({"from", "external"})
"""Keys of an input that its component says, whatever it is made from."""
_JOINED_LISTS = frozenset({"requirements", "tags"})
"""Lists that an instance adds to."""
_PATH_OF_LEAF = 3


class WrittenPlace(NamedTuple):
    """Where a value of a component is written, and what it is made from."""

    key: str
    layer: Layer
    path: DataPath
    source: TreePath

    @property
    def target(self) -> TreePath:
        """The path in the tree."""
        return (*self.layer.path, *self.path)


def choose_layer(view: ArchitectureView, key: str, path: DataPath, present: ViewValue) -> Layer:
    """Return the place that a value at a path belongs to: its own, or that of a type."""
    layers = view.list_layers(key)
    own = layers[0]
    is_reference = view.elements[key].kind == "component" and "same_as" in own.node.entries
    if path[0] == "inputs" and (path[_PATH_OF_LEAF - 1 :] or ("",))[0] in _WIRING_KEYS:
        return own
    if len(layers) == 1 or (path == ("from",)) or (path[0] in _JOINED_LISTS and not is_reference):
        return own
    found = _find_written(layers, path, present, is_reference=is_reference)
    if found is not None:
        return found
    if is_reference or (path[0] in _DECLARED_SECTIONS and view.elements[key].kind != "type"):
        return layers[1]
    return own


def _find_written(layers: list[Layer], path: DataPath, present: ViewValue, *, is_reference: bool) -> Layer | None:
    """Return the layer that writes a value, else the one that declares the element that it belongs to."""
    own = layers[0]
    for layer in layers[1:] if is_reference and path[0] != "title" else layers:
        written = find_value(layer.node, *path)
        if written is not None:
            # What a generic name stands for is the instance's: the type says the name.
            is_bound = isinstance(written, ScalarNode) and isinstance(present, str) and written.text != present
            return own if is_bound and layer is not own and not is_reference else layer
    declaring = [layer for layer in layers if len(path) > 1 and find_value(layer.node, *path[:2]) is not None]
    return declaring[-1] if declaring else None


def find_source(view: ArchitectureView, layer: Layer, path: DataPath) -> TreePath:
    """Return the innermost thing on the way to a value that is written."""
    for length in range(len(path), 0, -1):
        if view.tree.get((*layer.path, *path[:length])) is not None:
            return (*layer.path, *path[:length])
    return layer.path
