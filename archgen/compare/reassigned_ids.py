"""Ids that name another element than before: of two that were exchanged, or of numbers that moved on by one.

An id that is in both versions is taken for the same element, unless its texts say otherwise: those of the element that had it
stand, word for word, at another id now, and so does all that is connected with it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator, Mapping
from typing import Any

from archgen.compare.element_relations import ElementRelations
from archgen.model.component import Component, list_component_ports
from archgen.model.path_resolver import title_from_id
from archgen.model.variant import Variant

REASSIGNABLE_KINDS = frozenset({"component", "requirement", "use_case"})
"""The kinds of elements that have texts enough to be known by."""
_LIKE_VARIANT = 0.8
"""The share of its places at which a variant writes still if it is the same one."""


def find_reassigned_ids(
    kind_name: str,
    elements: tuple[Mapping[str, Any], Mapping[str, Any]],
    relations: tuple[ElementRelations, ElementRelations],
) -> Iterator[tuple[str, str]]:
    """Yield the old and new ids of elements whose old id is another element's now.

    Requirements and use cases are their texts: they are also found where the old id is nobody's now. A component is
    more than that, and its plain rename is recognised by likeness.
    """
    old_texts, new_texts = (
        {element_id: _read_texts(element) for element_id, element in side.items()} for side in elements
    )
    if old_texts == new_texts:
        return
    old_ids, new_ids = (
        _ids_by_fingerprint(kind_name, texts, side, side_relations)
        for texts, side, side_relations in zip((old_texts, new_texts), elements, relations, strict=True)
    )
    pairs = {
        old_holders[0]: new_holders[0]
        for fingerprint, old_holders in old_ids.items()
        if len(old_holders) == 1 and len(new_holders := new_ids.get(fingerprint, [])) == 1
    }
    moved_pairs = {old_id: new_id for old_id, new_id in pairs.items() if old_id != new_id}
    for old_id, new_id in moved_pairs.items():
        if kind_name != "component" or old_id in new_texts or new_id in old_texts:
            yield old_id, new_id


def find_refilled_variants(
    old_variants: Mapping[str, Variant], new_variants: Mapping[str, Variant]
) -> Iterator[tuple[str, str]]:
    """Yield the old and new ids of variants that write what they wrote under an id that another variant has now, or none."""
    for old_id, variant in old_variants.items():
        if old_id not in new_variants or not _writes_as(variant, new_variants[old_id]):
            candidates = [
                (len(_list_places(each)), new_id)
                for new_id, each in new_variants.items()
                if _writes_as(variant, each) and not (new_id in old_variants and _writes_as(old_variants[new_id], each))
            ]
            if candidates:
                yield old_id, min(candidates)[1]


def _writes_as(old: Variant, new: Variant) -> bool:
    """Whether a variant writes where another one wrote, whatever else it writes."""
    places = _list_places(old)
    return bool(places) and len(places & _list_places(new)) >= _LIKE_VARIANT * len(places)


def _list_places(variant: Variant) -> set[str | None]:
    return {*(change.path for change in variant.changes), *variant.drop, variant.without} - {None}


def _read_texts(element: Any) -> tuple[str, ...]:  # noqa: ANN401 - components, requirements, use cases
    """Return what is written about an element: its title, if that does not follow the id, and its texts."""
    own_name = element.id.rpartition(".")[2]
    title = "" if element.title in {element.id, own_name, title_from_id(own_name)} else element.title
    texts = (title, getattr(element, "functionality", None), element.description)
    return tuple(" ".join((text or "").split()) for text in texts)


def _ids_by_fingerprint(
    kind_name: str, texts: Mapping[str, tuple[str, ...]], elements: Mapping[str, Any], relations: ElementRelations
) -> Mapping[Hashable, list[str]]:
    """Return the ids of elements that have texts, by these and all that belongs to them."""
    ids: dict[Hashable, list[str]] = defaultdict(list)
    for element_id, element in elements.items():
        if any(texts[element_id]):
            wiring = _read_wiring(element, relations) if kind_name == "component" else None
            ids[texts[element_id], wiring].append(element_id)
    return ids


def _read_wiring(component: Component, relations: ElementRelations) -> Hashable:
    """Return the ports of a component and, by their names, who reads them: who only takes over texts is not the same."""
    ports = frozenset((type(port).__name__, port.name, port.type) for port in list_component_ports(component))
    readers = frozenset(
        (port.name, reader) for port in component.outputs.values() for reader in relations.readers_by_output[port.id]
    )
    return ports, readers
