"""By what elements are recognised: features that several kinds have in the same form, and the marks of components."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from operator import attrgetter
from typing import Any

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.kind_spec import FeatureSpec
from archgen.model.component import Component, list_component_ports
from archgen.model.path_resolver import title_from_id


def mark_values(*values: object) -> frozenset[str]:
    """Return the values that are known as marks of a feature."""
    return frozenset(str(value) for value in values if value not in {None, ""})


def name_features(find_name: Callable[[Any], str]) -> tuple[FeatureSpec, FeatureSpec]:
    """Return the features of a name, and of the title, which may be made from it."""

    def is_generated(element: Any) -> bool:  # noqa: ANN401 - any element with a title
        return element.title in {title_from_id(find_name(element)), find_name(element)}

    return (
        FeatureSpec("name", 2, lambda _, element: letter_pairs(find_name(element))),
        FeatureSpec("title", 2, lambda _, element: word_set(element.title), is_generated),
    )


NAME_FEATURES = name_features(attrgetter("id"))


def values_feature(weight: float, attributes: Iterable[str]) -> FeatureSpec:
    """Return the feature of all that some attributes say, each with its name."""

    def mark(_: ElementRelations, element: object) -> frozenset[str]:
        values = ((name, getattr(element, name, None)) for name in attributes)
        return frozenset(f"{name}: {value}" for name, value in values if value)

    return FeatureSpec("values", weight, mark)


def value_feature(name: str, weight: float, *attributes: str) -> FeatureSpec:
    """Return the feature of some values."""
    return FeatureSpec(
        name, weight, lambda _, element: mark_values(*(getattr(element, attribute) for attribute in attributes))
    )


def reference_feature(name: str, weight: float, kind: str, attribute: str) -> FeatureSpec:
    """Return the feature of the elements of a kind that an attribute names: one, or several."""

    def mark(relations: ElementRelations, element: object) -> frozenset[str]:
        named = getattr(element, attribute)
        return relations.common_ids(kind, named if isinstance(named, tuple) else [named])

    return FeatureSpec(name, weight, mark)


def nodes_feature(kind: str, weight: float) -> FeatureSpec:
    """Return the feature of the nodes that run at an element of a kind, or implement it."""
    return FeatureSpec(
        "nodes",
        weight,
        lambda relations, element: relations.common_ids("node", relations.nodes_by_place[f"{kind}:{element.id}"]),
    )


def users_feature(kind: str, weight: float, user_kind: str) -> FeatureSpec:
    """Return the feature of the elements of a kind that name an element."""
    return FeatureSpec(
        "users",
        weight,
        lambda relations, element: relations.common_ids(user_kind, relations.users_by_element[f"{kind}:{element.id}"]),
    )


def text_feature(weight: float, *names: str) -> FeatureSpec:
    """Return the feature of the words of some texts."""
    return FeatureSpec(
        "text",
        weight,
        lambda _, element: frozenset[str]().union(*(word_set(getattr(element, name)) for name in names)),
    )


def mark_ports(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return the names of a component's ports with their direction, and their types."""
    # The direction is part of the mark, so that an input and an output of one name are not alike.
    ports = [f"> {port.name}" for port in component.inputs.values()]
    ports += [f"{port.name} >" for port in component.outputs.values()]
    return mark_values(*ports, *(port.type for port in list_component_ports(component)))


def mark_neighbours(relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return the common ids of the components that a component reads from or is read by."""
    sources = [source for port in component.inputs.values() for source in relations.outputs_by_input[port.id]]
    readers = [reader for port in component.outputs.values() for reader in relations.readers_by_output[port.id]]
    return relations.common_ids("component", list_port_holders([*sources, *readers]))


def list_last_names(component_ids: Sequence[str]) -> list[str]:
    """Return the last part of each component's id."""
    return [component_id.rpartition(".")[2] for component_id in component_ids]


def list_port_holders(ports: Sequence[str]) -> list[str]:
    """Return the id of the component that has each port."""
    return [port.rpartition(".")[0] for port in ports]


def mark_performance(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return each performance of a component as one mark."""
    return mark_values(
        *(
            f"{performance.id} {performance.accuracy} {performance.execution_time}"
            for performance in component.performance
        )
    )


def mark_timing(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return behaviour, rate and longest execution time of a component."""
    timing = component.timing
    return mark_values(timing.behaviour, timing.rate, timing.wcet) if timing else frozenset()
