"""Findings that appeared and findings that were cured: by what they say of what, not by where."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from archgen.compare.names import Names
from archgen.diagnostic import Diagnostic

_DIGITS = re.compile(r"\d+(?:\.\d+)?")
Told = tuple[str, str, str]


def findings(
    before: Sequence[Diagnostic], after: Sequence[Diagnostic], names: Names
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Give the new and the cured findings. One that only gives another figure is neither."""
    old = [(each, _said(each, names)) for each in before]
    new = [(each, _said(each, Names())) for each in after]
    for blur in (_exact, _without_figures):
        left, right = Counter(blur(said) for _, said in old), Counter(blur(said) for _, said in new)
        old, new = _unmatched(old, right, blur), _unmatched(new, left, blur)
    return tuple(each for each, _ in new), tuple(each for each, _ in old)


def _said(finding: Diagnostic, names: Names) -> Told:
    element = names.words(finding.element) if finding.element else ""
    return finding.rule, element, names.ticked(finding.message)


def _exact(said: Told) -> Told:
    return said


def _without_figures(said: Told) -> Told:
    return said[0], said[1], _DIGITS.sub("0", said[2]) if said[1] else said[2]


def _unmatched(
    told: Iterable[tuple[Diagnostic, Told]], others: Counter[Told], blur: object
) -> list[tuple[Diagnostic, Told]]:
    rest, left = Counter(others), []
    for each, said in told:
        key = blur(said)  # type: ignore[operator]
        if rest[key]:
            rest[key] -= 1
        else:
            left.append((each, said))
    return left
