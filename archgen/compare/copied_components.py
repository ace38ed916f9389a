"""New components that are copies of one that was there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare.element_likeness import FeatureMap, measure_likeness
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.functional_kinds import COMPONENT
from archgen.compare.match_elements import describe_element
from archgen.compare.reshaping import Reshaping, truncate_confidence
from archgen.compare.version_pair import VersionPair

_COPIED_FEATURES = frozenset({"ports", "text", "group", "owner", "requirements", "performance", "timing", "tags"})
"""The features of a component that are copied with it: not its name, its node, its readers."""
_MIN_COPY_LIKENESS = 0.7


def find_copies(added_ids: Sequence[str], versions: VersionPair, relations: ElementRelations) -> Iterator[Reshaping]:
    """Yield the new components that have the ports of one that was there, and are like it in all that is copied."""
    components = relations.architecture.components
    for added_id in added_ids if len(added_ids) <= _MAX_COPIES else ():
        features = _copied_features(relations, added_id)
        if not features["ports"].marks:
            continue
        rated_originals = [
            (-measure_likeness(original_features, features), name)
            for name in components
            if ("component", name) in versions.elements_before
            and (original_features := _copied_features(relations, name))["ports"].marks == features["ports"].marks
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


_MAX_COPIES = 20
"""With more new components than this a project is built up, and each would be compared with all."""


def _copied_features(relations: ElementRelations, component_id: str) -> FeatureMap:
    features = describe_element(COMPONENT, relations, relations.architecture.components[component_id])
    return {name: feature for name, feature in features.items() if name in _COPIED_FEATURES}
