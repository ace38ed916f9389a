"""Measure how alike two elements are, and pair those of two sets that belong together. Symmetric in both sides."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

LEAST = 0.6
"""Below this likeness an element was not renamed or moved: one was removed, and another one added."""
_DOUBT = 1.0
"""Weight of what is unknown: two elements about which hardly anything is said are never surely the same."""
_CROWD = 64
"""Marks shared by more pairs than this distinguish nothing, and are not used to find candidates."""


class Feature(NamedTuple):
    """One feature of an element: its weight, and the marks compared. If it is `generated` from the id on both sides, it
    does not count.
    """

    weight: float
    marks: frozenset[str]
    made: bool = False


Features = Mapping[str, Feature]


def likeness(one: Features, other: Features) -> float:
    """Return the weighted share of common marks, from 0 to below 1; a feature without marks on either side does not
    count.
    """
    # The doubt is counted as a feature without anything in common, so that a single equal feature of weight 1 is only
    # 50 % likely.
    total, common = _DOUBT, 0.0
    for name, (weight, marks, made) in one.items():
        _, others, made_too = other[name]
        if (marks or others) and not (made and made_too):
            total += weight
            # Jaccard index of the marks.
            common += weight * len(marks & others) / len(marks | others)
    return common / total


def letters(name: str) -> frozenset[str]:
    """Return the pairs of neighbouring letters: slightly changed names share most of them."""
    padded = f"^{name.lower()}$"
    return frozenset(padded[at : at + 2] for at in range(len(padded) - 1))


def words(text: str | None) -> frozenset[str]:
    """Return the words of a text."""
    return frozenset((text or "").lower().split())


def pairs(before: Mapping[str, Features], after: Mapping[str, Features]) -> Iterator[tuple[str, str, float]]:
    """Yield the pairs that are the same element under another id, with their confidence, the surest first.

    Each element is in at most one pair. Only elements that share a rare mark are compared.
    """
    scored = [(likeness(before[a], after[b]), a, b) for a, b in _candidates(before, after)]
    scored = [entry for entry in scored if entry[0] >= LEAST]
    # Ties are broken by the ids in a way that does not depend on the side: comparing backwards must give the mirror
    # image (tests/compare/test_same.py).
    scored.sort(key=lambda entry: (-entry[0], min(entry[1:]), max(entry[1:])))
    taken_before, taken_after = set[str](), set[str]()
    for confidence, a, b in scored:
        if a not in taken_before and b not in taken_after:
            taken_before.add(a)
            taken_after.add(b)
            # Truncated, not rounded: likeness stays below 1, and so must the confidence.
            yield a, b, int(confidence * 100) / 100


def _candidates(before: Mapping[str, Features], after: Mapping[str, Features]) -> Collection[tuple[str, str]]:
    # Few elements are all compared; above that, comparing every pair would be quadratic in the number of renames.
    if len(before) * len(after) <= _CROWD:
        return [(a, b) for a in before for b in after]
    left, right = _by_mark(before), _by_mark(after)
    return {
        (a, b)
        for mark, owners in left.items()
        if len(owners) * len(right.get(mark, ())) <= _CROWD
        for a in owners
        for b in right.get(mark, ())
    }


def _by_mark(elements: Mapping[str, Features]) -> dict[tuple[str, str], list[str]]:
    found: dict[tuple[str, str], list[str]] = defaultdict(list)
    for element, features in elements.items():
        for name, feature in features.items():
            for mark in feature.marks:
                found[name, mark].append(element)
    return found
