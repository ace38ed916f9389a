"""Compare two versions as a whole: changes, findings, chains and the owners concerned."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import compare_limits
from archgen.compare.boundary_changes import find_boundary_changes
from archgen.compare.breaking_changes import find_idle_acceptances, mark_breaking_changes, stricter_policy
from archgen.compare.change_listing import find_changes
from archgen.compare.comparison import BoundaryChange, Comparison, LoadChange
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.weakened_demands import list_policy_partners
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.timing_changes import add_chain_causes, compare_chains, find_link_users, find_load_changes
from archgen.compare.timing_pair import analyse_timing_pair, is_rewording
from archgen.compare.type_edits import trace_origins
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.finding_identity import identify_finding, match_findings
from archgen.frozen import NamedTuple, replace
from archgen.model.review_settings import AcceptedChange


def compare_versions(
    before: ArchitectureVersion, after: ArchitectureVersion, *, facts: ReviewFacts | None = None
) -> Comparison:
    """Compare two versions of an architecture. `facts` are what is known of who changed it."""
    facts = facts or ReviewFacts()
    # Matching comes first: everything below lists the first version under the ids of the second.
    matched_ids = match_elements(before.architecture, after.architecture)
    version_pair, changes = find_changes(before, after, matched_ids)
    if any(change.element_kind == "link" for change in changes):
        version_pair = replace(version_pair, link_users=find_link_users(before, after, matched_ids))
    if any(change.element_kind == "policy" for change in changes):
        policy_partners = list_policy_partners(before.architecture, after.architecture, matched_ids)
        version_pair = replace(version_pair, policy_partners=policy_partners)
    judged_findings = judge_findings(before, after, matched_ids)
    timing_pair = analyse_timing_pair(before, after, changes)
    # Chains are needed twice: for the report, and as causes of losses in `mark_breaking_changes`.
    chain_changes = compare_chains(before.architecture, after.architecture, matched_ids, timing_pair)
    change_context = ChangeContext(before.architecture, after.architecture, matched_ids, version_pair, changes, facts)
    chain_changes = add_chain_causes(change_context, chain_changes, timing_pair)
    limits = compare_limits(before.architecture, after.architecture, matched_ids, timing_pair)
    policy = stricter_policy(before.architecture.review, after.architecture.review)
    idle_acceptances: tuple[AcceptedChange, ...] = ()
    if policy.gravest is not Severity.OFF:
        if policy.foreign is not Severity.OFF:
            bare = Comparison(before, after, matched_ids, version_pair, changes, (), (), (), ())
            change_context.followers = trace_origins(bare, changes)
        changes = mark_breaking_changes(
            change_context,
            chain_changes,
            limits,
            timing_pair,
            policy,
        )
        idle_acceptances = find_idle_acceptances(changes, after.architecture.review)
    boundaries: tuple[BoundaryChange, ...] = ()
    loads: tuple[LoadChange, ...] = ()
    if not all(map(is_rewording, changes)):
        boundaries = find_boundary_changes(before, after, matched_ids, timing_pair, version_pair)
        loads = find_load_changes(after.architecture, matched_ids, timing_pair)
    return Comparison(
        before,
        after,
        matched_ids,
        version_pair,
        changes,
        judged_findings.new_findings,
        judged_findings.cured_findings,
        chain_changes,
        find_concerned_owners(changes, version_pair, (*boundaries, *limits, *loads, *chain_changes)),
        judged_findings.silenced_findings,
        policy=policy,
        idle_acceptances=idle_acceptances,
        boundaries=boundaries,
        limits=limits,
        loads=loads,
        facts=facts,
    )


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
