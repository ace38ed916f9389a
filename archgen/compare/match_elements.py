"""Find the elements that both versions have, even under another id or in another group.

From the outside in, so that each match helps with the next: groups, components, ports, nodes, and all that refers to
them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import CERTAIN, Feature, FeatureMap, find_likely_pairs
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds import ELEMENT_KINDS, MATCHING_ORDER
from archgen.compare.kinds.kind_spec import KindSpec
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.reassigned_ids import REASSIGNABLE_KINDS, find_reassigned_ids, find_refilled_variants
from archgen.model.architecture import Architecture
from archgen.model.component import Component, list_component_ports


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
        if kind.name in REASSIGNABLE_KINDS:
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
    return ElementRelations(before, matched_ids.find_new_id), ElementRelations(after, _matched_or_none(matched_ids))


def _matched_or_none(matched_ids: MatchedIds) -> Callable[[str, str], str | None]:
    return lambda kind, name: name if matched_ids.is_matched(kind, name) else None


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
        for old_id, new_id in find_reassigned_ids(kind.name, elements, relations):
            self.matched_ids.add_pair(kind.name, old_id, new_id, CERTAIN)

    def pair_refilled_variants(self, kind: KindSpec) -> None:
        """Pair variants by where they write, before the ids are taken at their word."""
        variants = (_declared_elements(kind, side) for side in (self.old_relations, self.new_relations))
        for old_id, new_id in find_refilled_variants(*variants):
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
        unmatched_before: dict[str, dict[str, FeatureMap]] = {}
        unread_keys = self.new_relations.architecture.unread_keys
        for element_id, element in _declared_elements(kind, self.old_relations).items():
            # What may be in a part that could not be read may have its old id there.
            is_unread = element_id.rpartition(".")[2] in unread_keys
            if not is_unread and self.matched_ids.find_new_id(kind.name, element_id) is None:
                parent = self._new_parent(kind, element_id)
                if parent is not None:
                    features = describe_element(kind, self.old_relations, element)
                    unmatched_before.setdefault(parent, {})[element_id] = features
        if not unmatched_before:
            return
        unmatched_after: dict[str, dict[str, FeatureMap]] = {parent: {} for parent in unmatched_before}
        for element_id, element in _declared_elements(kind, self.new_relations).items():
            parent = element_id.rpartition(".")[0] if kind.stays_in_parent else ""
            # Described only where something is left to pair.
            if parent in unmatched_after and not self.matched_ids.is_matched(kind.name, element_id):
                unmatched_after[parent][element_id] = describe_element(kind, self.new_relations, element)
        for parent, elements in unmatched_before.items():
            for old_id, new_id, confidence in find_likely_pairs(elements, unmatched_after[parent]):
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
