"""Put a component that a rule writes anew into the tree: into another one, a group, the component types or a library."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics.element_origins import TreePath
from archgen.model.element_ids import is_id
from archgen.passes.patterns.architecture_view import ArchitectureView, find_instance
from archgen.passes.patterns.data_edits import are_inside, make_data_node
from archgen.passes.patterns.edit_values import EditError, expand_value
from archgen.passes.patterns.layer_choice import TYPE_NAME_KEYS, DataPath
from archgen.passes.patterns.pattern_shapes import (
    INNER_KEY,
    ComponentBody,
    ViewValue,
)
from archgen.passes.patterns.view_elements import ElementKind, ViewElement, list_inside, path_of_type
from archgen.passes.patterns.view_words import VIRTUAL_KEYS
from archgen.schema.short_forms import find_form

_FORMS = {"component": find_form("component"), "group": find_form("group"), "type": find_form("component_type")}


def write_new_component(
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
