"""Compare two versions as a whole: changes, findings, chains and the owners concerned."""

from __future__ import annotations

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import compare_limits
from archgen.compare.boundary_changes import find_boundary_changes
from archgen.compare.breaking_changes import find_idle_acceptances, mark_breaking_changes, stricter_policy
from archgen.compare.change_listing import find_changes
from archgen.compare.comparison import BoundaryChange, Comparison, LoadChange
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.finding_changes import judge_findings
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.weakened_demands import list_policy_partners
from archgen.compare.match_elements import match_elements
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.timing_changes import add_chain_causes, compare_chains, find_link_users, find_load_changes
from archgen.compare.timing_pair import analyse_timing_pair
from archgen.compare.type_edits import trace_origins
from archgen.diagnostics.diagnostic import Severity
from archgen.frozen import replace
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
    if changes:
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
