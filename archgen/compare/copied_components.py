"""New components that are copies of one that was there."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from archgen.compare.element_likeness import FeatureMap, measure_likeness
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.functional_kinds import COMPONENT
from archgen.compare.match_elements import describe_element
from archgen.compare.reshaping import Reshaping, truncate_confidence
from archgen.compare.version_pair import VersionPair

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
    """Return the features of components that have ports, by these."""
    groups: dict[frozenset[str], dict[str, FeatureMap]] = defaultdict(dict)
    for component_id in component_ids:
        features = _copied_features(relations, component_id)
        if features["ports"].marks:
            groups[features["ports"].marks][component_id] = features
    return groups


def _copied_features(relations: ElementRelations, component_id: str) -> FeatureMap:
    features = describe_element(COMPONENT, relations, relations.architecture.components[component_id])
    return {name: feature for name, feature in features.items() if name in _COPIED_FEATURES}
