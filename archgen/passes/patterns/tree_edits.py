"""Write what rules find to write: each value goes where the element that it belongs to is declared.

A port of an instance is declared in its type, what it takes its data from at the instance; a type of a library stands in
the library.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.element_ids import is_id
from archgen.passes.patterns.architecture_view import ArchitectureView, find_instance
from archgen.passes.patterns.edit_values import (
    EditError,
    are_inside,
    drop_data,
    expand_value,
    fill_key,
    fill_pattern,
    make_data_node,
    merge_data,
)
from archgen.passes.patterns.expressions import EditKind, RuleEdit
from archgen.passes.patterns.matching import COMPONENTS
from archgen.passes.patterns.model_facts import ModelFacts
from archgen.passes.patterns.pattern_shapes import (
    INNER_KEY,
    Bindings,
    ComponentBody,
    PatternEntry,
    PortReference,
    ViewValue,
)
from archgen.passes.patterns.type_layers import Layer
from archgen.passes.patterns.view_elements import ElementKind, ViewElement, list_inside, path_of_type
from archgen.passes.patterns.view_values import VIRTUAL_KEYS
from archgen.schema.short_forms import find_form
from archgen.syntax.yaml_tree import ScalarNode, SequenceNode, YamlNode, find_value

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


_FORMS = {"component": find_form("component"), "group": find_form("group"), "type": find_form("component_type")}


def _write_new_component(
    view: ArchitectureView, key: str, value: Mapping[str, ViewValue], origin: TreePath
) -> list[tuple[DataPath, ViewValue]]:
    """Write a component that there is not yet; return what its ports take data from, which is still to be written.

    Sources come last: they are named as they are seen from the component, which must be in the view by then.
    Raise EditError where it cannot stand.
    """
    parent, dot, name = key.rpartition(".")
    if not is_id(name):
        message = f"`{name}` is no id, so nothing can be called so"
        raise EditError(message, "`snake(...)` in `let` makes one of any text")
    # `parts.filter_of_pose` is a new type of the library `parts`.
    library = parent if parent not in view.elements and view.tree.get(("libraries", parent)) else None
    if library is not None:
        parent, dot = "", ""
    kind: ElementKind = "component" if dot else "group" if value.get("kind") == "group" and library is None else "type"
    if dot:
        _require_open(view, key, parent)
    type_name = view.elements[parent].type_name if dot else None if kind == "group" else key
    inner_ids = (*view.elements[parent].inner_ids, name) if dot else ()
    path = _choose_path(view, kind, key)
    copied_from = value.path if isinstance(value, ComponentBody) else ""
    body, sources = _split_sources({k: v for k, v in value.items() if k not in VIRTUAL_KEYS}, copied_from)
    content = expand_value(body if library is None else _leave_library(body, library), _FORMS[kind])
    view.tree.set(path, make_data_node(content, view.tree.find_place(origin), copied_from), origin)
    view.add_element(ViewElement(key, name, kind, parent if dot else None, path, type_name, inner_ids))
    for inner in list_inside(view.tree.get(path), key, path, type_name, inner_ids, frozenset()):
        view.add_element(inner)
    return sources


def _require_open(view: ArchitectureView, key: str, parent: str) -> None:
    """Raise EditError unless something can be put into a component."""
    if parent not in view.elements:
        message = f"`{key}` is to stand in `{parent}`, which there is not"
        raise EditError(message, "its path begins with that of what it stands in: `$outer.name`")
    if find_instance(view, parent):
        message = f"`{key}` is to stand in an instance, which has what its type has"
        raise EditError(message, f"write it into the type of `{parent}`: `kind: type` finds types")


def _choose_path(view: ArchitectureView, kind: ElementKind, key: str) -> TreePath:
    """Return where in the tree something new is written."""
    parent, _, name = key.rpartition(".")
    if kind == "component":
        return (*view.elements[parent].path, INNER_KEY, name)
    return ("groups", name) if kind == "group" else path_of_type(key)


def _leave_library(body: Mapping[str, ViewValue], library: str) -> dict[str, ViewValue]:
    """Return what is to stand in a library, whose types name one another without it."""
    return {
        key: _leave_library(value, library)
        if isinstance(value, dict)
        else value.removeprefix(f"{library}.")
        if key in TYPE_NAME_KEYS and isinstance(value, str)
        else value
        for key, value in body.items()
    }


def _split_sources(
    body: dict[str, ViewValue], copied_from: str
) -> tuple[dict[str, ViewValue], list[tuple[DataPath, ViewValue]]]:
    """Return what a new component has without what its ports take data from, and that by path.

    What a copy names inside of itself stays: it means the copy's own.
    """
    kept, sources = dict(body), list[tuple[DataPath, ViewValue]]()
    if "from" in body and not are_inside(body["from"], copied_from):
        sources.append((("from",), kept.pop("from")))
    for side in ("inputs", "outputs"):
        ports = kept.get(side)
        if not isinstance(ports, dict):
            continue
        kept[side] = kept_ports = dict(ports)
        for name, port in ports.items():
            if isinstance(port, dict) and "from" in port and not are_inside(port["from"], copied_from):
                kept_ports[name] = {key: each for key, each in port.items() if key != "from"}
                sources.append(((side, name, "from"), port["from"]))
    return kept, sources


_TYPE_NAME_PATHS = frozenset((key,) for key in TYPE_NAME_KEYS)
_PORT_SECTIONS = frozenset({"inputs", "outputs"})
_ID_SECTIONS = frozenset({"inputs", "outputs", "operations"})


class TreeEditor:
    """Applies edits of rules to the tree of a view, and tells the view."""

    def __init__(self, view: ArchitectureView) -> None:
        self._view = view
        self._tree = view.tree
        self.has_new_names = False
        """Whether components or outputs came or went: references may be taken for others."""
        self.facts: ModelFacts | None = None
        """What is known of the linked project, where rules ask for it."""

    def find_path(self, section: str, name: str) -> TreePath | None:
        """Return where something that there is is written, None where nobody wrote it."""
        if section == COMPONENTS:
            return self._view.elements[name].path if name in self._view.elements else None
        if self._view.get_element(section, name) is None:
            return None
        if section == "types":
            return self._view.types.find_path(name)
        return self.facts.find_path(section, name) if self.facts and section in SECTION_KINDS else None

    def apply(self, edits: Sequence[RuleEdit], bindings: Bindings, origin: TreePath) -> bool:
        """Write what a rule writes under some bindings; say whether that changed anything. Raise EditError.

        `origin` is where what the rule found is written.
        """
        count = self._tree.edit_count
        for edit in edits:
            for section, entry in edit.pattern.entries:
                if section == COMPONENTS:
                    self._edit_component(edit.kind, entry, bindings, origin)
                elif section == "types":
                    self._edit_type(edit.kind, entry, bindings, origin)
                elif self.facts is not None:
                    self._edit_element(self.facts, edit.kind, section, entry, bindings, origin)
        return self._tree.edit_count != count

    def _edit_component(self, kind: EditKind, entry: PatternEntry, bindings: Bindings, origin: TreePath) -> None:
        key, value = fill_key(entry.key, bindings), fill_pattern(entry.value, bindings)
        is_known = key in self._view.elements
        if kind == "drop":
            if is_known:
                self._drop_component(key, value)
            return
        if value is not None and not isinstance(value, dict):
            raise EditError(f"`{key}` is to be a component, and what is written of it is no mapping")
        host = None if isinstance(value, ComponentBody) else (value or {}).get("host")
        if not is_known:
            self._add_component(key, value or {}, origin)
        if host is not None:
            self._write_host(key, host)
        if not is_known:
            return
        element = self._view.elements[key]
        form = find_form({"type": "component_type", "group": "group"}.get(element.kind, "component"))
        expanded = expand_value(
            {k: v for k, v in (value or {}).items() if k not in VIRTUAL_KEYS and k != INNER_KEY}, form
        )
        inner = value.get(INNER_KEY) if isinstance(value, ComponentBody) else None
        for name, each in inner.items() if isinstance(inner, dict) else ():
            if f"{key}.{name}" not in self._view.elements and not find_instance(self._view, key):
                self._add_component(f"{key}.{name}", _copy_inner(each, key), origin)
        for name, each in expanded.items() if isinstance(expanded, dict) else ():
            self._write(kind, key, (name,), each)

    def _drop_component(self, key: str, value: ViewValue) -> None:
        """Take a component out, or something of it."""
        if isinstance(value, dict):
            for name, each in value.items():
                self._drop(key, (name,), each)
        elif value is None:
            path = self._view.elements[key].path
            self._tree.drop(path)
            if not self._tree.get_mapping(path[:-1]):
                self._tree.drop(path[:-1])
            self._view.remove_element(key)
            self.has_new_names = True

    def _add_component(self, key: str, value: Mapping[str, ViewValue], origin: TreePath) -> None:
        sources = _write_new_component(self._view, key, value, origin)
        self.has_new_names = True
        for path, each in sources:
            self._write("set", key, path, each)

    def _edit_type(self, kind: EditKind, entry: PatternEntry, bindings: Bindings, origin: TreePath) -> None:
        name, value = fill_key(entry.key, bindings), fill_pattern(entry.value, bindings)
        is_known = self._view.get_type(name) is not None
        path: TreePath = self._view.types.find_path(name)
        if kind == "drop":
            drop_data(self._view, path, value) if is_known else None
        else:
            expanded = expand_value(value, find_form("type"))
            merge_data(self._view, kind, path, expanded, path if is_known else origin)
        self._view.note_type_edit()

    def _edit_element(  # noqa: PLR0913, PLR0917 - what an edit is
        self,
        facts: ModelFacts,
        kind: EditKind,
        section: str,
        entry: PatternEntry,
        bindings: Bindings,
        origin: TreePath,
    ) -> None:
        """Write a node, host, container or link where it is written, or make a new one."""
        name, value = fill_key(entry.key, bindings), fill_pattern(entry.value, bindings)
        is_known = self._view.get_element(section, name) is not None
        if not is_known and not is_id(name):
            message = f"`{name}` is no id, so nothing can be called so"
            raise EditError(message, "`snake(...)` in `let` makes one of any text")
        path = facts.find_path(section, name)
        if path is None:
            message = f"the container `{name}` is brought along by a component, and is not written in `containers`"
            raise EditError(message, "declare it in `containers`")
        if kind == "drop":
            drop_data(self._view, path, value) if is_known else None
        else:
            expanded = expand_value(value, find_form(SECTION_KINDS[section]))
            if path[0] == "groups" and isinstance(expanded, dict) and "implements" in expanded:
                message = (
                    f"the node `{name}` is that of `{facts.elements[section][name]['implements']}`, and of nothing else"
                )
                raise EditError(message, "leave `implements` out, or make a node of another name")
            merge_data(self._view, kind, path, expanded, path if is_known else origin)
        self._note_place(path)
        facts.note_edit(section, name, path)

    def _write_host(self, key: str, value: ViewValue) -> None:
        """Write on which host a component runs where that is written: at its nodes, or their containers."""
        for path in self.facts.list_host_paths(key) if self.facts is not None else ():
            self._tree.set(path, make_data_node(value, self._tree.find_place(path)), path)
            self._note_place(path)

    def _note_place(self, path: TreePath) -> None:
        """Tell the view of the components that a path in the tree leads through."""
        for key, element in self._view.elements.items():
            if path[: len(element.path)] == element.path:
                self._view.note_edit(key, self._view.list_layers(key)[0])

    def _drop(self, key: str, path: DataPath, value: ViewValue) -> None:
        """Take something out of all places that a component has it from."""
        if isinstance(value, dict):
            for name, each in value.items():
                self._drop(key, (*path, name), each)
            return
        layers = self._view.list_layers(key)
        # What a type is made from is the type's own.
        for layer in layers[:1] if path[0] in TYPE_NAME_KEYS else layers:
            count = self._tree.edit_count
            drop_data(self._view, (*layer.path, *path), value)
            if self._tree.edit_count != count:
                self.has_new_names |= path[0] == "outputs"
                self._note(key, layer, path)

    def _write(self, kind: EditKind, key: str, path: DataPath, value: ViewValue) -> None:
        """Write a value at a path of a component: mappings key by key, where there is one already."""
        present = _get_value(self._view.get_component(key), path)
        if isinstance(value, dict) and isinstance(present, dict):
            for name, each in value.items():
                self._write(kind, key, (*path, name), each)
            return
        if path[0] in _ID_SECTIONS and len(path) > 1 and present is None and not is_id(path[1]):
            message = f"`{path[1]}` is no id, so no port can be called so"
            raise EditError(message, "`snake(...)` in `let` makes one of any text")
        if present is not None and present == value:
            return
        layer = choose_layer(self._view, key, path, present)
        place = WrittenPlace(key, layer, path, find_source(self._view, layer, path))
        span = self._tree.find_place(place.source)
        if path[-1] == "from" and (len(path) == 1 or path[0] in _PORT_SECTIONS):
            write_sources(self._view, kind, place, value)
        elif isinstance(value, dict) and path[0] in _PORT_SECTIONS:
            self._write_port(kind, place, value)
            return
        elif kind == "add" and isinstance(value, list):
            for item in value:
                self._tree.append(place.target, make_data_node(item, span), place.source)
        elif kind == "add" and present is not None:
            message = f"`add` finds `{present}` at `{'.'.join(path)}` of `{key}`, and not `{value}`"
            raise EditError(message, "`set` replaces it")
        else:
            node = make_data_node(self._name_types(path, value, layer), span)
            self._tree.set(place.target, node, place.source)
        self._note(key, layer, path)

    def _write_port(self, kind: EditKind, place: WrittenPlace, value: Mapping[str, ViewValue]) -> None:
        """Write a port that is new, or a section of new ports: first that it is there, then each of its keys."""
        self._tree.set(place.target, make_data_node({}, self._tree.find_place(place.source)), place.source)
        self._note(place.key, place.layer, place.path)
        for name, each in value.items():
            self._write(kind, place.key, (*place.path, name), each)

    def _note(self, key: str, layer: Layer, path: DataPath) -> None:
        if path[0] == "outputs":
            self.has_new_names = True
            self._view.references.forget_names()
        self._view.note_edit(key, layer)

    def _name_types(self, path: DataPath, value: ViewValue, layer: Layer) -> ViewValue:
        """Return the name of a component type as it is written at a layer: in a library without its library."""
        if path not in _TYPE_NAME_PATHS or not isinstance(value, str):
            return value
        name = self._view.write_type_name(value)
        return name.removeprefix(f"{layer.path[1]}.") if layer.path[0] == "libraries" else name


def _copy_inner(body: ViewValue, holder: str) -> ComponentBody:
    """Return what stands inside of a component as a part of its copy."""
    copy = ComponentBody(body if isinstance(body, dict) else {})
    copy.path = holder
    return copy


def _get_value(value: ViewValue, path: DataPath) -> ViewValue:
    for key in path:
        if not isinstance(value, dict) or key not in value:
            return None
        value = value[key]
    return value


def write_sources(view: ArchitectureView, kind: EditKind, place: WrittenPlace, value: ViewValue) -> None:
    """Write what a port, or a component, takes its data from; raise EditError for what there is not or is not seen there."""
    span = view.tree.find_place(place.source)
    is_output = place.path[0] == "outputs"
    type_name = place.layer.type_name
    writer = view.type_keys.get(type_name, place.key) if type_name else place.key
    nodes: list[ScalarNode] = []
    for item in value if isinstance(value, list) else [value]:
        reference = _find_target(view, item, writer, is_output=is_output)
        words = view.references.write(reference, writer, is_output=is_output)
        if words is None:
            message = f"`{reference}` cannot be named at `{writer}`: it lies outside of what is seen from there"
            raise EditError(message, "lead it through the ports of what stands around")
        node = ScalarNode(words, words, reference.span or span)
        view.remember_reference(node, reference)
        nodes.append(node)
    if kind == "set":
        view.tree.set(place.target, SequenceNode(list[YamlNode](nodes), span), place.source)
    for node in nodes if kind == "add" else ():
        view.tree.append(place.target, node, place.source)


def _find_target(view: ArchitectureView, item: ViewValue, writer: str, *, is_output: bool) -> PortReference:
    if isinstance(item, PortReference):
        return item
    text = str(item) if isinstance(item, str) else ""
    if text.startswith("self."):
        shell = writer if is_output else view.elements[writer].parent
        return PortReference(shell or "", text.removeprefix("self."), holder=shell or "")
    if text in view.elements:
        return PortReference(text, None)
    component, _, port = text.rpartition(".")
    if component not in view.elements:
        message = f"`{text}` is no port and no component"
        raise EditError(message, "a source is a path and a port: `$source.$port`, or `self.$port`")
    return PortReference(component, port)
