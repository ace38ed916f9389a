"""What rules see of a project: every component at any depth with all that it has from its type, and conceptual types.

Worked out from the tree when it is asked for, and again after an edit of it, for what the edit touches alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.link.mapping_values import list_scalars
from archgen.model.generic_names import read_generic_name
from archgen.passes.patterns.matching import COMPONENTS, IndexToken
from archgen.passes.patterns.pattern_shapes import ComponentBody, PortReference, ViewValue
from archgen.passes.patterns.type_layers import Layer, TypeLayers
from archgen.passes.patterns.view_elements import (
    ComponentIndex,
    ConceptualTypes,
    ViewElement,
    ViewReferences,
    is_instance,
    list_view_elements,
)
from archgen.passes.patterns.view_values import read_view_value
from archgen.passes.project_tree import ProjectTree
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode, find_value, list_entries

_PORT_KEYS = ("inputs", "outputs")


class ArchitectureView:
    """The view of a tree that is edited: say what was edited with `note_edit`."""

    def __init__(self, tree: ProjectTree) -> None:
        self.tree = tree
        self.elements: dict[str, ViewElement] = {}
        self._keys: tuple[str, ...] | None = None
        self._facts: Mapping[str, Mapping[str, dict[str, ViewValue]]] = {}
        self._hosts: Mapping[str, str] = {}
        self._index = ComponentIndex(self.get_component)
        self._bodies: dict[str, dict[str, ViewValue]] = {}
        self._expanded: dict[str, MappingNode] = {}
        self._users: dict[str, set[str]] = {}
        self._resolved: dict[int, tuple[ScalarNode, PortReference]] = {}
        self._component_types = TypeLayers(tree.root)
        self.types = ConceptualTypes(tree)
        self.references = ViewReferences(self.elements, self._list_outputs)
        type_entries = self._component_types.list_used(tree.root)
        inherited_ids = {name: self._component_types.list_inherited(name) for name in type_entries}
        for element in list_view_elements(tree.root, type_entries, inherited_ids):
            self._add(element)
        self.type_keys = {each.type_name: key for key, each in self.elements.items() if each.kind == "type"}
        for key in self.elements:
            self._resolve_sources(key)

    # What rules ask.

    def list_elements(self, section: str) -> Sequence[str]:
        """Return the paths of all components, or the names of what stands in another section, in order."""
        if section == "types":
            return self.types.list_names()
        if section != COMPONENTS:
            return tuple(self._facts.get(section, ()))
        if self._keys is None:
            self._keys = tuple(self.elements)
        return self._keys

    def get_element(self, section: str, name: str) -> dict[str, ViewValue] | None:
        """Return what an element of a section has, None where there is none."""
        if section == COMPONENTS:
            return self.get_component(name)
        return self.get_type(name) if section == "types" else self._facts.get(section, {}).get(name)

    def get_component(self, path: str) -> dict[str, ViewValue] | None:
        """Return what a component has, None where there is none."""
        if path not in self.elements:
            return None
        if path not in self._bodies:
            self._bodies[path] = self._make_body(self.elements[path])
        return self._bodies[path]

    def find_having(self, token: IndexToken) -> Sequence[str]:
        """Return the paths of the components that the index knows by a token, in order."""
        return self._index.find_having(token)

    def count_having(self, token: IndexToken) -> int:
        """Return how many components the index knows by a token."""
        return self._index.count_having(token)

    def get_type(self, name: str) -> dict[str, ViewValue] | None:
        """Return what a conceptual type has, None where there is none."""
        return self.types.get_body(name)

    def is_a(self, name: str, type_name: str) -> bool:
        """Whether a conceptual type is one, or made from a generic one; whether a component, or its type, is made from another."""
        if name == type_name or read_generic_name(name).base == type_name:
            return True
        key = name if name in self.elements else self.type_keys.get(read_generic_name(name).base, "")
        names = {each.type_name for each in self.list_layers(key)} if key in self.elements else set()
        return any(each is not None and type_name in (each, self.type_keys.get(each)) for each in names)

    def show_facts(self, facts: Mapping[str, Mapping[str, dict[str, ViewValue]]], hosts: Mapping[str, str]) -> None:
        """Show what was found out about the linked project: other sections, and the host of each component."""
        for key in self.elements:
            if hosts.get(key) != self._hosts.get(key):
                self._mark_stale(key)
        self._facts, self._hosts = facts, hosts

    def find_key(self, component_id: str) -> str | None:
        """Return the path that rules know a component by: of what stands inside of an instance, that in its type."""
        if component_id in self.elements:
            return component_id
        parent, _, name = component_id.rpartition(".")
        outer = self.find_key(parent) if parent else None
        for layer in self.list_layers(outer) if outer is not None else ():
            holder = self.type_keys.get(layer.type_name) if layer.type_name else outer
            if f"{holder}.{name}" in self.elements:
                return f"{holder}.{name}"
        return None

    # What edits ask.

    def list_layers(self, key: str) -> list[Layer]:
        """Return where a component has its values from: its own place, its type's, that type's type's, and so on."""
        element = self.elements[key]
        node = self._node_of(element)
        body = node if isinstance(node, MappingNode) else MappingNode({}, self.tree.find_place(element.path))
        own_type = element.type_name if element.kind == "type" else None
        return self._component_types.list_layers(Layer(element.path, body, None), own_type)

    def remember_reference(self, node: ScalarNode, reference: PortReference) -> None:
        """Keep what a reference that a rule wrote means."""
        self._resolved[id(node)] = (node, reference)

    def find_reference(self, node: YamlNode) -> PortReference | None:
        """Return what a reference in the tree means."""
        found = self._resolved.get(id(node))
        return found[1] if found else None

    def write_type_name(self, name: str) -> str:
        """Return the name of a component type as it is written, of the path that rules know it by."""
        base = read_generic_name(name).base
        element = self.elements.get(base)
        is_type = element is not None and element.kind == "type"
        return f"{element.type_name}{name[len(base) :]}" if element is not None and is_type else name

    def note_edit(self, key: str, layer: Layer) -> None:
        """Work out anew what an edit at a layer of a component touches."""
        if layer.type_name is not None or self.elements[key].type_name is not None:
            name = layer.type_name or self.elements[key].type_name
            self._renew_type(str(name))
        self._mark_stale(key)

    def note_type_edit(self) -> None:
        """Read the conceptual types again."""
        self.types.forget_bodies()

    def add_element(self, element: ViewElement) -> None:
        """Take up a component that was written into the tree."""
        if element.type_name is not None:
            self._renew_type(element.type_name)
            if element.kind == "type":
                self.type_keys[element.type_name] = element.key
        self._add(element)
        self._mark_around(element)
        self._resolve_sources(element.key)
        self.references.forget_names()

    def remove_element(self, key: str) -> None:
        """Forget a component that was taken out of the tree, with all that stood in it."""
        self._mark_around(self.elements[key])
        for inner in [each for each in self.elements if each == key or each.startswith(f"{key}.")]:
            element = self.elements[inner]
            self._mark_stale(inner)
            del self.elements[inner]
            self._keys = None
            if element.kind == "type" and element.type_name:
                del self.type_keys[element.type_name]
            if element.type_name is not None:
                self._renew_type(element.type_name)
        self.references.forget_names()

    # How it is worked out.

    def _add(self, element: ViewElement) -> None:
        self.elements[element.key] = element
        self._keys = None
        self._index.add(element.key)
        self._mark_stale(element.key)

    def _node_of(self, element: ViewElement) -> YamlNode | None:
        if element.type_name is None:
            return self.tree.get(element.path)
        # The types of libraries name one another without their library: here they are as the project knows them.
        entry = self._component_types.entries.get(element.type_name)
        node = entry.value if entry else None
        for inner_id in element.inner_ids:
            node = find_value(node, "components", inner_id)
        return node

    def _expand(self, key: str) -> MappingNode:
        """Return what a component has with all of its types laid under it."""
        if key not in self._expanded:
            layers = self.list_layers(key)
            for layer in layers:
                if layer.type_name is not None:
                    self._users.setdefault(layer.type_name, set()).add(key)
            element, own = self.elements[key], layers[0].node
            is_type = element.kind == "type" and element.type_name in self._component_types.entries
            self._expanded[key] = (
                self._component_types.lay_type(str(element.type_name), own)
                if is_type
                else self._component_types.lay_instance(own, key)
            )
        return self._expanded[key]

    def _list_outputs(self, key: str) -> Sequence[str]:
        outputs = self._expand(key).get("outputs")
        return tuple(outputs.entries) if isinstance(outputs, MappingNode) else ()

    def _make_body(self, element: ViewElement) -> dict[str, ViewValue]:
        expanded = self._expand(element.key)
        body = ComponentBody({"kind": element.kind, "id": element.id})
        body.path = element.key
        if element.parent is not None:
            body["in"] = element.parent
        if element.key in self._hosts:
            body["host"] = self._hosts[element.key]
        # What a type's ports pass on from inside is inside of what is made from it, too.
        moves = {
            self.type_keys[each.type_name]: element.key for each in self.list_layers(element.key) if each.type_name
        }
        for entry in expanded:
            body[entry.key] = read_view_value(entry.value, self.find_reference, moves)
        for key in ("is", "same_as"):
            name = body.get(key)
            base = read_generic_name(name).base if isinstance(name, str) else ""
            if isinstance(name, str) and self.type_keys.get(base, base) != base:
                body[key] = self.type_keys[base] + name[len(base) :]
        return body

    def _resolve_sources(self, key: str) -> None:
        """Resolve what the ports of a component name in its own place: what its type writes is resolved there."""
        own = self.list_layers(key)[0].node
        for item in list_scalars(own.get("from")):
            self._resolve_item(item, key, is_output=False)
        for port_key in _PORT_KEYS:
            for port in list_entries(own, port_key):
                body = port.value if isinstance(port.value, MappingNode) else MappingNode({}, port.key_span)
                for item in list_scalars(body.get("from")):
                    self._resolve_item(item, key, is_output=port_key == "outputs")
                for item in list_scalars(body.get("to")):
                    self._resolve_target(item, key)

    def _resolve_item(self, node: ScalarNode, key: str, *, is_output: bool) -> None:
        if id(node) not in self._resolved:
            reference = self.references.resolve(node.text, key, is_output=is_output, at=node)
            if reference is not None:
                self.remember_reference(node, reference)

    def _resolve_target(self, node: ScalarNode, key: str) -> None:
        """Resolve what an output is written to: an input of a component beside it."""
        name, _, port = node.text.rpartition(".")
        reader = f"{self.elements[key].parent}.{name}"
        if name and reader in self.elements:
            self._resolved[id(node)] = (node, PortReference(reader, port, at=node))

    def _renew_type(self, name: str) -> None:
        """Read a component type from the tree again, and what is made from it."""
        self._component_types.renew_type(self.tree.root, name)
        if name in self.type_keys:
            self._mark_stale(self.type_keys[name])
        for key in self._users.pop(name, ()):
            self._mark_stale(key)

    def _mark_stale(self, key: str) -> None:
        self._bodies.pop(key, None)
        self._expanded.pop(key, None)
        self._index.mark_stale(key)
        element = self.elements.get(key)
        if element and element.kind == "type" and element.type_name in self._users:
            for user in self._users.pop(element.type_name):
                self._mark_stale(user)

    def _mark_around(self, element: ViewElement) -> None:
        """Work out anew what holds a component that came or went: each has all that stands in it."""
        parent = element.parent
        while parent is not None and parent in self.elements:
            self._mark_stale(parent)
            parent = self.elements[parent].parent


def find_instance(view: ArchitectureView, key: str) -> bool:
    """Whether a component is made from a type, and seen with what it has from it alone."""
    element = view.elements[key]
    return element.kind == "component" and is_instance(view.list_layers(key)[0].node)
