"""Split findings into new, cured and silenced ones: by what they say about which element, never by their position."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.finding_identity import identify_finding, match_findings
from archgen.frozen import NamedTuple


class JudgedFindings(NamedTuple):
    """Findings that appeared, that were cured, and that are still there but hidden."""

    new_findings: tuple[Diagnostic, ...]
    cured_findings: tuple[Diagnostic, ...]
    silenced_findings: tuple[Diagnostic, ...]


def judge_findings(before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds) -> JudgedFindings:
    """Classify the findings of both versions. A finding that only gives another figure is none of these.

    If a part of the first version could not be read, what was found there is unknown: then only errors are new. What
    rules of the second version wait to judge is not cured.
    """
    new_findings, missing_findings = _split_findings(before.findings, after.findings, matched_ids)
    if before.architecture.unread_keys or before.waiting_rules:
        new_findings = tuple(finding for finding in new_findings if finding.severity is Severity.ERROR)
    missing_findings = tuple(finding for finding in missing_findings if finding.rule not in after.waiting_rules)
    _, cured_findings = _split_findings(missing_findings, after.silenced_findings, matched_ids)
    # By object identity: two equal findings are two findings.
    cured_ids = set(map(id, cured_findings))
    return JudgedFindings(
        new_findings, cured_findings, tuple(finding for finding in missing_findings if id(finding) not in cured_ids)
    )


def _split_findings(
    old_findings: Sequence[Diagnostic], new_findings: Sequence[Diagnostic], matched_ids: MatchedIds
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that are only in the second version, and those only in the first."""
    matched_positions = match_findings(
        [_match_keys(finding, MatchedIds()) for finding in new_findings],
        [_match_keys(finding, matched_ids) for finding in old_findings],
    )
    unmatched_positions = set(range(len(old_findings))).difference(matched_positions)
    unmatched_findings = tuple(
        finding for finding, old_position in zip(new_findings, matched_positions, strict=True) if old_position is None
    )
    return unmatched_findings, tuple(old_findings[position] for position in sorted(unmatched_positions))


def _match_keys(finding: Diagnostic, matched_ids: MatchedIds) -> tuple[Hashable, Hashable]:
    """Return the keys to match by, the strictest first: among similar findings those with the same words are matched
    first.
    """
    finding_identity = identify_finding(finding, matched_ids)
    return (finding_identity, matched_ids.rename_in_backticks(finding.message)), finding_identity
