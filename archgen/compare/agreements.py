"""What partners agreed on: which entries of `review.accepted` excuse that a change breaks a partner.

An entry excuses a loss of a partner if it names element and key of the change, stands in that partner's own file
(`review/PARTNER.yaml`, which CODEOWNERS gives to its reviewers), and was not there before
(docs/decisions/0008-review-section.md).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from archgen.compare.change_hashes import agreement_key
from archgen.compare.comparison import Change, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.model.review_settings import AcceptedChange


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
    old_entries = {_identity(entry) for entry in entries[0]}
    naming_entries = [entry for entry in entries[1] if names_change(entry, change)]
    reasons = {
        entry.partner: entry.reason for entry in naming_entries if entry.key and _identity(entry) not in old_entries
    }
    judged_breaks = tuple(
        replace(each, agreement=reasons.get(find_partner_id(each.partner, matched_ids))) for each in breaks
    )
    agreed_partners = {find_partner_id(each.partner, matched_ids) for each in judged_breaks if each.agreement}
    claims = tuple(entry for entry in naming_entries if not _excuses(entry, agreed_partners, old_entries))
    return replace(change, breaks=judged_breaks, claims=claims)


def names_change(entry: AcceptedChange, change: Change) -> bool:
    """Whether an entry speaks of a change: its element, and its key if it names one."""
    return entry.element == change.element_id and entry.key in {None, agreement_key(change)}


def _excuses(entry: AcceptedChange, agreed_partners: Collection[str], old_entries: Collection[object]) -> bool:
    return entry.key is not None and entry.partner in agreed_partners and _identity(entry) not in old_entries


def _identity(entry: AcceptedChange) -> tuple[str | None, ...]:
    return entry.partner, entry.element, entry.key, entry.reason
