"""New findings that say the same as a breaking change: they are shown with it, and not a second time."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.compare import Change, Comparison
from archgen.diagnostics.diagnostic import Diagnostic

_BACKTICKED = re.compile(r"`([^`]*)`")
_RULES = frozenset({"incompatible-qos", "unfed-input", "late-chain", "overloaded-host", "saturated-link"})
"""The rules whose findings have a break that says the same. Others say more than that somebody loses something."""


def find_repeated_findings(comparison: Comparison) -> Mapping[Diagnostic, Change]:
    """Return the new findings that a breaking change tells, each with the change."""
    breaking_changes = [change for change in comparison.changes if change.breaks]
    return {
        finding: change
        for finding in comparison.new_findings
        if finding.rule in _RULES
        for change in breaking_changes[::-1]
        if _tells_finding(change, finding)
    }


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
    if finding.rule == "incompatible-qos":
        yield from names
    elif finding.rule == "unfed-input" and len(names) > 1:
        yield f"{names[1]}.{names[0]}"
    elif finding.rule == "late-chain" and finding.element:
        yield finding.element
    elif finding.rule in {"overloaded-host", "saturated-link"}:
        # Of what follows behind the name, as the largest part of the traffic, breaks say nothing.
        yield from names[:1]
