"""What component types are called: by their titles, with what their generic names stand for."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from functools import cached_property

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType
from archgen.model.parameter import format_parameter
from archgen.model.quantity import Quantity
from archgen.views.shapes import Text


@dataclass(frozen=True, slots=True)
class OwnValue:
    """A value that an instance gives itself, and where."""

    name: str
    text: str
    at: Span = NO_SPAN


@dataclass(frozen=True)
class TypeTexts:
    """Where the texts of component types are: each from its key to the next key of a type or a group in the file."""

    architecture: Architecture

    @cached_property
    def _starts(self) -> dict[str, list[tuple[int, int, bool]]]:
        """Where types and groups begin, by file, and whether it is a type."""
        types = [(each.at, True) for each in self.architecture.component_types.values()]
        starts: dict[str, list[tuple[int, int, bool]]] = {}
        for at, is_type in (*types, *((each.at, False) for each in self.architecture.groups.values())):
            starts.setdefault(at.file, []).append((at.line, at.column, is_type))
        return {file: sorted(each) for file, each in starts.items()}

    def contain(self, span: Span) -> bool:
        """Whether a place is in the text of a type."""
        starts = self._starts.get(span.file, [])
        position = bisect_right(starts, (span.line, span.column, True))
        return position > 0 and starts[position - 1][2]

    def list_own_values(self, component: Component) -> tuple[OwnValue, ...]:
        """Return what an instance says itself; of a reference, and of what is no instance, nothing."""
        if component.component_type is None or component.is_reference:
            return ()
        return tuple(
            each for each in _list_values(self.architecture, component) if each.text and not self.contain(each.at)
        )


def _list_values(architecture: Architecture, component: Component) -> Iterator[OwnValue]:
    """Yield the values of a component that may be a type's. A type's own texts are no place of an instance's."""
    component_type = find_component_type(architecture, component)
    for name in ("functionality", "description"):
        text = getattr(component, name)
        if text and component_type and text != getattr(component_type, name):
            yield OwnValue(name, text)
    for parameter in component.parameters.values():
        # What the component around hands in is said there.
        if parameter.handed_from is None:
            yield OwnValue(f"parameter {parameter.name}", format_parameter(parameter.value), parameter.value_at)
    yield OwnValue("role", component.role or "", component.role_at)
    for place, name in () if component.timing is None else _list_timing_places(component):
        value = getattr(component.timing, name, None)
        yield OwnValue(name, _write_value(value), place)
    for use in component.requirements:
        yield OwnValue("requirement", use.text, use.at)
    for indicator in component.performance:
        yield OwnValue("performance", indicator.title, indicator.at)


def _list_timing_places(component: Component) -> Iterator[tuple[Span, str]]:
    return ((span, key) for key, span in component.timing.places.items()) if component.timing else iter(())


def _write_value(value: object) -> str:
    """Return a value of timing as text; of what is a mapping nothing but that it is there."""
    if isinstance(value, Quantity | str | int):
        return str(value)
    return "written here" if value else ""


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
