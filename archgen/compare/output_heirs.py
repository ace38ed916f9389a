"""Outputs that are gone, and those of other components that took their place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.element_likeness import Feature, FeatureMap, find_likely_pairs
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.port_kinds import OUTPUT
from archgen.compare.match_elements import describe_element
from archgen.compare.version_pair import ComparedElement, ElementKey, VersionPair
from archgen.frozen import dataclass

_MESSAGE_WEIGHT = 3
"""What is on the wire counts apart from the type, which may have got another name with the output."""


@dataclass(frozen=True, slots=True)
class OutputHeir:
    """An output that is gone, and the output of another component that took its place. Common ids."""

    old_id: str
    new_id: str
    old_component: str
    new_component: str
    likeness: float


def has_lost_outputs(versions: VersionPair) -> bool:
    """Whether any output is gone."""
    return any(kind == "output" and versions.is_removed(kind, name) for kind, name in versions.elements_before)


def find_heirs(versions: VersionPair, relations: tuple[ElementRelations, ElementRelations]) -> Iterator[OutputHeir]:
    """Yield the outputs that another component has now: of one type, one topic, with the same readers."""
    lost_outputs = {
        name: _describe_output(relations[0], element.own_id)
        for (kind, name), element in versions.elements_before.items()
        if kind == "output" and versions.is_removed(kind, name)
    }
    new_outputs = {
        name: _describe_output(relations[1], name)
        for kind, name in versions.elements_after
        if kind == "output" and versions.is_added(kind, name)
    }
    for old_id, new_id, likeness in find_likely_pairs(lost_outputs, new_outputs):
        old_component, new_component = (component_of(("output", output_id), versions) for output_id in (old_id, new_id))
        if old_component != new_component:
            yield OutputHeir(old_id, new_id, old_component, new_component, likeness)


def _describe_output(relations: ElementRelations, output_id: str) -> FeatureMap:
    output = relations.architecture.outputs[output_id]
    # Unlike in `match_elements`, types are matched by now: one with another name is the same.
    types = relations.common_ids("type", [output.type]) or frozenset(filter(None, [output.type]))
    features = describe_element(OUTPUT, relations, output)
    message = relations.architecture.message_of(output)
    messages = relations.common_ids("message", [message]) or frozenset(filter(None, [message]))
    return {
        **features,
        "type": Feature(features["type"].weight, types),
        "message": Feature(_MESSAGE_WEIGHT, messages),
    }


def component_of(port_key: ElementKey, versions: VersionPair) -> str:
    """Return the common id of a port's component, empty for no port: its path is the old one where the port is gone."""
    element = versions.elements_before.get(port_key) or versions.elements_after.get(port_key)
    return element.parent_key[1] if element and element.parent_key else ""


def outputs_of(component: str, elements: Mapping[ElementKey, ComparedElement]) -> list[str]:
    """Return the common ids of a component's outputs in one of the versions."""
    return [
        name
        for (kind, name), element in elements.items()
        if kind == "output" and element.parent_key == ("component", component)
    ]


def sources_of(component: str, versions: VersionPair, *, side: int) -> frozenset[str]:
    """Return what a component reads in one of the versions."""
    connections = (versions.connections_before, versions.connections_after)[side]
    return frozenset(
        source
        for reader, sources in connections.sources_by_input.items()
        if component_of(("input", reader), versions) == component
        for source in sources
    )
