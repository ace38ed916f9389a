"""New findings that say the same as a breaking change, or as an edit of what is read: shown with it, and not a second time."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.compare import Change, Comparison
from archgen.compare.left_out_files import find_affected_names, find_left_out
from archgen.diagnostics.diagnostic import Diagnostic

_BACKTICKED = re.compile(r"`([^`]*)`")
_PAIR_RULES = frozenset({"incompatible-qos", "two-domains", "two-clocks"})
"""Those whose findings name two ends in front of a colon."""
_RULES = _PAIR_RULES | {"remapped-away", "unfed-input", "late-chain", "overloaded-host", "saturated-link"}
"""The rules whose findings have a break that says the same. Others say more than that somebody loses something."""

_UNREAD_RULES = frozenset({"missing-detail", "unchecked-message", "unmapped-component"})
"""The rules that find what is missing of an element: they say nothing new of one that is not read any more."""


def find_repeated_findings(comparison: Comparison) -> Mapping[Diagnostic, Change]:
    """Return the new findings that a change tells, each with the change."""
    breaking_changes = [change for change in comparison.changes if change.breaks]
    # Later ones come first, and what breaks somebody counts more than what is only not read any more.
    return dict(_find_unread_subjects(comparison)) | {
        finding: change
        for finding in comparison.new_findings
        if finding.rule in _RULES
        for change in breaking_changes[::-1]
        if _tells_finding(change, finding)
    }


def _find_unread_subjects(comparison: Comparison) -> Iterator[tuple[Diagnostic, Change]]:
    """Yield the findings about what a file held that is not read any more, with a change of the edit that says so."""
    for left_out in find_left_out(comparison, comparison.changes):
        # Only a breaking change is shown with findings.
        if not any(change.breaks for change in left_out.removals):
            continue
        names = find_affected_names(comparison, left_out.removals)
        for finding in comparison.new_findings:
            subjects = _BACKTICKED.findall(finding.message)[:1]
            if finding.rule in _UNREAD_RULES and names.issuperset(subjects):
                yield finding, left_out.removals[0]


def _tells_finding(change: Change, finding: Diagnostic) -> bool:
    """Whether one of the losses of a change names all that the finding names."""
    needed_names = set(_name_subjects(finding))
    for each in change.breaks:
        names = {*_BACKTICKED.findall(each.reason), *change.element_id.split("."), change.element_id}
        if needed_names and needed_names <= names:
            return True
    return False


def _name_subjects(finding: Diagnostic) -> Iterator[str]:
    """Yield what a finding is about: the names in front of its explanation, ports with their complete ids."""
    names = _BACKTICKED.findall(finding.message.partition(": ")[0])
    if finding.rule in _PAIR_RULES:
        yield from names
    elif finding.rule == "remapped-away":
        yield from names[:2]
    elif finding.rule == "unfed-input" and len(names) > 1:
        yield f"{names[1]}.{names[0]}"
    elif finding.rule == "late-chain" and finding.element:
        yield finding.element
    elif finding.rule in {"overloaded-host", "saturated-link"}:
        # Of what follows behind the name, as the largest part of the traffic, breaks say nothing.
        yield from names[:1]
