"""What open branches break only together: each breaks nobody by itself, and whichever is merged second does."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator

from archgen.compare import Change, Comparison, PartnerBreak
from archgen.compare.change_spans import find_change_span, find_old_file
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.diagnostics import NO_SPAN, Diagnostic, Span, join_words
from archgen.edit.refactoring.followed_branches import follow_branches
from archgen.findings.rule_table import BREAKING_CHANGE
from archgen.frozen import replace
from archgen.link.interface_sources import interface_name_of
from archgen.merge.branch_results import BranchJudges, JointBreaks
from archgen.pipeline import CheckedProject
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.changes.breaking_verdict import describe_remedy, join_categories
from archgen.views.changes.named_elements import name_each, name_partners

_NAME = re.compile(r"`[^`]+`")


def find_joint_breaks(
    base: CheckedProject, ours: CheckedProject, theirs: CheckedProject, merged: CheckedProject
) -> JointBreaks:
    """Compare each side with the merged project, and keep the breaks that the other side's change does not make alone.

    `base` is what both sides began with. What a side breaks by itself its own review tells.
    """
    # What could not be read may break anybody: nothing that is found without it is certain.
    if not merged.architecture.partners or any(each.reading_errors for each in (base, ours, theirs, merged)):
        return JointBreaks()
    after_ours, after_theirs = _compare(ours, merged), _compare(theirs, merged)
    by_theirs, by_ours = replace(after_ours, changes=()), replace(after_theirs, changes=())
    # Most merges break nobody: then nobody has to know what either side breaks alone.
    if _breaks_anybody(after_ours):
        known = _list_breaks(
            base, theirs, match_elements(base.architecture, ours.architecture), after_theirs.matched_ids
        )
        by_theirs = _leave_out(after_ours, known)
    if _breaks_anybody(after_theirs):
        known = _list_breaks(base, ours, match_elements(base.architecture, theirs.architecture), after_ours.matched_ids)
        by_ours = _leave_out(after_theirs, known)
    partners = {
        name
        for comparison in (by_theirs, by_ours)
        for change in comparison.changes
        for name in name_each(change.unheard_partners, name_partners(comparison))
    }
    return JointBreaks(find_breaks(by_theirs, merged), find_breaks(by_ours, merged), tuple(sorted(partners)))


def _compare(before: CheckedProject, after: CheckedProject) -> Comparison:
    # Whose edits are foreign each branch was asked by its own review: here nobody is the author.
    facts = ReviewFacts(is_decided=True)
    return compare_named_versions(ProjectVersion("", before), ProjectVersion("", after), forge_facts=facts)


def _breaks_anybody(comparison: Comparison) -> bool:
    return any(change.unheard_partners for change in comparison.changes)


def _list_breaks(
    base: CheckedProject, changed: CheckedProject, old_renames: MatchedIds, new_renames: MatchedIds
) -> frozenset[Hashable]:
    """Return what one side breaks by itself, under the ids that the other side gave to what was there and is there still."""
    return frozenset(
        identity
        for change in _compare(base, changed).changes
        for each in change.breaks
        for identity in _identify_break(change, each, old_renames if change.kind == "removed" else new_renames)
    )


def _leave_out(comparison: Comparison, known: frozenset[Hashable]) -> Comparison:
    same_ids = MatchedIds()
    changes = tuple(
        replace(
            change, breaks=tuple(b for b in change.breaks if known.isdisjoint(_identify_break(change, b, same_ids)))
        )
        for change in comparison.changes
    )
    return replace(comparison, changes=changes)


def _identify_break(change: Change, partner_break: PartnerBreak, renamed_ids: MatchedIds) -> Iterator[Hashable]:
    """Yield what tells a break from others: which change makes it, and what is lost.

    A figure may be laid at another of several changes where the other side is there, too, and a reason may name others who
    are hit: neither is another break.
    """
    whose = partner_break.partner, partner_break.category
    kind = "input" if change.element_kind == "connection" else change.element_kind
    yield *whose, kind, renamed_ids.common_id(kind, change.element_id), change.key
    yield *whose, frozenset(_NAME.findall(renamed_ids.rename_in_backticks(partner_break.reason)))


def find_breaks(comparison: Comparison, checked_project: CheckedProject) -> tuple[Diagnostic, ...]:
    """Return a finding for each change that breaks a partner who did not agree, in the order of the comparison.

    `checked_project` is the second version: the findings stand in its files.
    """
    return tuple(
        _describe_break(change, comparison, checked_project) for change in comparison.changes if change.unheard_partners
    )


def _describe_break(change: Change, comparison: Comparison, checked_project: CheckedProject) -> Diagnostic:
    unheard_breaks = [each for each in change.breaks if each.agreement is None]
    reasons = dict.fromkeys(each.reason for each in unheard_breaks)
    categories = join_categories(each.category for each in unheard_breaks)
    partners = name_each(change.unheard_partners, name_partners(comparison))
    return Diagnostic(
        BREAKING_CHANGE.name,
        f"breaks {join_words(partners)} ({categories}): {change.text}; this {join_words(list(reasons))}",
        _find_span(change, comparison, checked_project),
        comparison.break_severity(change),
        help=describe_remedy(change, comparison),
        element=change.element_id,
    )


def _find_span(change: Change, comparison: Comparison, checked_project: CheckedProject) -> Span:
    """Return where the change stands; the whole file of a message, or in which the removed element stood."""
    span = find_change_span(change, comparison)
    if span.file:
        return span
    files = [
        *(
            file
            for file in checked_project.loaded_project.interface_files
            if interface_name_of(file) == change.element_id
        ),
        find_old_file(change, comparison),
    ]
    file = next((file for file in files if checked_project.sources.text_of(file) is not None), None)
    return Span.of_file(file) if file else NO_SPAN


BRANCH_JUDGES = BranchJudges(find_joint_breaks, follow_branches)
"""All that merging branches asks about them."""
