"""Measure how alike two elements are, and pair those of two sets that belong together. Symmetric in both sides."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping

from archgen.frozen import NamedTuple

MIN_LIKENESS = 0.6
"""Below this likeness an element was not renamed or moved: one was removed, and another one added."""
CERTAIN = 0.99
"""The confidence in a pair that is the same in all but its name; likeness stays below 1."""
_CERTAIN_WEIGHT = 5.0
"""As much as this has to be the same for a pair to be certain: more than one feature."""
_DOUBT_WEIGHT = 1.0
"""Weight of what is unknown: two elements about which hardly anything is said are never surely the same."""
_MAX_PAIRS_PER_MARK = 64
"""Marks shared by more pairs than this distinguish nothing, and are not used to find candidates."""


class Feature(NamedTuple):
    """One feature of an element: its weight, and the marks compared. If it is `generated` from the id on both sides, it
    does not count.
    """

    weight: float
    marks: frozenset[str]
    generated: bool = False
    decisive: bool = False
    """Whether it decides alone where most of both sides' marks are the same."""


FeatureMap = Mapping[str, Feature]


def measure_likeness(old_features: FeatureMap, new_features: FeatureMap) -> float:
    """Return the weighted share of common marks, from 0 to below 1; a feature without marks on either side does not
    count.
    """
    # The doubt is counted as a feature without anything in common, so that a single equal feature of weight 1 is only
    # 50 % likely.
    total_weight, common_weight = _DOUBT_WEIGHT, 0.0
    decisive_share = 0.0
    for name, (weight, marks, generated, decisive) in old_features.items():
        _, other_marks, other_generated, _ = new_features[name]
        if (marks or other_marks) and not (generated and other_generated):
            total_weight += weight
            common_count = len(marks & other_marks)
            # Jaccard index of the marks.
            common_weight += weight * common_count / len(marks | other_marks)
            if decisive and common_count > 1:
                decisive_share = min(common_count / max(len(marks), len(other_marks)), CERTAIN)
    return max(common_weight / total_weight, decisive_share)


def _equal_but_for_names(old_features: FeatureMap, new_features: FeatureMap) -> bool:
    """Whether all that is known of two elements is the same, but their ids and the titles that follow these."""
    equal_weight = 0.0
    for name, old_feature in old_features.items():
        new_feature = new_features[name]
        if name != "name" and not (old_feature.generated and new_feature.generated):
            if old_feature.marks != new_feature.marks:
                return False
            equal_weight += old_feature.weight if old_feature.marks else 0
    return equal_weight >= _CERTAIN_WEIGHT


def letter_pairs(name: str) -> frozenset[str]:
    """Return the pairs of neighbouring letters: slightly changed names share most of them."""
    padded = f"^{name.lower()}$"
    return frozenset(padded[position : position + 2] for position in range(len(padded) - 1))


def word_set(text: str | None) -> frozenset[str]:
    """Return the words of a text."""
    return frozenset((text or "").lower().split())


def find_likely_pairs(
    before: Mapping[str, FeatureMap], after: Mapping[str, FeatureMap]
) -> Iterator[tuple[str, str, float]]:
    """Yield the pairs that are the same element under another id, with their confidence, the surest first.

    Each element is in at most one pair. Only elements that share a rare mark are compared.
    """
    scored = [
        (measure_likeness(before[old_id], after[new_id]), old_id, new_id)
        for old_id, new_id in _candidate_pairs(before, after)
    ]
    scored = [entry for entry in scored if entry[0] >= MIN_LIKENESS]
    # Ties are broken by the ids in a way that does not depend on the side: comparing backwards must give the mirror
    # image (tests/compare/test_same.py).
    scored.sort(key=lambda entry: (-entry[0], min(entry[1:]), max(entry[1:])))
    used_old_ids, used_new_ids = set[str](), set[str]()
    # An element that could as well be another one is not certain.
    rivals = Counter(side_id for _, *ids in scored for side_id in zip("<>", ids, strict=True))
    for likeness, old_id, new_id in scored:
        has_rival = rivals["<", old_id] > 1 or rivals[">", new_id] > 1
        confidence = CERTAIN if not has_rival and _equal_but_for_names(before[old_id], after[new_id]) else likeness
        if old_id not in used_old_ids and new_id not in used_new_ids:
            used_old_ids.add(old_id)
            used_new_ids.add(new_id)
            # Truncated, not rounded: likeness stays below 1, and so must the confidence.
            yield old_id, new_id, int(confidence * 100) / 100


def _candidate_pairs(before: Mapping[str, FeatureMap], after: Mapping[str, FeatureMap]) -> Collection[tuple[str, str]]:
    # Few elements are all compared; above that, comparing every pair would be quadratic in the number of renames.
    if len(before) * len(after) <= _MAX_PAIRS_PER_MARK:
        return [(old_id, new_id) for old_id in before for new_id in after]
    old_by_mark, new_by_mark = _group_by_mark(before), _group_by_mark(after)
    return {
        (old_id, new_id)
        for mark, old_ids in old_by_mark.items()
        if len(old_ids) * len(new_by_mark.get(mark, ())) <= _MAX_PAIRS_PER_MARK
        for old_id in old_ids
        for new_id in new_by_mark.get(mark, ())
    }


def _group_by_mark(elements: Mapping[str, FeatureMap]) -> dict[tuple[str, str], list[str]]:
    ids_by_mark: dict[tuple[str, str], list[str]] = defaultdict(list)
    for element, features in elements.items():
        for name, feature in features.items():
            for mark in feature.marks:
                ids_by_mark[name, mark].append(element)
    return ids_by_mark
