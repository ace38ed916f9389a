"""Findings that appeared and findings that were cured: by what they say of what, not by where."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from archgen.compare.names import Names
from archgen.diagnostic import Diagnostic
from archgen.identity import identity, partners


def findings(
    before: Sequence[Diagnostic], after: Sequence[Diagnostic], names: Names
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Give the new and the cured findings. One that only gives another figure is neither."""
    old = partners([_keys(each, Names()) for each in after], [_keys(each, names) for each in before])
    gone = set(range(len(before))).difference(old)
    new = tuple(each for each, was in zip(after, old, strict=True) if was is None)
    return new, tuple(before[place] for place in sorted(gone))


def _keys(finding: Diagnostic, names: Names) -> tuple[Hashable, Hashable]:
    """Of findings that are alike, those in the same words are matched first."""
    same = identity(finding, names)
    return (same, names.ticked(finding.message)), same
