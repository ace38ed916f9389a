"""What partners agreed on: which entries of `review.accepted` excuse that a change breaks a partner.

An entry excuses a loss of a partner if it names element, key and hash of the change, or the port and the key of a promise
that is kept no more (whatever causes that) with the hash of this, stands in that partner's own file
(`review/PARTNER.yaml`, which CODEOWNERS gives to its reviewers), was not there before
(docs/decisions/0008-review-section.md), and was not written for the partner by somebody else.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import compress
from typing import Literal

from archgen.compare.change_hashes import agreement_key, hash_change, hash_values, summarize_change
from archgen.compare.comparison import Change, Comparison, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.version_pair import VersionPair
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.review_settings import AcceptedChange

Flaw = Literal["foreign file", "no key", "before", "other change", "other author"]
"""Why an entry about a change excuses nothing."""


@dataclass(frozen=True, slots=True)
class AgreementJudge:
    """Judges what the second version says of changes: entries of the first one were written for another change."""

    before: Architecture
    after: Architecture
    matched_ids: MatchedIds
    versions: VersionPair
    facts: ReviewFacts = ReviewFacts()

    @classmethod
    def from_comparison(cls, comparison: Comparison) -> AgreementJudge:
        """Return the judge of a comparison that was made."""
        before, after = comparison.before.architecture, comparison.after.architecture
        return cls(before, after, comparison.matched_ids, comparison.versions, comparison.facts)

    def judge(self, change: Change, breaks: Iterable[PartnerBreak]) -> Change:
        """Return a change with its breaks: which partner agreed, and which entries speak of it and excuse nothing."""
        change = replace(change, breaks=tuple(breaks))
        hashes = {partner: hash_change(change, self.versions, partner) for partner in change.broken_partners}
        change = replace(change, breaks=tuple(replace(each, hash=hashes[each.partner]) for each in change.breaks))
        naming_entries = [entry for entry in self.after.review.accepted if names_change(entry, change)]
        flawed = [self.find_flaw(entry, change) is not None for entry in naming_entries]
        claims = tuple(compress(naming_entries, flawed))
        agreeing = [entry for entry, is_flawed in zip(naming_entries, flawed, strict=True) if not is_flawed]
        entries = [
            next((entry for entry in reversed(agreeing) if self._excuses(entry, change, each)), None)
            for each in change.breaks
        ]
        judged_breaks = (
            replace(each, agreement=entry.reason, agreed_hash=entry.was) if entry else each
            for each, entry in zip(change.breaks, entries, strict=True)
        )
        return replace(change, breaks=tuple(judged_breaks), claims=claims)

    def find_flaw(self, entry: AcceptedChange, change: Change) -> Flaw | None:
        """Return why an entry about a change excuses nothing, None where it does."""
        hashes = [found for each in change.breaks if (found := self._find_hash(entry, change, each))]
        if not hashes or entry.partner is None:
            return "foreign file"
        if entry.key is None:
            return "no key"
        # What two entries say may be the same in the files of two partners.
        if any((entry.partner, entry) == (old.partner, old) for old in self.before.review.accepted):
            return "before"
        if not any(self._is_agreed(entry, change, change_hash) for change_hash in hashes):
            return "other change"
        is_own = self.facts.may_agree(entry.at.file, entry.partner, self.before.partners)
        return None if is_own else "other author"

    def _excuses(self, entry: AcceptedChange, change: Change, partner_break: PartnerBreak) -> bool:
        change_hash = self._find_hash(entry, change, partner_break)
        return change_hash is not None and self._is_agreed(entry, change, change_hash)

    def _find_hash(self, entry: AcceptedChange, change: Change, partner_break: PartnerBreak) -> str | None:
        """Return the hash that an entry has to carry to excuse a loss; None where it does not speak of it."""
        if entry.partner != find_partner_id(partner_break.partner, self.matched_ids):
            return None
        if partner_break.fallen is not None and (entry.element, entry.key) == partner_break.fallen:
            return hash_values([partner_break.fallen_state])
        return partner_break.hash if _names_element(entry, change) else None

    def _is_agreed(self, entry: AcceptedChange, change: Change, change_hash: str) -> bool:
        """Whether an entry means this very change: by its hash, else by what had changed when it was written."""
        if entry.was is not None:
            return entry.was == change_hash
        agreed_hashes = self.facts.agreed_hashes(entry.at.file)
        current_hash = hash_values(summarize_change(change, self.versions))
        return agreed_hashes is None or agreed_hashes.get((change.element_id, agreement_key(change))) == current_hash


def find_partner_id(partner: str, matched_ids: MatchedIds) -> str:
    """Return the id that names a partner's file: that of the first version, which the branch cannot choose."""
    return matched_ids.old_ids.get("partner", {}).get(partner, partner)


def names_change(entry: AcceptedChange, change: Change) -> bool:
    """Whether an entry speaks of a change: its element, and its key if it names one; or of what it leaves unkept."""
    return _names_element(entry, change) or any(each.fallen == (entry.element, entry.key) for each in change.breaks)


def _names_element(entry: AcceptedChange, change: Change) -> bool:
    return entry.element == change.element_id and entry.key in {None, agreement_key(change)}


def list_agreement_targets(change: Change, breaks: Iterable[PartnerBreak]) -> Iterator[tuple[str, str, str]]:
    """Yield what entries have to name to excuse losses by a change: element, key and hash."""
    yield from dict.fromkeys(
        (*each.fallen, hash_values([each.fallen_state]))
        if each.fallen
        else (change.element_id, agreement_key(change), each.hash)
        for each in breaks
    )
