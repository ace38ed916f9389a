"""What the linker knows about a tree that passes edit: instances written out, references resolved, ports joined."""

from __future__ import annotations

from functools import cached_property

from archgen import compose, link
from archgen.compose import ExpandedProject
from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass
from archgen.link import element_outline, mapping_values
from archgen.link.automatic_connections import join_ports
from archgen.link.declare.component_nodes import ComponentNodes
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.declare.node_declaration import resolve_implements
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.element_outline import ElementOutline
from archgen.link.port_sources import PortSources
from archgen.link.project_linking import make_resolver
from archgen.link.project_types import declare_project_types
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import Interfaces
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import MappingNode


@dataclass(eq=False)
class LinkedTree:
    """A merged project as the linker sees it. Each answer is worked out when it is asked for, once."""

    loaded_project: LoadedProject
    root: MappingNode
    interfaces: Interfaces

    @cached_property
    def expansion(self) -> ExpandedProject:
        """The project with its types written out."""
        project = self.loaded_project
        return compose.expand_project(self.root, project.incomplete_libraries, project.describe_missing_type)

    @cached_property
    def outline(self) -> ElementOutline:
        """Its groups, components and ports."""
        return element_outline.build_outline(self.expansion)

    @cached_property
    def declared_types(self) -> DeclaredTypes:
        """Its conceptual types."""
        return declare_project_types(self.loaded_project, self.root, self.expansion, self.outline)

    @cached_property
    def resolver(self) -> ReferenceResolver:
        """What resolves its references."""
        return make_resolver(self.expansion.root, self.outline, [])

    @cached_property
    def joined_sources(self) -> PortSources:
        """What each port takes its data from, with what follows by itself."""
        sources = PortSources(self.outline, self.resolver, self.declared_types.types)
        join_ports(self.outline, sources, self.resolver)
        sources.spread_media()
        return sources

    @property
    def joined_findings(self) -> list[Diagnostic]:
        """What is found where ports are joined."""
        return self.resolver.diagnostics if self.joined_sources else []

    @cached_property
    def _linked(self) -> tuple[Architecture, tuple[Diagnostic, ...]]:
        return link.link_project(
            self.expansion,
            # One of its own: linking writes into it.
            element_outline.build_outline(self.expansion),
            default_id=self.loaded_project.id,
            default_title=self.loaded_project.title,
            declared_types=self.declared_types,
            interfaces=self.interfaces,
            lost_keys=self.loaded_project.lost_keys,
            is_partial=self.loaded_project.partial,
        )

    @cached_property
    def node_targets(self) -> dict[str, tuple[str, ...]]:
        """What each node of the section of nodes implements, by complete ids."""
        return resolve_implements(self.expansion.root, self.resolver)

    @cached_property
    def component_nodes(self) -> ComponentNodes:
        """All nodes in normal form: those that are written, and those that components bring along."""
        return ComponentNodes(
            self.outline,
            self.expansion,
            mapping_values.get_mapping(self.expansion.root, "nodes"),
            self.node_targets,
            HandedParameters(self.outline, []),
            self.resolver,
        )

    @property
    def architecture(self) -> Architecture:
        """The linked architecture, before topics and planned nodes are derived."""
        return self._linked[0]
