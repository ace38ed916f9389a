"""The verdict on breaking changes: how many, what the project's policy says, which accepted entries are idle."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.agreements import agreement_key, find_partner_id
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.sentence_words import tick_names
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.review_settings import AcceptedChange, agreement_file
from archgen.views.inline_text import count_noun

_MAX_FILES = 4
_PLAIN_TEXT = re.compile(r"[A-Za-z_](?:[\w ./-]*[\w])?", re.ASCII)
"""A text that YAML reads as itself; the words that it reads as something else are no ids."""


def describe_verdict(comparison: Comparison) -> Iterator[str]:
    """Yield how many changes break whom and what the policy says, then the accepted entries that are idle."""
    obstacle = describe_obstacle(comparison)
    policy = _describe_policy(comparison)
    if obstacle and comparison.breaking_severity is not Severity.OFF:
        certain_note = (
            f"; certain: {policy.removeprefix(f'{comparison.breaking_severity}: ')}"
            if any(change.breaks for change in comparison.changes)
            else ""
        )
        yield f"{comparison.breaking_severity}: {obstacle}{certain_note}"
    else:
        yield policy
    for entry in comparison.idle_acceptances:
        yield _describe_idle(comparison, entry)


def describe_obstacle(comparison: Comparison) -> str:
    """Describe what keeps a comparison from being judged, empty if nothing does."""
    old_files, new_files = comparison.before.unread_files, comparison.after.unread_files
    notes = [f"{tick_names(new_files, _MAX_FILES)} cannot be read"] if new_files else []
    notes += [f"{tick_names(old_files, _MAX_FILES)} could not be read before"] if old_files else []
    return f"cannot be judged: {join_words(notes)}" if notes else ""


def describe_refusal(changes: Sequence[Change], matched_ids: MatchedIds, *, is_refused: bool) -> str:
    """Describe what to do about the first change that the policy refuses; empty if it refuses none."""
    refused_change = next((item for item in changes if item.unheard_partners), None)
    if not is_refused or refused_change is None:
        return ""
    partners = [find_partner_id(partner, matched_ids) for partner in refused_change.unheard_partners]
    files = join_words([f"`{agreement_file(partner)}`" for partner in partners])
    say = "says" if len(partners) == 1 else "each say"
    return f"mend it, or {join_words(partners)} {say} why it is right, in {files}: {_write_entry(refused_change, 'THE REASON')}"


def describe_agreements(change: Change, comparison: Comparison) -> Iterator[str]:
    """Yield which partners agreed on a breaking change and why, then the entries about it that excuse nothing."""
    agreements = {each.partner: each.agreement for each in change.breaks if each.agreement is not None}
    for partner, reason in sorted(agreements.items()):
        yield f"accepted by {partner}: {reason}"
    for entry in change.claims:
        yield _describe_claim(entry, change, comparison)


def _describe_claim(entry: AcceptedChange, change: Change, comparison: Comparison) -> str:
    """Describe an entry that excuses nothing: why not, and what to write where."""
    partners = [find_partner_id(partner, comparison.matched_ids) for partner in change.broken_partners]
    place = f"`{entry.at.file}`" if entry.at.file else "the project"
    if entry.partner not in partners:
        return f"said in {place}, not by {join_words(partners)}: {entry.reason}"
    if entry.key is None:
        needed_entry = _write_entry(change, entry.reason)
        return f"said in {place} without a `key`, which would accept whatever changes: write {needed_entry}"
    return f"said in {place} before this change, of another one: {entry.reason}"


def _write_entry(change: Change, reason: str) -> str:
    """Return the entry that accepts a change, as it has to stand in a file."""
    body = f"{{key: {_quote_text(agreement_key(change))}, reason: {_quote_text(reason)}}}"
    return f"`review: {{accepted: {{{_quote_text(change.element_id)}: {body}}}}}`"


def _quote_text(text: str) -> str:
    """Return a text as it may stand in a mapping in one line: JSON's strings are YAML's."""
    return text if _PLAIN_TEXT.fullmatch(text) else json.dumps(text, ensure_ascii=False)


def _describe_policy(comparison: Comparison) -> str:
    if comparison.breaking_severity is Severity.OFF:
        return "`review.breaking` is off: this project does not ask what breaks another partner"
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return "no change breaks another partner"
    partners = sorted({partner for change in breaking_changes for partner in change.broken_partners})
    count_phrase = f"{count_noun(len(breaking_changes), 'breaking change')} for {', '.join(partners)}"
    accepted_count = sum(change.acceptance_reason is not None for change in breaking_changes)
    if accepted_count == len(breaking_changes):
        return f"{count_phrase}, accepted"
    accepted_note = f", {accepted_count} of them accepted" if accepted_count else ""
    if comparison.is_refused:
        return f"error: {count_phrase}{accepted_note}; `review.breaking: error` refuses what is not accepted"
    return f"{comparison.breaking_severity}: {count_phrase}{accepted_note}"


def _describe_idle(comparison: Comparison, entry: AcceptedChange) -> str:
    place_note = f" ({entry.at})" if entry.at.file else ""
    key_note = f" with the key `{entry.key}`" if entry.key else ""
    sentence = f"note: accepted entry `{entry.element}`{key_note}{place_note} names no breaking change here"
    # Ids of both versions: an entry may name an element that was removed.
    known_ids = {
        element.own_id
        for elements in (comparison.versions.elements_before, comparison.versions.elements_after)
        for element in elements.values()
    }
    if entry.element in known_ids:
        return sentence
    guess = did_you_mean(entry.element, known_ids)
    return f"{sentence}, and nothing in either version has this id" + (f"; {guess}" if guess else "")
