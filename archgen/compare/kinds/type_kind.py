"""Conceptual types: which of them are elements, and by what they are recognised."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.element_owners import find_type_owner
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.shared_features import mark_values, text_feature
from archgen.compare.kinds.type_readers import is_own_type
from archgen.model.message_types import ConceptualType


def _list_types(version: ArchitectureVersion) -> Mapping[str, ConceptualType]:
    return {
        name: conceptual_type
        for name, conceptual_type in version.architecture.types.items()
        if conceptual_type.origin != "message" or conceptual_type.at.file
    }


def _mark_ports(relations: ElementRelations, conceptual_type: ConceptualType) -> frozenset[str]:
    ports = relations.users_by_element[f"type:{conceptual_type.name}"]
    return relations.common_ids("output", ports) | relations.common_ids("input", ports)


TYPE = KindSpec(
    "type",
    "Types",
    elements=_list_types,
    features=(
        FeatureSpec("name", 2, lambda _, each: letter_pairs(each.name)),
        FeatureSpec("message", 3, lambda _, each: mark_values(each.message)),
        FeatureSpec("users", 5, _mark_ports),
        text_feature(1, "comment"),
        FeatureSpec("size", 1, lambda _, each: mark_values(each.size)),
        FeatureSpec("inside", 2, lambda _, each: mark_values(each.request, each.response, each.feedback)),
        FeatureSpec(
            "fields",
            3,
            lambda _, each: mark_values(*(f"{field.name} {field.type}" for _, field in each.list_fields())),
        ),
    ),
    owner=find_type_owner,
    is_declared=is_own_type,
)
