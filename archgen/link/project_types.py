"""Declare the types of a loaded project, with those that ship for its distribution."""

from __future__ import annotations

from dataclasses import replace

from archgen.compose import ExpandedProject
from archgen.link.data_types.field_types import TypeSources
from archgen.link.declare.section_declaration import declare_project
from archgen.link.declare.type_declaration import DeclaredTypes, declare_types
from archgen.link.element_outline import ElementOutline
from archgen.link.library_data_types import add_library_types, list_message_packages
from archgen.link.shipped_types import load_shipped_types
from archgen.model.known_interfaces import guess_distro
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import MappingNode


def declare_project_types(
    loaded_project: LoadedProject,
    merged_table: MappingNode,
    expansion: ExpandedProject,
    outline: ElementOutline,
    damaged_elements: frozenset[str] = frozenset(),
) -> DeclaredTypes:
    """Return the project's types: in `damaged_elements` something could not be read, which may seem to be missing."""
    distro = guess_distro(loaded_project.distro)
    project_id = declare_project(merged_table, loaded_project.id, loaded_project.title).id
    library_types = add_library_types(merged_table, expansion, outline)
    sources = TypeSources(
        project_id,
        load_shipped_types(distro),
        distro,
        loaded_project.lost_keys,
        damaged_elements,
        loaded_project.partial,
        library_types.library_ids,
        list_message_packages(merged_table),
    )
    declared = declare_types(library_types.root, outline, sources)
    return replace(declared, diagnostics=(*declared.diagnostics, *library_types.diagnostics))
