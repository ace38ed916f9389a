"""What component types are called: by their titles, with what their generic names stand for."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType
from archgen.views.shapes import Text


def find_component_type(architecture: Architecture, component: Component) -> ComponentType | None:
    """Return the type that a component is made from; None where it is made from none, or from one that is not known."""
    return architecture.component_types.get(component.type_name)


def name_component_type(architecture: Architecture, component: Component) -> str:
    """Return the title of the type that a component is made from: `Filter<Pose>`; empty where it is made from none."""
    expression = component.component_type or ""
    known_type = find_component_type(architecture, component)
    _, bracket, bindings = expression.partition("<")
    return f"{known_type.title}{bracket}{bindings}" if known_type else expression


def type_page_link(component_type: ComponentType) -> Text:
    """Link to a component type, by its title."""
    return Text(component_type.title, ref=f"component_type:{component_type.id}")


def link_type(architecture: Architecture, component: Component) -> Text:
    """Link to the type that a component is made from, with what its generic names stand for."""
    known_type = find_component_type(architecture, component)
    reference = f"component_type:{known_type.id}" if known_type else None
    return Text(name_component_type(architecture, component), ref=reference)


def list_instances(architecture: Architecture, type_id: str) -> list[Component]:
    """Return the components that are made from a type, or from one that is made from it, in the order of the project."""
    derived = {type_id}
    while further := {
        each.id
        for each in architecture.component_types.values()
        if each.id not in derived and each.base_name in derived
    }:
        derived |= further
    everything = {**architecture.components, **architecture.shells}
    return [each for each in everything.values() if each.type_name in derived]
