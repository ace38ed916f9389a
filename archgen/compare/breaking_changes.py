"""Decide which changes break another partner, whom and why, and to which of them the partner agreed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from archgen.compare.agreements import AgreementJudge, names_change
from archgen.compare.asked_limits import TimingPair, is_rewording
from archgen.compare.comparison import ChainChange, Change, Comparison, LimitChange, PartnerBreak
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.changed_definitions import (
    find_changed_distro,
    find_deprecated_types,
    find_redefined_messages,
    find_retyped_outputs,
)
from archgen.compare.losses.changed_meanings import find_changed_frames, find_changed_meanings, find_changed_parameters
from archgen.compare.losses.fallen_figures import (
    find_chains_made_late,
    find_fallen_limits,
    find_overloaded_cores,
    find_saturated_links,
    find_weakened_deadlines,
)
from archgen.compare.losses.lost_connections import (
    find_cut_steps,
    find_lost_connections,
    find_redirected_connections,
    find_renamed_sources,
    find_unmade_connections,
)
from archgen.compare.losses.parted_ends import find_parted_ends, find_renamed_topics
from archgen.compare.losses.separated_causes import CauseSeparator
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.losses.weakened_demands import (
    find_rewritten_requirements,
    find_unserved_requirements,
    find_weakened_policies,
    find_weakened_words,
)
from archgen.compare.losses.weakened_outputs import find_foreign_edits, find_weakened_outputs, find_weakened_sizes
from archgen.diagnostics import Severity
from archgen.frozen import replace
from archgen.model.project_settings import AcceptedChange, BreakPolicy, ReviewSettings

_LOSS_FINDERS = (
    *(find_lost_connections, find_unmade_connections, find_redirected_connections, find_changed_distro),
    *(find_retyped_outputs, find_redefined_messages, find_renamed_topics, find_parted_ends, find_weakened_outputs),
    *(find_weakened_words, find_deprecated_types, find_weakened_sizes, find_unserved_requirements),
    *(find_rewritten_requirements, find_weakened_policies, find_cut_steps, find_changed_meanings, find_changed_frames),
    *(find_changed_parameters, find_renamed_sources, find_foreign_edits),
)
_WORD_LOSS_FINDERS = (find_rewritten_requirements, find_changed_meanings, find_foreign_edits)
"""Those of them that titles and texts alone may concern."""


def stricter_policy(old_review: ReviewSettings, new_review: ReviewSettings) -> BreakPolicy:
    """Return the stricter policy of both versions, so that no branch weakens the policy it is judged by."""
    return (old_review.breaking or BreakPolicy()).combine_stricter(new_review.breaking or BreakPolicy())


def mark_breaking_changes(
    context: ChangeContext,
    chains: Sequence[ChainChange],
    limits: Sequence[LimitChange],
    timing_pair: TimingPair | None,
    policy: BreakPolicy,
) -> tuple[Change, ...]:
    """Add to each change whom it breaks and whether that is accepted; breaking changes come first, the gravest before the
    others, accepted ones after the rest of them. What the policy does not ask for is no loss.
    """
    if not context.changes or not (context.before.partners or context.after.partners):
        return tuple(context.changes)
    # An inner dict instead of a list: two finders may report the same loss of the same partner, and the order must
    # stay.
    breaks_by_index: dict[int, dict[PartnerBreak, None]] = defaultdict(dict)
    for loss in _find_losses(context, chains, limits, timing_pair):
        if policy.severity_of(loss.category) is not Severity.OFF:
            partner_break = PartnerBreak(
                loss.partner,
                loss.reason,
                category=loss.category,
                fallen=loss.fallen,
                hash=loss.hash,
                at_most=loss.at_most,
            )
            breaks_by_index[loss.change_index][partner_break] = None
    judge = AgreementJudge(context.before, context.after, context.matched_ids, context.versions, context.facts)
    marked_changes = [
        judge.judge(change, breaks_by_index[index]) if index in breaks_by_index else change
        for index, change in enumerate(context.changes)
    ]
    return sort_breaks_first(marked_changes, policy)


def sort_breaks_first(changes: Sequence[Change], policy: BreakPolicy) -> tuple[Change, ...]:
    """Return changes with those that break somebody first, the gravest before the others, accepted ones after the rest."""
    # The sort is stable: within each class the order of `change_order` remains.
    return tuple(sorted(changes, key=lambda change: _rank_change(change, policy)))


def _rank_change(change: Change, policy: BreakPolicy) -> tuple[bool, bool, int]:
    """Return the sort key that puts first what needs an answer most."""
    severities = (policy.severity_of(each.category).rank for each in change.breaks)
    return not change.breaks, change.acceptance_reason is not None, -max(severities, default=0)


def _find_losses(
    context: ChangeContext,
    chains: Sequence[ChainChange],
    limits: Sequence[LimitChange],
    timing_pair: TimingPair | None,
) -> Iterator[PartnerLoss]:
    for find_losses in _WORD_LOSS_FINDERS if all(map(is_rewording, context.changes)) else _LOSS_FINDERS:
        yield from find_losses(context)
    if timing_pair:
        causes = TimingCauses(context, timing_pair)
        separator = CauseSeparator(causes)
        yield from find_fallen_limits(context, limits, causes, separator)
        yield from find_chains_made_late(context, chains, causes, separator)
        yield from find_weakened_deadlines(context, chains, causes)
        yield from find_overloaded_cores(context, causes)
        yield from find_saturated_links(context, causes)


def find_idle_acceptances(changes: Sequence[Change], review: ReviewSettings) -> tuple[AcceptedChange, ...]:
    """Return the accepted entries that name no breaking change."""
    return tuple(
        entry
        for entry in review.accepted
        if not any(change.breaks and names_change(entry, change) for change in changes)
    )


def keep_breaking_only(comparison: Comparison) -> Comparison:
    """Keep only the changes that break somebody, without other changes, chains and findings."""
    changes = tuple(change for change in comparison.changes if change.breaks)
    concerned_owners = find_concerned_owners(changes, comparison.versions)
    return replace(
        comparison,
        changes=changes,
        new_findings=(),
        cured_findings=(),
        silenced_findings=(),
        chains=(),
        concerned_owners=concerned_owners,
        boundaries=(),
        limits=(),
        loads=(),
        only_breaking=True,
    )
