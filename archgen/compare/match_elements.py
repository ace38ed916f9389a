"""Find the elements that both versions have, even under another id or in another group.

From the outside in, so that each match helps with the next: groups, components, ports, nodes, and all that refers to
them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import CERTAIN, Feature, FeatureMap, find_likely_pairs
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds import ELEMENT_KINDS, MATCHING_ORDER
from archgen.compare.kinds.kind_spec import KindSpec
from archgen.compare.matched_ids import MatchedIds
from archgen.model.architecture import Architecture
from archgen.model.component import Component, list_component_ports
from archgen.model.path_resolver import title_from_id
from archgen.model.variant import Variant

_REASSIGNABLE_KINDS = frozenset({"component", "requirement", "use_case"})
"""The kinds of elements that have texts enough to be known by."""
_LIKE_VARIANT = 0.8
"""The share of its places at which a variant writes still if it is the same one."""


def _find_reassigned_ids(
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


def _find_refilled_variants(
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


def match_elements(before: Architecture, after: Architecture) -> MatchedIds:
    """Pair the elements of both versions."""
    matched_ids = MatchedIds()
    # Both look up `matched_ids` while it fills: features of later kinds see the matches of earlier ones. The order of
    # the calls below is therefore part of the algorithm.
    old_relations, new_relations = look_up_pair(before, after, matched_ids)
    matched_ids.add_pair("project", before.project.id, after.project.id)
    matcher = _Matcher(matched_ids, old_relations, new_relations)
    kinds = [ELEMENT_KINDS[name] for name in MATCHING_ORDER]
    for kind in kinds:
        if kind.name in _REASSIGNABLE_KINDS:
            matcher.pair_reassigned_ids(kind)
    matcher.pair_refilled_variants(ELEMENT_KINDS["variant"])
    for kind in kinds:
        if kind.parent_kind is None:
            matcher.pair_same_ids(kind)
    for kind in kinds:
        if kind.parent_kind is not None:
            matcher.pair_below_parents(kind, kind.parent_kind)
        if kind.name == "component":
            matcher.pair_wrapped_components(kind)
        matcher.pair_by_likeness(kind)
    return matched_ids


def look_up_pair(
    before: Architecture, after: Architecture, matched_ids: MatchedIds
) -> tuple[ElementRelations, ElementRelations]:
    """Return both versions with what describing their elements has to look up, under common ids."""
    return ElementRelations(before, matched_ids.find_new_id), ElementRelations(
        after, lambda kind, name: name if matched_ids.is_matched(kind, name) else None
    )


class _Matcher:
    """Pairs the elements of one kind after the other."""

    def __init__(
        self, matched_ids: MatchedIds, old_relations: ElementRelations, new_relations: ElementRelations
    ) -> None:
        self.matched_ids = matched_ids
        self.old_relations = old_relations
        self.new_relations = new_relations

    def pair_reassigned_ids(self, kind: KindSpec) -> None:
        """Pair elements whose old id is another element's now, before the ids are taken at their word."""
        relations = self.old_relations, self.new_relations
        elements = _declared_elements(kind, self.old_relations), _declared_elements(kind, self.new_relations)
        for old_id, new_id in _find_reassigned_ids(kind.name, elements, relations):
            self.matched_ids.add_pair(kind.name, old_id, new_id, CERTAIN)

    def pair_refilled_variants(self, kind: KindSpec) -> None:
        """Pair variants by where they write, before the ids are taken at their word."""
        variants = (_declared_elements(kind, side) for side in (self.old_relations, self.new_relations))
        for old_id, new_id in _find_refilled_variants(*variants):
            if not self._is_settled(kind, old_id, new_id):
                self.matched_ids.add_pair(kind.name, old_id, new_id, CERTAIN)

    def pair_same_ids(self, kind: KindSpec) -> None:
        """Pair elements that have the same id in both versions."""
        new_ids = _declared_elements(kind, self.new_relations)
        for element_id in _declared_elements(kind, self.old_relations):
            if element_id in new_ids and not self._is_settled(kind, element_id, element_id):
                self.matched_ids.add_pair(kind.name, element_id, element_id)

    def _is_settled(self, kind: KindSpec, old_id: str, new_id: str) -> bool:
        """Whether one of two ids belongs to another pair already."""
        return self.matched_ids.find_new_id(kind.name, old_id) is not None or self.matched_ids.is_matched(
            kind.name, new_id
        )

    def pair_below_parents(self, kind: KindSpec, parent_kind: str) -> None:
        """Pair elements that have the same name below a matched parent: ids change when a parent is renamed."""
        new_ids = _declared_elements(kind, self.new_relations)
        for element_id in _declared_elements(kind, self.old_relations):
            new_id = self._find_id_below_parent(parent_kind, element_id)
            if new_id in new_ids and not self._is_settled(kind, element_id, new_id):
                self.matched_ids.add_pair(kind.name, element_id, new_id)

    def _find_id_below_parent(self, parent_kind: str, element_id: str) -> str:
        """Return the id that an element has if only what is around it is called otherwise, "" if that is not known."""
        parent, _, own_name = element_id.rpartition(".")
        if parent_kind == "group" and "." in parent:
            new_shell = self.matched_ids.find_new_id("composed", parent)
            if new_shell is not None:
                return f"{new_shell}.{own_name}"
            # A component's path may lead through composed components: below its group it is one name.
            parent, _, own_name = element_id.partition(".")
        new_parent = self.matched_ids.find_new_id(parent_kind, parent)
        return f"{new_parent}.{own_name}" if new_parent is not None else ""

    def pair_wrapped_components(self, kind: KindSpec) -> None:
        """Pair leaves that got a composed component around them in their place, or are no longer in one."""
        relations = self.old_relations, self.new_relations
        old_leaves, new_leaves = (_declared_elements(kind, side) for side in relations)
        old_shells, new_shells = (side.architecture.shells for side in relations)
        for old_id, component in old_leaves.items():
            new_place = self.matched_ids.common_id("group", component.group) + old_id.removeprefix(component.group)
            if new_place in new_shells and new_place not in new_leaves:
                self._pair_only_one(
                    kind, [(old_id, each) for each in _list_alike(component, new_shells[new_place], new_leaves)]
                )
        for new_id, component in new_leaves.items():
            if new_id in old_shells and new_id not in old_leaves:
                self._pair_only_one(
                    kind, [(each, new_id) for each in _list_alike(component, old_shells[new_id], old_leaves)]
                )

    def _pair_only_one(self, kind: KindSpec, pairs: Sequence[tuple[str, str]]) -> None:
        if len(pairs) == 1 and not self._is_settled(kind, *pairs[0]):
            self.matched_ids.add_pair(kind.name, *pairs[0], CERTAIN)

    def pair_by_likeness(self, kind: KindSpec) -> None:
        """Pair the remaining elements by likeness; ports only within each pair of components."""
        unmatched_before: dict[str, dict[str, object]] = {}
        unread_keys = self.new_relations.architecture.unread_keys
        for element_id, element in _declared_elements(kind, self.old_relations).items():
            # What may be in a part that could not be read may have its old id there.
            is_unread = element_id.rpartition(".")[2] in unread_keys
            if not is_unread and self.matched_ids.find_new_id(kind.name, element_id) is None:
                parent = self._new_parent(kind, element_id)
                if parent is not None:
                    unmatched_before.setdefault(parent, {})[element_id] = element
        if not unmatched_before:
            return
        unmatched_after: dict[str, dict[str, object]] = {}
        for element_id, element in _declared_elements(kind, self.new_relations).items():
            parent = element_id.rpartition(".")[0] if kind.stays_in_parent else ""
            if parent in unmatched_before and not self.matched_ids.is_matched(kind.name, element_id):
                unmatched_after.setdefault(parent, {})[element_id] = element
        # Described only where something is left to pair.
        for parent in (each for each in unmatched_before if each in unmatched_after):
            before, after = (
                {name: describe_element(kind, relations, each) for name, each in elements.items()}
                for relations, elements in (
                    (self.old_relations, unmatched_before[parent]),
                    (self.new_relations, unmatched_after[parent]),
                )
            )
            for old_id, new_id, confidence in find_likely_pairs(before, after):
                self.matched_ids.add_pair(kind.name, old_id, new_id, confidence)

    def _new_parent(self, kind: KindSpec, element_id: str) -> str | None:
        """Return the element of the second version below which a match must be, "" if it may be anywhere."""
        if not kind.stays_in_parent or kind.parent_kind is None:
            return ""
        return self.matched_ids.find_new_id(kind.parent_kind, element_id.rpartition(".")[0])


def _list_alike(component: Component, shell: Component, leaves: Mapping[str, Component]) -> list[str]:
    """Return the leaves directly inside of a composed component that have the ports of a component."""
    ports = _list_port_types(component)
    return [each for each in shell.children if each in leaves and _list_port_types(leaves[each]) == ports]


def _list_port_types(component: Component) -> set[tuple[str, str, str | None]]:
    return {(type(port).__name__, port.name, port.type) for port in list_component_ports(component)}


def _declared_elements(kind: KindSpec, relations: ElementRelations) -> Mapping[str, Any]:
    """Return the elements of a kind that somebody wrote."""
    elements = kind.elements(ArchitectureVersion(relations.architecture)) if kind.elements else {}
    return {element_id: element for element_id, element in elements.items() if kind.is_declared(element)}


def describe_element(kind: KindSpec, relations: ElementRelations, element: object) -> FeatureMap:
    """Return the features of an element."""
    return {
        feature.name: Feature(
            feature.weight,
            feature.marks(relations, element),
            feature.is_generated is not None and feature.is_generated(element),
            feature.is_decisive,
        )
        for feature in kind.features
    }
