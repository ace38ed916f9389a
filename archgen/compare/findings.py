"""Split findings into new, cured and silenced ones: by what they say about which element, never by their position."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import NamedTuple

from archgen.compare.names import Names
from archgen.compare.version import Version
from archgen.diagnostic import Diagnostic, Severity
from archgen.identity import identity, partners


class Told(NamedTuple):
    """Findings that appeared, that were cured, and that are still there but hidden."""

    new: tuple[Diagnostic, ...]
    cured: tuple[Diagnostic, ...]
    silenced: tuple[Diagnostic, ...]


def findings(before: Version, after: Version, names: Names) -> Told:
    """Classify the findings of both versions. A finding that only gives another figure is none of these.

    If a part of the first version could not be read, what was found there is unknown: then only errors are new.
    """
    new, gone = _apart(before.findings, after.findings, names)
    if before.architecture.lost:
        new = tuple(each for each in new if each.severity is Severity.ERROR)
    _, cured = _apart(gone, after.silenced, names)
    # By object identity: two equal findings are two findings.
    kept = set(map(id, cured))
    return Told(new, cured, tuple(each for each in gone if id(each) not in kept))


def _apart(
    before: Sequence[Diagnostic], after: Sequence[Diagnostic], names: Names
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that are only in the second version, and those only in the first."""
    old = partners([_keys(each, Names()) for each in after], [_keys(each, names) for each in before])
    gone = set(range(len(before))).difference(old)
    new = tuple(each for each, was in zip(after, old, strict=True) if was is None)
    return new, tuple(before[place] for place in sorted(gone))


def _keys(finding: Diagnostic, names: Names) -> tuple[Hashable, Hashable]:
    """Return the keys to match by, the strictest first: among similar findings those with the same words are matched
    first.
    """
    same = identity(finding, names)
    return (same, names.ticked(finding.message)), same
