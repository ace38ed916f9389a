"""All elements of an architecture that may have properties and hints, by kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.language.language_tables import ANNOTATED_KINDS, SECTION_KINDS
from archgen.model.architecture import Architecture
from archgen.model.element_annotations import ElementAnnotations, PropertyDeclaration

_LISTED_APART = frozenset({"component_types", "nodes", "types"})
"""Sections of which some elements were not written here."""


class Annotated(Protocol):
    """An element of any kind."""

    @property
    def annotations(self) -> ElementAnnotations:
        """Its properties and hints."""

    @property
    def at(self) -> Span:
        """Where it is written."""


class AnnotatedElement(NamedTuple):
    """An element with its kind, its complete id, and the id of the element that findings about it name."""

    kind: str
    id: str
    element: Annotated
    is_expected: bool = True
    """Whether it has what is required of its kind: what holds others, and what nobody wrote, need not."""

    @property
    def owner_id(self) -> str:
        """The component of a port; of anything else its own id."""
        return self.id.rpartition(".")[0] if self.kind in {"input", "output"} else self.id

    def lacks(self, declared: PropertyDeclaration) -> bool:
        """Whether it does not have a declared property, and is of a kind that this names."""
        return self.is_expected and self.kind in declared.of and declared.id not in self.element.annotations.properties


def list_annotated_elements(architecture: Architecture) -> Iterator[AnnotatedElement]:
    """Yield every element that was written; components and ports of instances included, types of libraries not."""
    for section, kind in SECTION_KINDS.items():
        if kind in ANNOTATED_KINDS and section not in _LISTED_APART:
            elements: Mapping[str, Annotated] = getattr(architecture, section)
            yield from (AnnotatedElement(kind, id_, element) for id_, element in elements.items())
    for each in architecture.component_types.values():
        if each.library is None:
            yield AnnotatedElement("component_type", each.id, each, is_expected=not each.is_abstract)
    for component in architecture.list_described_components():
        yield AnnotatedElement("component", component.id, component, is_expected=not component.children)
        yield from (AnnotatedElement("input", port.id, port) for port in component.inputs.values())
        yield from (AnnotatedElement("output", port.id, port) for port in component.outputs.values())
    for type_ in architecture.types.values():
        if type_.origin == "project" and type_.at.file and type_.library is None:
            yield AnnotatedElement("type", type_.name, type_)
    for node in architecture.nodes.values():
        if node.written:
            yield AnnotatedElement("node", node.id, node)
