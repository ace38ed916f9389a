"""By what elements are recognised: features that several kinds have in the same form, and the marks of components."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations, ports_of
from archgen.compare.kinds.kind_spec import FeatureSpec
from archgen.model.component import Component
from archgen.model.path_resolver import title_from_id


def mark_values(*values: object) -> frozenset[str]:
    """Return the values that are known as marks of a feature."""
    return frozenset(str(value) for value in values if value not in {None, ""})


NAME_FEATURES = (
    FeatureSpec("name", 2, lambda _, element: letter_pairs(element.id)),
    FeatureSpec(
        "title",
        2,
        lambda _, element: word_set(element.title),
        lambda element: element.title in {title_from_id(element.id), element.id},
    ),
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
    return mark_values(*ports, *(port.type for port in ports_of(component)))


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
