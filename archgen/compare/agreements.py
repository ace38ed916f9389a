"""What partners agreed on: which entries of `review.accepted` excuse that a change breaks a partner.

An entry excuses a loss of a partner if it names element and key of the change, or the port and the key of a promise that
is not kept any more (whatever causes that), stands in that partner's own file
(`review/PARTNER.yaml`, which CODEOWNERS gives to its reviewers), and was not there before
(docs/decisions/0008-review-section.md).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace

from archgen.compare.comparison import Change, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.model.review_settings import AcceptedChange


def agreement_key(change: Change) -> str:
    """Return what an entry has to name as the `key` of a change: `removed`, `renamed` and so on where no key changed."""
    return change.key or change.kind


def find_partner_id(partner: str, matched_ids: MatchedIds) -> str:
    """Return the id that names a partner's file: that of the first version, which the branch cannot choose."""
    return matched_ids.old_ids.get("partner", {}).get(partner, partner)


def judge_agreements(
    change: Change,
    breaks: Iterable[PartnerBreak],
    entries: tuple[Iterable[AcceptedChange], Iterable[AcceptedChange]],
    matched_ids: MatchedIds,
) -> Change:
    """Return a change with its breaks: which partner agreed, and which entries speak of it and excuse nothing.

    `entries` are those of both versions. An entry of the first one was written for another change.
    """
    change = replace(change, breaks=tuple(breaks))
    old_entries = {_identity(entry) for entry in entries[0]}
    naming_entries = [entry for entry in entries[1] if names_change(entry, change)]
    valid_entries = [entry for entry in naming_entries if entry.key and _identity(entry) not in old_entries]
    judged_breaks = tuple(
        replace(each, agreement=_find_reason(valid_entries, change, each, find_partner_id(each.partner, matched_ids)))
        for each in change.breaks
    )
    agreed_partners = {find_partner_id(each.partner, matched_ids) for each in judged_breaks if each.agreement}
    claims = tuple(entry for entry in naming_entries if not _excuses(entry, agreed_partners, old_entries))
    return replace(change, breaks=judged_breaks, claims=claims)


def names_change(entry: AcceptedChange, change: Change) -> bool:
    """Whether an entry speaks of a change: its element, and its key if it names one; or of what is not kept by it."""
    return _names_element(entry, change) or any(each.fallen == (entry.element, entry.key) for each in change.breaks)


def list_agreement_targets(change: Change, breaks: Iterable[PartnerBreak]) -> Iterator[tuple[str, str]]:
    """Yield what entries have to name as element and key to excuse losses by a change."""
    yield from dict.fromkeys(each.fallen or (change.element_id, agreement_key(change)) for each in breaks)


def _names_element(entry: AcceptedChange, change: Change) -> bool:
    return entry.element == change.element_id and entry.key in {None, agreement_key(change)}


def _find_reason(
    entries: Iterable[AcceptedChange], change: Change, partner_break: PartnerBreak, partner: str
) -> str | None:
    """Return why a partner agrees to a loss, None if it does not; the last entry counts."""
    reasons = [
        entry.reason
        for entry in entries
        if entry.partner == partner
        and (_names_element(entry, change) or partner_break.fallen == (entry.element, entry.key))
    ]
    return reasons[-1] if reasons else None


def _excuses(entry: AcceptedChange, agreed_partners: Collection[str], old_entries: Collection[object]) -> bool:
    return entry.key is not None and entry.partner in agreed_partners and _identity(entry) not in old_entries


def _identity(entry: AcceptedChange) -> tuple[str | None, ...]:
    return entry.partner, entry.element, entry.key, entry.reason
