"""Compare two versions as a whole: changes, findings, chains and the owners concerned.

The chains whose bound or deadline changed, and why; hosts and links whose load changed so much that people should see it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Literal

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import (
    TimingPair,
    analyse_timing_pair,
    can_affect_timing,
    compare_limits,
    find_activity_owners,
    is_rewording,
)
from archgen.compare.boundary_changes import find_boundary_changes
from archgen.compare.breaking_changes import find_idle_acceptances, mark_breaking_changes, stricter_policy
from archgen.compare.change_listing import find_changes
from archgen.compare.comparison import BoundaryChange, ChainChange, Change, Comparison, LoadChange
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.interface_figures import is_close_value, is_same_duration, is_smaller
from archgen.compare.kinds import Worsening, find_key
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.losses.weakened_demands import list_policy_partners
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.type_edits import trace_origins
from archgen.diagnostics import Diagnostic, Severity
from archgen.diagnostics.finding_identity import identify_finding, match_findings
from archgen.frozen import NamedTuple, replace
from archgen.model.architecture import Architecture
from archgen.model.project_settings import AcceptedChange
from archgen.simulation.chain_witnesses import judge_chains
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue


class _ImprovementCauses(TimingCauses):
    """The causes of a figure that is better: those that cannot have made it worse."""

    def can_worsen(self, change: Change) -> bool:
        worsening = find_key(change.element_kind, change.key).worsening if change.key is not None else None
        has_direction = worsening in {Worsening.LESS, Worsening.MORE}
        return can_affect_timing(change) and not (has_direction and super().can_worsen(change))

    def heavier_activities(self, activity_ids: Iterable[str]) -> list[str]:
        own_ids = list(activity_ids)
        heavier_ids = super().heavier_activities(own_ids)
        shares = (self.timing_pair.before, self.timing_pair.after)
        lighter_ids = [
            name
            for name in own_ids
            if (old_name := self.old_activity(name)) is not None
            and shares[0].paces[old_name].rate.value != shares[1].paces[name].rate.value
        ]
        return list(dict.fromkeys([*heavier_ids, *lighter_ids]))


def add_chain_causes(
    context: ChangeContext, chains: Sequence[ChainChange], timing_pair: TimingPair | None
) -> tuple[ChainChange, ...]:
    """Return chains with the changes that made their bounds what they are."""
    if timing_pair is None or not chains:
        return tuple(chains)
    worsening_causes, improvement_causes = TimingCauses(context, timing_pair), _ImprovementCauses(context, timing_pair)
    return tuple(
        replace(
            chain,
            causes=tuple(_list_causes(context, chain, improvement_causes if _is_better(chain) else worsening_causes)),
        )
        for chain in chains
    )


def _is_better(chain: ChainChange) -> bool:
    """Whether a chain takes shorter than before, as far as that is known."""
    old_bound, new_bound = (result.bound if result else UNKNOWN_VALUE for result in (chain.before, chain.after))
    # The sum of what is known, where figures are missing, is less than the bound that it was.
    if old_bound.complete != new_bound.complete:
        return new_bound.complete
    return new_bound.value is not None and (old_bound.value is None or new_bound.value < old_bound.value)


def _list_causes(context: ChangeContext, chain: ChainChange, causes: TimingCauses) -> Iterator[Change]:
    # A chain that came or went has no other reason than that.
    if chain.before is None or chain.after is None:
        return
    indices = context.change_indices("chain", chain.id, "through") or _find_causes(chain.before, chain.after, causes)
    yield from (context.changes[index] for index in dict.fromkeys(indices))


def _find_causes(old_result: ChainResult, new_result: ChainResult, causes: TimingCauses) -> list[int]:
    if not new_result.terms:
        return causes.find_cuts([term.activity for term in old_result.terms])[0]
    old_terms = {term.activity: term for term in old_result.terms}
    other_activities = []
    for term in new_result.terms:
        old_term = old_terms.get(causes.old_activity(term.activity) or "")
        figures = (
            (getattr(each, key).value for key in ("sampling", "response", "link")) for each in (old_term, term) if each
        )
        if old_term is None or len({tuple(each) for each in figures}) > 1:
            other_activities.append(term.activity)
    indices = causes.find_causes(other_activities)
    if indices:
        return indices
    # No figure leads to it, as after the loss of a host's cores; of one change nobody doubts that it is the cause.
    other_indices = causes.all_worsening_changes()
    return other_indices if len(other_indices) == 1 else []


def compare_chains(
    before: Architecture, after: Architecture, matched_ids: MatchedIds, timing_pair: TimingPair | None
) -> tuple[ChainChange, ...]:
    """Return the chains that were added or removed, or have another bound or deadline, in the order of the second
    version.
    """
    if timing_pair is None:
        return ()
    new_results, old_results = _chain_results(after, timing_pair.after), _chain_results(before, timing_pair.before)
    kept_pairs = [(matched_ids.old_ids.get("chain", {}).get(name), name) for name in new_results]
    removed_pairs = [(name, None) for name in old_results if matched_ids.find_new_id("chain", name) is None]
    result_pairs = (
        (old_results.get(old_result) if old_result else None, new_results[new_result] if new_result else None)
        for old_result, new_result in (*kept_pairs, *removed_pairs)
    )

    def find_chain_owners(old_result: ChainResult | None, new_result: ChainResult | None) -> frozenset[str]:
        if _is_negligible(old_result, new_result):
            return frozenset()
        old_owners = find_activity_owners(old_result.through if old_result else (), before, timing_pair.before)
        new_owners = find_activity_owners(new_result.through if new_result else (), after, timing_pair.after)
        return new_owners | {matched_ids.common_id("partner", owner) for owner in old_owners}

    return tuple(
        ChainChange(
            chain_result.id, old_result, new_result, concerned_partners=find_chain_owners(old_result, new_result)
        )
        for old_result, new_result in result_pairs
        if (chain_result := new_result or old_result) and _results_differ(old_result, new_result)
    )


def _chain_results(architecture: Architecture, analysis: Analysis) -> Mapping[str, ChainResult]:
    return judge_chains(analysis, architecture) if architecture.chains else {}


def _results_differ(old_result: ChainResult | None, new_result: ChainResult | None) -> bool:
    if old_result is None or new_result is None:
        return True
    # The words of a bound (what it lacks, where it is from) may change without the figure: they are left out.
    limits = [
        (result.verdict, result.deadline, *((each.share, each.limit) for each in result.shares))
        for result in (old_result, new_result)
    ]
    return limits[0] != limits[1] or not is_same_duration(old_result.bound, new_result.bound)


def _is_negligible(old_result: ChainResult | None, new_result: ChainResult | None) -> bool:
    """Whether two results of a chain say the same to people, or the chain is only quicker."""
    if old_result is None or new_result is None:
        return False
    verdicts = [(result.verdict, result.deadline) for result in (old_result, new_result)]
    bounds = old_result.bound, new_result.bound
    return verdicts[0] == verdicts[1] and (is_close_value(*bounds) or is_smaller(*bounds))


_NOTICEABLE_STEP = Fraction(5, 100)
"""Smaller steps are told only where the load is high already."""
_HIGH_LOAD, _STEP_WHEN_HIGH = Fraction(80, 100), Fraction(1, 100)
"""From four fifths on, one in a hundred counts: the usual margin of those who plan the load of a computer or a bus."""


def find_link_users(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> Mapping[str, frozenset[str]] | None:
    """Return the partners whose data crosses each link in either version, None where nobody analysed that."""
    if before.analysis is None or after.analysis is None:
        return None
    users: dict[str, frozenset[str]] = {}
    for version, ids in ((before, matched_ids), (after, MatchedIds())):
        for name in version.architecture.links:
            owners = _find_users("link", name, version.architecture, version.analysis) if version.analysis else ()
            common_id = ids.common_id("link", name)
            users[common_id] = users.get(common_id, frozenset()) | {ids.common_id("partner", each) for each in owners}
    return users


def find_load_changes(
    after: Architecture, matched_ids: MatchedIds, timing_pair: TimingPair | None
) -> tuple[LoadChange, ...]:
    """Return the hosts, then the links, whose load changed noticeably."""
    if timing_pair is None or timing_pair.before is timing_pair.after:
        return ()
    old_shares = {
        (kind, matched_ids.common_id(kind, name)): share for kind, name, share in _list_shares(timing_pair.before)
    }
    return tuple(
        LoadChange(kind, name, old_shares.get((kind, name)), share, _find_users(kind, name, after, timing_pair.after))
        for kind, name, share in _list_shares(timing_pair.after)
        if _is_noticeable(old_shares.get((kind, name)), share)
    )


def _list_shares(analysis: Analysis) -> Iterator[tuple[Literal["host", "link"], str, TimingValue]]:
    for name, load in sorted(analysis.hosts.items()):
        # Of a host whose cores nobody counted there is no share.
        if load.share_of_cores is not None:
            yield "host", name, load.share_of_cores
    for name, link_load in sorted(analysis.links.items()):
        yield "link", name, link_load.share


def _is_noticeable(before: TimingValue | None, after: TimingValue) -> bool:
    if after.value is None or (before and before.value is None):
        return False
    old_share = before.value if before and before.value is not None else Fraction(0)
    step = abs(after.value - old_share)
    is_high = max(after.value, old_share) >= _HIGH_LOAD
    return step >= (_STEP_WHEN_HIGH if is_high else _NOTICEABLE_STEP)


def _find_users(kind: str, name: str, architecture: Architecture, analysis: Analysis) -> frozenset[str]:
    return find_activity_owners(_list_activities(kind, name, analysis), architecture, analysis)


def _list_activities(kind: str, name: str, analysis: Analysis) -> Iterable[str]:
    """Return the activities on a host, or those that send or receive over a link."""
    if kind == "host":
        return (activity.id for activity in analysis.system.activities.values() if activity.host == name)
    return (end for arc in analysis.system.arcs if arc.link == name for end in (arc.source, arc.target))


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
