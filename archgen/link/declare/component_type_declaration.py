"""Declare component types: what they are called, what they are made from, their ports and their settings."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compose import ExpandedProject
from archgen.compose.library_types import library_of_type
from archgen.frozen import replace
from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import declare_parameters
from archgen.link.promise_reading import read_deprecation
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_element, read_operations, read_values
from archgen.model.component import ComponentType
from archgen.model.coordinate_frames import Frame
from archgen.model.promise import Deprecation
from archgen.syntax.yaml_tree import MappingNode


def declare_component_types(expansion: ExpandedProject, resolver: ReferenceResolver) -> dict[str, ComponentType]:
    """Return the component types of a project, by id. Owners of its own types that are no partners are reported.

    Whose a library's types are, those know who check the library by itself.
    """
    types: dict[str, ComponentType] = {}
    if not expansion.type_entries:
        return types
    from archgen.compose.type_table import is_abstract, list_generic_names

    for name, entry in expansion.type_entries.items():
        body, whole_body = mapping_values.get_body(entry), expansion.type_bodies[name]
        library = library_of_type(name)
        if library is None:
            resolver.resolve_owners(body, name, ())
        values = read_values("component_type", ComponentType, whole_body)
        # What a type does not inherit.
        values["title"] = mapping_values.get_title(body, name.rpartition(".")[2])
        values["version"] = mapping_values.get_text(body, "version")
        types[name] = ComponentType(
            **values,
            id=name,
            owner=mapping_values.get_text(body, "owner"),
            base=mapping_values.get_text(body, "is"),
            library=library,
            generic=list_generic_names(entry),
            is_abstract=is_abstract(entry),
            deprecated=_name_replacement(read_deprecation(body, name, resolver.diagnostics), expansion),
            inputs=_read_port_types(whole_body, "inputs"),
            outputs=_read_port_types(whole_body, "outputs"),
            components=tuple(mapping_values.get_mapping(whole_body, "components").entries),
            parameters=declare_parameters(whole_body),
            frames=tuple(_read_frames(whole_body)),
            inner_types=frozenset(_list_inner_types(whole_body)),
            at=entry.key_span,
        )
    return types


def _name_replacement(deprecation: Deprecation | None, expansion: ExpandedProject) -> Deprecation | None:
    """Return a deprecation with the type that replaces it, if there is one; what is not there was reported."""
    if deprecation is None or deprecation.use not in expansion.type_entries:
        return deprecation
    return replace(deprecation, target=deprecation.use)


def _read_port_types(body: MappingNode, side: str) -> dict[str, str | None]:
    """Return the types of ports by id; those of outputs that are passed on are not known here."""
    return {
        name: mapping_values.normalise_type_name(text) if (text := mapping_values.get_text(port, "type")) else None
        for name, _, port in mapping_values.iterate_elements(body, side)
    }


def _list_inner_types(body: MappingNode) -> Iterator[str]:
    """Yield the types that components inside name as they are written: instances of them are in no group."""
    for _, _, part in mapping_values.iterate_elements(body, "components"):
        for side in ("inputs", "outputs"):
            yield from filter(None, _read_port_types(part, side).values())
        for operation in read_operations(part, "operations").values():
            yield from operation.type_names
        for key in ("is", "same_as"):
            expression = mapping_values.get_text(part, key) or ""
            if "<" in expression:  # what generic names stand for
                yield mapping_values.normalise_type_name(expression)
        yield from _list_inner_types(part)


def _read_frames(body: MappingNode) -> Iterator[Frame]:
    """Yield the frames as they are written: what their names stand for, and who writes them, each instance says."""
    for _, entry, frame in mapping_values.iterate_elements(body, "frames"):
        rate = mapping_values.get_quantity(frame, "rate", "frequency")
        yield Frame(**read_element("frame", Frame, entry, frame), rate=rate)
