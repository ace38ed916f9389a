"""How alike two elements are, and which of two sets belong together. Nothing here depends on which side is first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

LEAST = 0.6
"""Below this an element was not renamed or moved, but removed, and another one added."""
_DOUBT = 1.0
"""The weight of not knowing: two elements of which hardly anything is said are never the same for sure."""
_CROWD = 64
"""Marks that more pairs than this share tell nobody apart, and are not looked at to find candidates."""


class Feature(NamedTuple):
    """One side of an element: how much it counts, and what is compared. What is `made` of the id, in both, says nothing."""

    weight: float
    marks: frozenset[str]
    made: bool = False


Features = Mapping[str, Feature]


def likeness(one: Features, other: Features) -> float:
    """Give the share of what both have in common, by weight; a side that neither says anything of does not count."""
    total, common = _DOUBT, 0.0
    for name, (weight, marks, made) in one.items():
        _, others, made_too = other[name]
        if (marks or others) and not (made and made_too):
            total += weight
            common += weight * len(marks & others) / len(marks | others)
    return common / total


def letters(name: str) -> frozenset[str]:
    """Give the pairs of neighbouring letters: names that were changed a little share most of them."""
    padded = f"^{name.lower()}$"
    return frozenset(padded[at : at + 2] for at in range(len(padded) - 1))


def words(text: str | None) -> frozenset[str]:
    """Give the words of a text."""
    return frozenset((text or "").lower().split())


def pairs(before: Mapping[str, Features], after: Mapping[str, Features]) -> Iterator[tuple[str, str, float]]:
    """Give the pairs of elements that are the same under another id, with their confidence, the surest first.

    Each element is in one pair at most. Only elements that share a rare mark are held against each other.
    """
    scored = [(likeness(before[a], after[b]), a, b) for a, b in _candidates(before, after)]
    scored = [entry for entry in scored if entry[0] >= LEAST]
    scored.sort(key=lambda entry: (-entry[0], min(entry[1:]), max(entry[1:])))
    taken_before, taken_after = set[str](), set[str]()
    for confidence, a, b in scored:
        if a not in taken_before and b not in taken_after:
            taken_before.add(a)
            taken_after.add(b)
            yield a, b, int(confidence * 100) / 100


def _candidates(before: Mapping[str, Features], after: Mapping[str, Features]) -> Collection[tuple[str, str]]:
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
