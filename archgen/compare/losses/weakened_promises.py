"""Chains whose deadline was relaxed or taken away, alone or with the chain, or that lead past a part of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.compare.comparison import ChainChange
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_sorted_names
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_duration


def find_weakened_deadlines(
    context: ChangeContext, chains: Sequence[ChainChange], causes: TimingCauses
) -> Iterator[PartnerLoss]:
    """Find chains that promise less than before to several partners with a part on them.

    Otherwise relaxing the deadline, in the change that would miss it, would be enough to miss it.
    """
    for chain_change in chains:
        old_result = chain_change.before
        if old_result is None or old_result.find_limit(Fraction(0)) is None:
            continue
        parts = _parts_by_owner(context, causes, old_result)
        for indices, reason_text in _find_weakenings(context, causes, chain_change, old_result):
            if len(parts) > 1 or "" in parts:
                owned_parts = {owner: names for owner, names in parts.items() if owner}
                yield from context.shared_losses(indices, owned_parts, reason_text + "; {} on it", "is")


def _find_weakenings(
    context: ChangeContext, causes: TimingCauses, chain_change: ChainChange, old_result: ChainResult
) -> Iterator[tuple[list[int], str]]:
    """Yield what a change of a chain takes from its promise, with the indices of the changes that do so."""
    chain_id, new_result = chain_change.id, chain_change.after
    asked = [(each.share, f" for {each.name} of its reactions") for each in old_result.shares]
    if old_result.deadline is not None and old_result.deadline.value is not None:
        asked = [(Fraction(1), ""), *asked]
    if new_result is None:
        common_id = context.matched_ids.common_id("chain", chain_id)
        removal_indices = context.indices_by_change_kind("chain", common_id, "removed")
        limit_text = format_duration(old_result.find_limit(asked[0][0]) or 0)
        yield removal_indices, f"takes away the chain `{chain_id}` with its deadline of {limit_text}{asked[0][1]}"
        return
    keys = ("deadline", *(f"deadline.{each.name}" for each in (*old_result.shares, *new_result.shares)))
    deadline_indices = context.change_indices("chain", chain_id, *dict.fromkeys(keys))
    for share, share_text in asked:
        old_limit, new_limit = old_result.find_limit(share) or Fraction(0), new_result.find_limit(share)
        if new_limit is None:
            yield (
                deadline_indices,
                f"takes the deadline of {format_duration(old_limit)}{share_text} from the chain `{chain_id}`",
            )
        elif new_limit > old_limit:
            limits_text = f"from {format_duration(old_limit)} to {format_duration(new_limit)}"
            yield deadline_indices, f"relaxes the deadline of the chain `{chain_id}`{share_text} {limits_text}"
    passed_names = _find_passed_parts(causes, chain_change) if new_result.terms else []
    if passed_names:
        through_indices = context.change_indices("chain", chain_id, "through")
        yield (
            through_indices,
            f"leads the chain `{chain_id}` with its deadline past {tick_sorted_names(passed_names)}",
        )


def _find_passed_parts(causes: TimingCauses, chain_change: ChainChange) -> list[str]:
    """Return the parts that a chain was asked to lead through and no longer does, of those that are still there."""
    if chain_change.before is None or chain_change.after is None:
        return []
    old_system, new_system = causes.timing_pair.before.system, causes.timing_pair.after.system
    new_parts = {
        _part_name(causes.activity_key(new_system.activities[term.activity])) for term in chain_change.after.terms
    }
    present_parts = {_part_name(causes.activity_key(activity)) for activity in new_system.activities.values()}
    passed_names = []
    for term in chain_change.before.terms:
        activity = old_system.activities[term.activity]
        part = _part_name(causes.old_activity_key(activity))
        is_waypoint = any(
            point in {activity.component, activity.node} or point.rpartition(".")[0] == activity.component
            for point in chain_change.before.through
        )
        if is_waypoint and part in present_parts - new_parts:
            passed_names.append(term.activity)
    return passed_names


def _part_name(activity_key: tuple[str, str]) -> str:
    """Return an activity's component, whatever node runs it, or its node if it has no component."""
    component, node = activity_key
    return component or node


def _parts_by_owner(
    context: ChangeContext, causes: TimingCauses, old_result: ChainResult
) -> Mapping[str, Sequence[str]]:
    """Return what is on a chain of the first version by owner, "" for what nobody owns."""
    activity_ids = {term.activity for term in old_result.terms}
    parts: dict[str, list[str]] = causes.old_activities_by_owner(activity_ids)
    if not activity_ids:
        # A chain without a path has no activities: what it names is on it.
        for point in old_result.through:
            parts.setdefault(_owner_of_point(context, point), []).append(point)
    elif sum(map(len, parts.values())) < len(activity_ids):
        parts[""] = []
    return parts


def _owner_of_point(context: ChangeContext, point: str) -> str:
    owners = (
        context.owner_before(kind, context.matched_ids.common_id(kind, point))
        for kind in ("component", "output", "node")
    )
    return next(filter(None, owners), "")
