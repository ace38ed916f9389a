"""A table of slices, linked: with the types that a test gives for the shipped ones, and no interfaces but the test's."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compose import expand_project
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link.data_types.field_types import TypeSources
from archgen.link.declare.type_declaration import declare_types
from archgen.link.element_outline import build_outline
from archgen.link.project_linking import link_project
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import Interfaces
from archgen.model.message_types import ConceptualType
from archgen.syntax.yaml_tree import MappingNode


def link_table(
    table: MappingNode,
    project_id: str = "r",
    shipped: Mapping[str, ConceptualType] | None = None,
    lost_keys: frozenset[str] = frozenset(),
) -> tuple[Architecture, tuple[Diagnostic, ...]]:
    """Link a table as that of a project whose id and title are those of the test."""
    expansion = expand_project(table)
    outline = build_outline(expansion)
    return link_project(
        expansion,
        outline,
        default_id=project_id,
        default_title=project_id.capitalize(),
        declared_types=declare_types(table, outline, TypeSources(project_id, shipped or {}, "jazzy")),
        interfaces=Interfaces("jazzy"),
        lost_keys=lost_keys,
    )
