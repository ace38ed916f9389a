"""Declare component types: what they are called, what they are made from, and their ports."""

from __future__ import annotations

from archgen.compose import ExpandedProject
from archgen.compose.library_types import library_of_type
from archgen.compose.type_table import is_abstract, list_generic_names
from archgen.link import mapping_values
from archgen.model.component import ComponentType
from archgen.syntax.yaml_tree import MappingNode


def declare_component_types(expansion: ExpandedProject) -> dict[str, ComponentType]:
    """Return the component types of a project, by id."""
    types: dict[str, ComponentType] = {}
    for name, entry in expansion.type_entries.items():
        body, whole_body = mapping_values.get_body(entry), expansion.type_bodies[name]
        types[name] = ComponentType(
            id=name,
            title=mapping_values.get_title(body, name.rpartition(".")[2]),
            functionality=mapping_values.get_text(whole_body, "functionality"),
            description=mapping_values.get_text(whole_body, "description"),
            owner=mapping_values.get_text(body, "owner"),
            base=mapping_values.get_text(body, "is"),
            library=library_of_type(name),
            generic=list_generic_names(entry),
            is_abstract=is_abstract(entry),
            inputs=_read_port_types(whole_body, "inputs"),
            outputs=_read_port_types(whole_body, "outputs"),
            components=tuple(mapping_values.get_mapping(whole_body, "components").entries),
            at=entry.key_span,
        )
    return types


def _read_port_types(body: MappingNode, side: str) -> dict[str, str | None]:
    """Return the types of ports by id; those of outputs that are given on are not known here."""
    return {
        name: mapping_values.normalise_type_name(text) if (text := mapping_values.get_text(port, "type")) else None
        for name, _, port in mapping_values.iterate_elements(body, side)
    }
