"""Signatures of templates: names that stand for types in a generic type or component type."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.plugins.xmi.views.uml_tree import UmlTree, make_tree


def make_signature(
    signature_id: str, names: Sequence[str], formal_ids: Sequence[str]
) -> tuple[UmlTree, dict[str, str]]:
    """Return the signature, and the ids of what its names are inside of the template."""
    signature = make_tree(
        "ownedTemplateSignature", "RedefinableTemplateSignature", signature_id, parameter=" ".join(formal_ids)
    )
    element_ids = {name: f"{formal_id}.element" for name, formal_id in zip(names, formal_ids, strict=True)}
    for formal_id, (name, element_id) in zip(formal_ids, element_ids.items(), strict=True):
        formal = make_tree("ownedParameter", "ClassifierTemplateParameter", formal_id, parameteredElement=element_id)
        words = {"templateParameter": formal_id}
        formal["children"].append(make_tree("ownedParameteredElement", "Class", element_id, name, **words))
        signature["children"].append(formal)
    return signature, element_ids
