"""The component types of a tree that is edited: what a component is made from, layer by layer, and what comes of it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compose.expanded_project import TypeExpression, parse_type_expression
from archgen.compose.instance_overlay import InstanceOverlay
from archgen.compose.library_types import library_of_type, list_type_entries
from archgen.compose.type_table import TypeTable, list_generic_names
from archgen.diagnostics import Diagnostic
from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.passes.patterns.view_elements import path_of_type
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, find_value, list_entries


class Layer(NamedTuple):
    """One of the places in the tree that a component has its values from: its own, or that of a type."""

    path: TreePath
    node: MappingNode
    type_name: str | None
    """The type, None for the component's own place."""


class TypeLayers:
    """The component types of a tree; say with `renew_type` which of them was edited."""

    def __init__(self, root: MappingNode) -> None:
        self._diagnostics: list[Diagnostic] = []
        self.entries = list_type_entries(root)
        self._table = TypeTable(self.entries, self._diagnostics)

    def find_type_name(self, node: YamlNode | None) -> str | None:
        """Return the component type that a component is made from, None where there is none of this name."""
        if not isinstance(node, MappingNode):
            return None
        reference = _get_type_reference(node)
        expression = parse_type_expression(reference.text) if reference else None
        return expression.name if expression and expression.name in self.entries else None

    def list_layers(self, own: Layer, own_type: str | None) -> list[Layer]:
        """Return a component's own place, its type's, that type's type's, and so on. `own_type` is the type that it is."""
        layers = [own]
        seen = {own_type}
        while (name := self.find_type_name(layers[-1].node)) is not None and name not in seen:
            seen.add(name)
            entry = self.entries[name]
            body = entry.value if isinstance(entry.value, MappingNode) else MappingNode({}, entry.key_span)
            layers.append(Layer(path_of_type(name), body, name))
        return layers

    def list_used(self, root: MappingNode) -> dict[str, MappingEntry]:
        """Return the project's own types, and those of libraries that it uses, in order."""
        used = dict.fromkeys(name for name in self.entries if library_of_type(name) is None)
        groups = root.get("groups")
        pending = [*(self.entries[name].value for name in used), *([groups] if groups is not None else [])]
        while pending:
            for name in self._list_names(pending.pop()):
                if name not in used:
                    used[name] = None
                    pending.append(self.entries[name].value)
        return {name: entry for name, entry in self.entries.items() if name in used}

    def _list_names(self, node: YamlNode) -> Iterator[str]:
        """Yield the component types that a tree names."""
        name = self.find_type_name(node)
        if name is not None:
            yield name
        for entry in list_entries(node):
            yield from self._list_names(entry.value)

    def list_inherited(self, name: str) -> frozenset[str]:
        """Return what stands inside of a type from the types that it is made from."""
        own = Layer((), MappingNode({}, self.entries[name].key_span), None)
        value = self.entries[name].value
        layers = self.list_layers(own._replace(node=value) if isinstance(value, MappingNode) else own, name)
        inner = [layer.node.get("components") for layer in layers[1:]]
        return frozenset(key for each in inner if isinstance(each, MappingNode) for key in each.entries)

    def lay_type(self, name: str, own: MappingNode) -> MappingNode:
        """Return a type with what it is made from laid under it, and the keys that are about the type itself."""
        body = self._table.get_body(TypeExpression(name, list_generic_names(self.entries[name])))
        inherited = body.entries if body else {}
        own_keys = {entry.key: entry for entry in own if entry.key not in inherited}
        return MappingNode({**inherited, **own_keys}, own.span)

    def lay_instance(self, own: MappingNode, key: str) -> MappingNode:
        """Return a component with its type laid under it; one of no type as it is."""
        reference = _get_type_reference(own)
        expression = self._table.find_type(reference, key) if reference else None
        body = self._table.get_body(expression) if expression else None
        if body is None:
            return own
        return InstanceOverlay(self._diagnostics, self._table.may_replace).lay_over_instance(body, own, key)

    def renew_type(self, root: MappingNode, name: str) -> None:
        """Read a component type from the tree again."""
        library = library_of_type(name)
        if library is None:
            types = root.get("component_types")
            entry = types.entries.get(name) if isinstance(types, MappingNode) else None
        else:
            entry = _read_library_type(root, library, name)
        if entry is None:
            self.entries.pop(name, None)
        else:
            self.entries[name] = entry
        self._table = TypeTable(self.entries, self._diagnostics)


def _get_type_reference(node: MappingNode) -> ScalarNode | None:
    reference = node.get("same_as" if "same_as" in node.entries else "is")
    return reference if isinstance(reference, ScalarNode) and reference.value is not None else None


def _read_library_type(root: MappingNode, library: str, name: str) -> MappingEntry | None:
    """Return one component type of a library, as the project knows it."""
    for entry in list_entries(root, "libraries"):
        types = find_value(entry.value, "component_types")
        own_name = name.removeprefix(f"{library}.")
        if entry.key == library and isinstance(types, MappingNode) and own_name in types.entries:
            node: YamlNode = MappingNode({own_name: types.entries[own_name]}, types.span)
            for key in (library, "libraries"):
                held_key = "component_types" if key == library else library
                node = MappingNode({held_key: MappingEntry(held_key, entry.key_span, node)}, entry.key_span)
            held = MappingNode({"libraries": MappingEntry("libraries", entry.key_span, node)}, entry.key_span)
            return list_type_entries(held).get(name)
    return None
