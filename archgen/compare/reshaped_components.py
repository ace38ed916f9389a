"""Components that were split, merged or copied: recognised by what became of their outputs, stated with a confidence.

What is recognised below `MIN_LIKENESS` stays what it is to the comparison: elements added and removed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from archgen.compare.comparison import Comparison
from archgen.compare.element_likeness import MIN_LIKENESS, FeatureMap, measure_likeness
from archgen.compare.element_relations import ElementRelations
from archgen.compare.key_phrases import shown_id
from archgen.compare.kinds.functional_kinds import COMPONENT
from archgen.compare.match_elements import describe_element, look_up_pair
from archgen.compare.reshaping import (
    OutputHeir,
    Reshaping,
    component_of,
    describe_merger,
    describe_split,
    find_heirs,
    has_lost_outputs,
    outputs_of,
    sources_of,
    truncate_confidence,
)
from archgen.compare.version_pair import VersionPair


def find_reshapings(comparison: Comparison) -> Iterator[Reshaping]:
    """Yield the components that were split, merged or copied; none takes part in two of them."""
    versions = comparison.versions
    added_ids = [
        name for (kind, name) in versions.elements_after if kind == "component" and versions.is_added(kind, name)
    ]
    removed_ids = [
        name for (kind, name) in versions.elements_before if kind == "component" and versions.is_removed(kind, name)
    ]
    if not added_ids and not removed_ids:
        return
    relations = look_up_pair(comparison.before.architecture, comparison.after.architecture, comparison.matched_ids)
    used_ids = set[str]()
    if has_lost_outputs(versions):
        heirs = list(find_heirs(versions, relations))
        for reshaping in (*_find_reshaped("split", heirs, versions), *_find_reshaped("merged", heirs, versions)):
            if used_ids.isdisjoint(reshaping.component_ids):
                used_ids |= reshaping.component_ids
                yield reshaping
    yield from find_copies([name for name in added_ids if name not in used_ids], versions, relations[1])


def _find_reshaped(
    kind: Literal["split", "merged"], heirs: Sequence[OutputHeir], versions: VersionPair
) -> Iterator[Reshaping]:
    """Yield the old components that were split into new ones, or the new ones that old ones were merged into."""
    is_split = kind == "split"
    heirs_by_whole: dict[str, dict[str, list[OutputHeir]]] = defaultdict(lambda: defaultdict(list))
    for heir in heirs:
        whole, part = heir.old_component, heir.new_component
        if not is_split:
            whole, part = part, whole
        if versions.is_added("component", part) if is_split else versions.is_removed("component", part):
            heirs_by_whole[whole][part].append(heir)
    elements = versions.elements_after if is_split else versions.elements_before
    judge = _judge_part if is_split else _judge_merged
    for whole, heirs_by_part in sorted(heirs_by_whole.items()):
        is_on_both_sides = ("component", whole) in elements
        if not is_on_both_sides and len(heirs_by_part) == 1:
            continue
        confidence = min(judge(whole, part, part_heirs, versions) for part, part_heirs in heirs_by_part.items())
        if confidence >= MIN_LIKENESS:
            if is_split:
                parts = [*heirs_by_part, *([whole] if is_on_both_sides else [])]
            else:
                parts = [shown_id("component", part, versions) for part in heirs_by_part]
            yield Reshaping(
                kind,
                whole,
                tuple(sorted(parts)),
                (describe_split if is_split else describe_merger)(whole, heirs_by_part, versions),
                confidence,
                frozenset([whole, *heirs_by_part]),
                tuple(heir for part_heirs in heirs_by_part.values() for heir in part_heirs),
                versions,
            )


def _judge_part(old_component: str, part: str, heirs: Sequence[OutputHeir], versions: VersionPair) -> float:
    """Return how sure it is that a new component is a part of an old one: its outputs are, and it reads what that did."""
    outputs = outputs_of(part, versions.elements_after)
    mean_likeness = sum(heir.likeness for heir in heirs) / len(heirs)
    sources = sources_of(part, versions, side=1)
    own_components = {old_component, *(heir.new_component for heir in heirs)}
    old_sources = sources_of(old_component, versions, side=0)
    # The second half of what was one pipeline reads the first.
    known_sources = {
        source
        for source in sources
        if source in old_sources or component_of(("output", source), versions) in own_components
    }
    source_share = len(known_sources) / len(sources) if sources else 1.0
    return truncate_confidence(0.5 * mean_likeness + 0.25 * source_share + 0.25 * len(heirs) / max(len(outputs), 1))


def _judge_merged(whole: str, part: str, heirs: Sequence[OutputHeir], versions: VersionPair) -> float:
    """Return how sure it is that a component is a part of another one now: that has its outputs, and reads what it did."""
    outputs = outputs_of(part, versions.elements_before)
    likeness = sum(heir.likeness for heir in heirs) / max(len(outputs), 1)
    own_outputs = {
        *outputs_of(part, versions.elements_before),
        *outputs_of(whole, versions.elements_before),
    }
    outer_sources = sources_of(part, versions, side=0) - own_outputs
    read_sources = outer_sources & sources_of(whole, versions, side=1)
    source_share = len(read_sources) / len(outer_sources) if outer_sources else 1.0
    return truncate_confidence(0.6 * likeness + 0.4 * source_share)


_COPIED_FEATURES = frozenset({"ports", "text", "group", "owner", "requirements", "performance", "timing", "tags"})
"""The features of a component that are copied with it: not its name, its node, its readers."""
_MIN_COPY_LIKENESS = 0.7
_MAX_COPIES = 20
"""With more new components than this a project is built up, and each would be compared with all."""


def find_copies(added_ids: Sequence[str], versions: VersionPair, relations: ElementRelations) -> Iterator[Reshaping]:
    """Yield the new components that have the ports of one that was there, and are like it in all that is copied."""
    if not added_ids or len(added_ids) > _MAX_COPIES:
        return
    originals_by_ports = _group_by_ports(
        [name for name in relations.architecture.components if ("component", name) in versions.elements_before],
        relations,
    )
    for added_id in added_ids:
        features = _copied_features(relations, added_id)
        rated_originals = [
            (-measure_likeness(original_features, features), name)
            for name, original_features in originals_by_ports.get(features["ports"].marks, {}).items()
        ]
        likeness, original = min(rated_originals, default=(0.0, ""))
        if -likeness >= _MIN_COPY_LIKENESS:
            yield Reshaping(
                "copied",
                added_id,
                (original,),
                f"a copy of `{original}`",
                truncate_confidence(-likeness),
                frozenset([added_id]),
                (),
                versions,
            )


def _group_by_ports(
    component_ids: Sequence[str], relations: ElementRelations
) -> Mapping[frozenset[str], Mapping[str, FeatureMap]]:
    groups: dict[frozenset[str], dict[str, FeatureMap]] = defaultdict(dict)
    for component_id in component_ids:
        features = _copied_features(relations, component_id)
        if features["ports"].marks:
            groups[features["ports"].marks][component_id] = features
    return groups


def _copied_features(relations: ElementRelations, component_id: str) -> FeatureMap:
    features = describe_element(COMPONENT, relations, relations.architecture.components[component_id])
    return {name: feature for name, feature in features.items() if name in _COPIED_FEATURES}
