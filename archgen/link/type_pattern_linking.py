"""Link component types by themselves, as if each had one instance that says nothing of its own.

What such an instance has is what the type says: a comparison holds the instances of a project against it.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compose import ExpandedProject, expand_project, list_type_entries
from archgen.compose.type_expressions import TypeExpression
from archgen.compose.type_table import TypeTable
from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.element_outline import build_outline
from archgen.link.project_linking import link_project
from archgen.model.architecture import Architecture
from archgen.model.component_type_patterns import PATTERN_GROUP, TypePatterns
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_OUTER_SECTIONS = ("component_types", "libraries", "types", "ros", "project")
"""What a type may refer to. Nodes, chains and the like are about instances."""


def link_type_patterns(merged_table: MappingNode, architecture: Architecture) -> TypePatterns:
    """Return what the component types of a project say, nothing for a project without any.

    What is wrong in them was reported where the project was linked.
    """
    if not architecture.component_types:
        return TypePatterns()
    outer_entries = {name: entry for name, entry in merged_table.entries.items() if name in _OUTER_SECTIONS}
    table = TypeTable(list_type_entries(merged_table), [])
    type_bodies = {
        name: table.get_body(TypeExpression(name, component_type.generic)) or MappingNode({}, component_type.at)
        for name, component_type in architecture.component_types.items()
    }
    expansion = expand_project(_write_patterns(outer_entries, type_bodies))
    patterns = _link_expansion(expansion, architecture)
    components = {**patterns.components, **patterns.shells}
    return TypePatterns(
        {_drop_group(component_id): component for component_id, component in components.items()},
        {node.implements[0]: node for node in patterns.nodes.values() if len(node.implements) == 1},
    )


def _write_patterns(outer_entries: Mapping[str, MappingEntry], type_bodies: Mapping[str, MappingNode]) -> MappingNode:
    """Return a project of one group, which has a component for each type."""
    components = {name: MappingEntry(name, body.span, body) for name, body in type_bodies.items()}
    groups = _nest_mapping(_nest_mapping(MappingNode(components, NO_SPAN), "components"), PATTERN_GROUP)
    return MappingNode({**outer_entries, **_nest_mapping(groups, "groups").entries}, NO_SPAN)


def _nest_mapping(value: MappingNode, key: str) -> MappingNode:
    return MappingNode({key: MappingEntry(key, NO_SPAN, value)}, NO_SPAN)


def _link_expansion(expansion: ExpandedProject, architecture: Architecture) -> Architecture:
    patterns, _ = link_project(
        expansion,
        build_outline(expansion),
        default_id=architecture.project.id,
        default_title=architecture.project.title,
        declared_types=DeclaredTypes(architecture.types),
        interfaces=architecture.interfaces,
    )
    return patterns


def _drop_group(component_id: str) -> str:
    return component_id.removeprefix(f"{PATTERN_GROUP}.")
