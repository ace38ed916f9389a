"""What partners agreed on: which entries of `review.accepted` excuse that a change breaks a partner.

An entry excuses a loss of a partner if it names element, key and hash of the change, or those of a promise that is not kept
any more, stands in that partner's own file (`review/PARTNER.yaml`, which CODEOWNERS gives to its reviewers), was not there
before (docs/decisions/0008-review-section.md), and was not written for the partner by somebody else.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal

from archgen.compare.comparison import Change, Comparison, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import to_plain_data
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.version_pair import VersionPair
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.project_settings import AcceptedChange

_HASH_DIGITS = 6


def hash_values(values: Sequence[object]) -> str:
    """Return the first digits of the SHA-256 of values as canonical JSON."""
    text = json.dumps(values, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:_HASH_DIGITS]


def agreement_key(change: Change) -> str:
    """Return what an entry has to name as the `key` of a change: `removed`, `renamed` and so on where no key changed."""
    return change.key or change.kind


def _summarize_change(change: Change, versions: VersionPair) -> list[object]:
    """Return element, key, and the values before and after: those of a new element, of a removed one what goes with it."""
    before, after = change.before, change.after
    match change.kind:
        case "added":
            after = [_list_values(each, versions) for each in _walk_written(change)]
        case "removed":
            before = [[each.element_kind, each.element_id] for each in _walk_written(change)]
        case "renamed" | "moved":
            before, after = change.old_id, change.element_id
    return [change.element_id, agreement_key(change), before, after]


def hash_change(change: Change, versions: VersionPair) -> str:
    """Return the hash of a change."""
    return hash_values(_summarize_change(change, versions))


def hash_fallen_limit(port: str, key: str, limit: str, causes: Iterable[Change], versions: VersionPair) -> str:
    """Return the hash of a promise or freshness that is kept no more: which one, its limit, and what caused that."""
    return hash_values([port, key, limit, *(_summarize_change(cause, versions) for cause in causes)])


def _walk_written(change: Change) -> Iterator[Change]:
    """Yield a change with what came or went with it, without the connections that follow from that."""
    if change.element_kind != "connection":
        yield change
    for part in change.parts:
        yield from _walk_written(part)


def _list_values(change: Change, versions: VersionPair) -> list[object]:
    element = versions.elements_after.get((change.element_kind, change.element_id))
    values = {key: to_plain_data(value) for key, value in element.values.items()} if element else {}
    return [change.element_kind, change.element_id, values]


Flaw = Literal["foreign file", "no key", "before", "other change", "other author"]
"""Why an entry about a change excuses nothing."""


class AgreementTarget(NamedTuple):
    """What an entry has to name to excuse a loss."""

    element: str
    key: str
    hash: str


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
        change_hash = hash_change(change, self.versions)
        change = replace(change, breaks=tuple(replace(each, hash=each.hash or change_hash) for each in breaks))
        naming_entries = [entry for entry in self.after.review.accepted if names_change(entry, change)]
        flaws = [self.find_flaw(entry, change) for entry in naming_entries]
        valid_entries = [entry for entry, flaw in zip(naming_entries, flaws, strict=True) if flaw is None]
        entries = [self._choose_entry(valid_entries, change, each) for each in change.breaks]
        judged_breaks = (
            replace(each, agreement=entry.reason, agreed_hash=entry.was) if entry else each
            for each, entry in zip(change.breaks, entries, strict=True)
        )
        claims = tuple(entry for entry, flaw in zip(naming_entries, flaws, strict=True) if flaw is not None)
        return replace(change, breaks=tuple(judged_breaks), claims=claims)

    def _choose_entry(
        self, entries: Iterable[AcceptedChange], change: Change, partner_break: PartnerBreak
    ) -> AcceptedChange | None:
        """Return the last of several entries that excuses a loss, None if there is none."""
        chosen = None
        for entry in entries:
            change_hash = self._find_hash(entry, change, partner_break)
            if change_hash is not None and entry.was in {None, change_hash}:
                chosen = entry
        return chosen

    def find_flaw(self, entry: AcceptedChange, change: Change) -> Flaw | None:
        """Return why an entry about a change excuses nothing, None where it does."""
        own_breaks = [
            each for each in change.breaks if find_partner_id(each.partner, self.matched_ids) == entry.partner
        ]
        if not own_breaks:
            return "foreign file"
        if entry.key is None:
            return "no key"
        # What two entries say may be the same in the files of two partners.
        if any((entry.partner, entry) == (old.partner, old) for old in self.before.review.accepted):
            return "before"
        hashes = {self._find_hash(entry, change, each) for each in own_breaks}
        is_meant = self._was_so_when_written(entry, change) if entry.was is None else entry.was in hashes
        if not is_meant:
            return "other change"
        is_own = self.facts.may_agree(entry.at.file, entry.partner or "", self.before.partners)
        return None if is_own else "other author"

    def _find_hash(self, entry: AcceptedChange, change: Change, partner_break: PartnerBreak) -> str | None:
        """Return the hash with which an entry excuses a loss of its partner, None where it speaks of another one."""
        if find_partner_id(partner_break.partner, self.matched_ids) != entry.partner:
            return None
        if _names_element(entry, change):
            return hash_change(change, self.versions)
        return partner_break.hash if partner_break.fallen == (entry.element, entry.key) else None

    def _was_so_when_written(self, entry: AcceptedChange, change: Change) -> bool:
        """Whether a change was the same when an entry without a hash was written, as far as anybody knows."""
        agreed_hashes = self.facts.agreed_hashes(entry.at.file)
        key = change.element_id, agreement_key(change)
        return agreed_hashes is None or agreed_hashes.get(key) == hash_change(change, self.versions)


def find_partner_id(partner: str, matched_ids: MatchedIds) -> str:
    """Return the id that names a partner's file: that of the first version, which the branch cannot choose."""
    return matched_ids.old_ids.get("partner", {}).get(partner, partner)


def names_change(entry: AcceptedChange, change: Change) -> bool:
    """Whether an entry speaks of a change: its element, and its key if it names one; or of what is not kept by it."""
    return _names_element(entry, change) or any(each.fallen == (entry.element, entry.key) for each in change.breaks)


def list_agreement_targets(change: Change, breaks: Iterable[PartnerBreak]) -> Iterator[AgreementTarget]:
    """Yield what entries have to name to excuse losses by a change."""
    for each in breaks:
        yield AgreementTarget(*(each.fallen or (change.element_id, agreement_key(change))), each.hash)


def _names_element(entry: AcceptedChange, change: Change) -> bool:
    return entry.element == change.element_id and entry.key in {None, agreement_key(change)}
