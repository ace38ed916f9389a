"""Declare elements by the language's tables: what a key says by its value alone, then what takes the rest of the project."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial
from typing import Any, TypeVar

from archgen.language.language_tables import KEYS, OFFERS, SECTION_KINDS
from archgen.link import mapping_values
from archgen.link.declare.key_declaration import DECLARERS, NAMING_TYPES, KeyDeclarer
from archgen.link.reference_resolution import SECTIONS_OF_PLAIN_NAMES, ReferenceResolver
from archgen.link.value_readers import find_type, find_value_reader, list_held_keys, read_element, store_value
from archgen.model.architecture import Partner
from archgen.model.deployment import Host, Link, Resource
from archgen.model.element_annotations import PropertyDeclaration
from archgen.model.requirement import Requirement
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

Element = TypeVar("Element")
_SECTIONS = {kind: section for section, kind in SECTION_KINDS.items()}
_PLAIN_KINDS = {section: kind for kind, section in SECTIONS_OF_PLAIN_NAMES.items()}


def declare_sections(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Any]:
    """Declare the elements of which the tables say all, by section and id."""
    return {
        section: declare_elements(root, kind, DECLARED_CLASSES[kind], resolver)
        for section, kind in SECTION_KINDS.items()
        if kind in DECLARED_CLASSES
    }


def declare_elements(
    root: MappingNode, kind: str, made_class: type[Element], resolver: ReferenceResolver
) -> dict[str, Element]:
    """Declare the elements of a kind, by id."""
    section = mapping_values.get_mapping(root, _SECTIONS[kind])
    return {entry.key: declare_element(kind, made_class, entry, resolver) for entry in section}


def declare_element(
    kind: str,
    made_class: type[Element],
    entry: MappingEntry,
    resolver: ReferenceResolver,
    **own_fields: Any,  # noqa: ANN401 - of any field
) -> Element:
    """Declare an element: what is not written, or cannot be read, has the default of its class.

    `own_fields` are those that the declaration of its kind reads by itself.
    """
    body = mapping_values.get_body(entry)
    plain_class: type = made_class
    values = read_element(kind, plain_class, entry, body)
    for key, names, declare_key in _list_declarers(kind, plain_class):
        if key in body.entries:
            store_value(values, names, declare_key(body, key, entry.key, resolver))
    return made_class(**values, **own_fields)


@cache
def _list_declarers(kind: str, made_class: type) -> tuple[tuple[str, tuple[str, ...], KeyDeclarer], ...]:
    """Return the keys of a kind that say something together with the rest of the project, and how they are declared."""
    held_keys = list_held_keys(kind, made_class)
    return tuple(
        (key, names, declarer) for key, names in held_keys.items() if (declarer := find_declarer(kind, key)) is not None
    )


def find_declarer(kind: str, key: str) -> KeyDeclarer | None:
    """Return what declares a key, None where its value alone says all, and where the declaration of the kind does it."""
    part = find_type(kind, key)
    if f"{kind}.{key}" in DECLARERS:
        return DECLARERS[f"{kind}.{key}"]
    if find_value_reader(kind, key):
        return None
    named_kinds = [_PLAIN_KINDS.get(section) for section in OFFERS.get(KEYS[kind][key], ())]
    if part in NAMING_TYPES and len(named_kinds) == 1 and named_kinds[0]:
        return partial(NAMING_TYPES[part], kind=named_kinds[0])
    return DECLARERS.get(part)


DECLARED_CLASSES: Mapping[str, type] = {
    "partner": Partner,
    "requirement": Requirement,
    "property_declaration": PropertyDeclaration,
    "host": Host,
    "resource": Resource,
    "link": Link,
}
"""The classes of the kinds of which the tables say all; their sections are fields of the architecture."""
