"""Find the elements that both versions have, even under another id or in another group.

From the outside in, so that each match helps with the next: groups, components, ports, nodes, and all that refers to
them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from archgen.compare import element_features
from archgen.compare.element_likeness import FeatureMap, find_likely_pairs
from archgen.compare.element_relations import IDS_BY_KIND, ElementRelations
from archgen.compare.matched_ids import MatchedIds
from archgen.model.architecture import Architecture

FeatureFunction = Callable[[ElementRelations, str], FeatureMap]


def match_elements(before: Architecture, after: Architecture) -> MatchedIds:
    """Pair the elements of both versions."""
    matched_ids = MatchedIds()
    # Both look up `matched_ids` while it fills: features of later kinds see the matches of earlier ones. The order of
    # the calls below is therefore part of the algorithm.
    old_relations, new_relations = (
        ElementRelations(before, matched_ids.find_new_id),
        ElementRelations(after, _matched_or_none(matched_ids)),
    )
    matched_ids.add_pair("project", before.project.id, after.project.id)
    for kind, ids in _KINDS_WITH_SAME_ID.items():
        _pair_same_ids(matched_ids, kind, ids(before), ids(after))
    _pair_by_likeness(matched_ids, "partner", old_relations, new_relations, element_features.describe_partner)
    _pair_by_likeness(matched_ids, "group", old_relations, new_relations, element_features.describe_group)
    _pair_below_parents(matched_ids, "component", before.components, after.components, "group")
    _pair_by_likeness(matched_ids, "component", old_relations, new_relations, element_features.describe_component)
    _pair_ports(matched_ids, "output", old_relations, new_relations, element_features.describe_output)
    _pair_ports(matched_ids, "input", old_relations, new_relations, element_features.describe_input)
    for kind, describe in _REFERRING_KINDS.items():
        _pair_by_likeness(matched_ids, kind, old_relations, new_relations, describe)
    return matched_ids


def _matched_or_none(matched_ids: MatchedIds) -> Callable[[str, str], str | None]:
    return lambda kind, name: name if matched_ids.is_matched(kind, name) else None


def _pair_same_ids(matched_ids: MatchedIds, kind: str, old_ids: Iterable[str], ids_after: Iterable[str]) -> None:
    """Pair elements that have the same id in both versions."""
    new_ids = set(ids_after)
    for element_id in old_ids:
        if element_id in new_ids:
            matched_ids.add_pair(kind, element_id, element_id)


def _pair_below_parents(
    matched_ids: MatchedIds, kind: str, old_ids: Iterable[str], ids_after: Iterable[str], parent_kind: str
) -> None:
    """Pair elements that have the same name below a matched parent."""
    new_ids = set(ids_after)
    for element_id in old_ids:
        parent, _, own_name = element_id.rpartition(".")
        new_parent = matched_ids.find_new_id(parent_kind, parent)
        if new_parent is not None and f"{new_parent}.{own_name}" in new_ids:
            matched_ids.add_pair(kind, element_id, f"{new_parent}.{own_name}")


def _pair_by_likeness(
    matched_ids: MatchedIds,
    kind: str,
    old_relations: ElementRelations,
    new_relations: ElementRelations,
    describe: FeatureFunction,
) -> None:
    """Pair the remaining elements by likeness."""
    ids = IDS_BY_KIND[kind]
    unmatched_before = {
        element_id: describe(old_relations, element_id)
        for element_id in ids(old_relations.architecture)
        if matched_ids.find_new_id(kind, element_id) is None
    }
    if not unmatched_before:
        return
    # Described only if something is left to pair.
    unmatched_after = {
        element_id: describe(new_relations, element_id)
        for element_id in ids(new_relations.architecture)
        if not matched_ids.is_matched(kind, element_id)
    }
    for old_id, new_id, confidence in find_likely_pairs(unmatched_before, unmatched_after):
        matched_ids.add_pair(kind, old_id, new_id, confidence)


def _pair_ports(
    matched_ids: MatchedIds,
    kind: str,
    old_relations: ElementRelations,
    new_relations: ElementRelations,
    describe: FeatureFunction,
) -> None:
    """Pair ports, first by name, then by likeness within each pair of components."""
    ids = IDS_BY_KIND[kind]
    _pair_below_parents(
        matched_ids, kind, ids(old_relations.architecture), ids(new_relations.architecture), "component"
    )
    unmatched_before: dict[str, dict[str, FeatureMap]] = {}
    for port in ids(old_relations.architecture):
        component = matched_ids.find_new_id("component", port.rpartition(".")[0])
        if component is not None and matched_ids.find_new_id(kind, port) is None:
            unmatched_before.setdefault(component, {})[port] = describe(old_relations, port)
    for component, ports in unmatched_before.items():
        new_component = new_relations.architecture.components[component]
        ports_after: Mapping[str, object] = new_component.outputs if kind == "output" else new_component.inputs
        candidate_ids = [
            f"{component}.{name}" for name in ports_after if not matched_ids.is_matched(kind, f"{component}.{name}")
        ]
        for old_id, new_id, confidence in find_likely_pairs(
            ports, {port: describe(new_relations, port) for port in candidate_ids}
        ):
            matched_ids.add_pair(kind, old_id, new_id, confidence)


# Components and ports are matched below their group or component instead: their ids change when a parent is renamed.
_KINDS_WITH_SAME_ID = {sort: ids for sort, ids in IDS_BY_KIND.items() if sort not in {"component", "input", "output"}}
_REFERRING_KINDS: Mapping[str, FeatureFunction] = {
    # In an order in which an element comes after those its features refer to: hosts after nodes, links after hosts.
    "type": element_features.describe_type,
    "message": element_features.describe_message,
    "node": element_features.describe_node,
    "container": element_features.describe_container,
    "host": element_features.describe_host,
    "link": element_features.describe_link,
    "chain": element_features.describe_chain,
    "requirement": element_features.describe_requirement,
    "use_case": element_features.describe_use_case,
    "view": element_features.describe_view,
    "policy": element_features.describe_policy,
}
