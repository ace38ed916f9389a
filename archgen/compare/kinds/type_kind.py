"""Conceptual types: their messages, what they say of them, and the types that their fields hold.

What a type with fields sends is compared as the definition of its message. Here is what no definition says: that a field
holds another conceptual type with the same message, and what is in a generic type, which is no message by itself.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.frame_kind import frame_reference
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext, Worsening
from archgen.compare.kinds.promise_keys import VERSION, deprecation_key
from archgen.compare.kinds.shared_keys import ANNOTATIONS, mark_values, prose_key, text_feature
from archgen.model.message_types import ConceptualType, DataField


def _inner_type_key(name: str) -> KeySpec:
    return KeySpec(name, lambda each, context: context.common_id("type", getattr(each, name)), refers_to="type")


def _is_own_type(conceptual_type: ConceptualType) -> bool:
    return conceptual_type.origin == "project" and bool(conceptual_type.at.file)


def _list_types(version: ArchitectureVersion) -> Mapping[str, ConceptualType]:
    return {
        name: conceptual_type
        for name, conceptual_type in version.architecture.types.items()
        if conceptual_type.origin != "message" or conceptual_type.at.file
    }


def _mark_ports(relations: ElementRelations, conceptual_type: ConceptualType) -> frozenset[str]:
    ports = relations.users_by_element[f"type:{conceptual_type.name}"]
    return relations.common_ids("output", ports) | relations.common_ids("input", ports)


def _read_fields(conceptual_type: ConceptualType, context: ReadContext) -> Mapping[str, str]:
    """Return the conceptual types that fields hold, by the field; of a generic type all that is written."""
    if not _is_own_type(conceptual_type):
        return {}
    types = context.architecture.types
    values = {
        f"{part}.{field.name}" if part else field.name: _describe_field(field, context)
        for part, field in conceptual_type.list_fields()
        if conceptual_type.generic or field.element_type in types
    }
    if conceptual_type.generic:
        values |= {each.name: f"{each.type} {each.value}" for each in conceptual_type.constants}
        values |= {name: str(number) for number, name in enumerate(conceptual_type.values)}
    return values


def _describe_field(field: DataField, context: ReadContext) -> str:
    if field.element_type in context.architecture.types:
        return f"{context.common_id('type', field.element_type)}{field.array}"
    default = field.default if isinstance(field.default, str | None) else f"[{', '.join(field.default)}]"
    return " ".join(filter(None, (field.type, default, field.meaning)))


TYPE = KindSpec(
    "type",
    "Types",
    (
        KeySpec(
            "message",
            lambda each, context: context.common_id("message", each.message),
            worsening=Worsening.ALWAYS,
            refers_to="message",
            verb="is",
            new_verb="is",
        ),
        prose_key("comment"),
        KeySpec("size", worsening=Worsening.MORE),
        # Defaults count as not written: writing them out is no change.
        KeySpec("status", lambda each, _: None if each.status == "existing" else each.status, Effect.SYSTEM, verb="is"),
        _inner_type_key("request"),
        _inner_type_key("response"),
        _inner_type_key("feedback"),
        frame_reference("is given in"),
        VERSION,
        deprecation_key("type"),
        KeySpec("generic", lambda each, _: each.generic or None, Effect.SYSTEM, noun="type parameters"),
        KeySpec("fields.", _read_fields, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
    elements=_list_types,
    features=(
        FeatureSpec("name", 2, lambda _, each: letter_pairs(each.name)),
        FeatureSpec("message", 3, lambda _, each: mark_values(each.message)),
        FeatureSpec("users", 5, _mark_ports),
        text_feature(1, "comment"),
        FeatureSpec("size", 1, lambda _, each: mark_values(each.size)),
        FeatureSpec("inside", 2, lambda _, each: mark_values(each.request, each.response, each.feedback)),
        FeatureSpec(
            "fields", 3, lambda _, each: mark_values(*(f"{field.name} {field.type}" for _, field in each.list_fields()))
        ),
    ),
    is_declared=_is_own_type,
)
