"""The verdict on breaking changes: how many, what the project's policy says, which accepted entries are idle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare import Change, Comparison
from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.review_settings import AcceptedChange
from archgen.views.inline_text import count_noun


def describe_verdict(comparison: Comparison) -> Iterator[str]:
    """Yield how many changes break whom and what the policy says, then the accepted entries that are idle."""
    yield _describe_policy(comparison)
    for entry in comparison.idle_acceptances:
        yield _describe_idle(comparison, entry)


def describe_refusal(changes: Sequence[Change], *, is_refused: bool) -> str:
    """Describe what to do about the first change that the policy refuses; empty if it refuses none."""
    refused_change = next((item for item in changes if item.breaks and item.acceptance_reason is None), None)
    if not is_refused or refused_change is None:
        return ""
    return f"mend it, or agree on it and say why: `review: {{accepted: {{{refused_change.element_id}: THE REASON}}}}`"


def describe_acceptance(change: Change, comparison: Comparison) -> str:
    """Describe why a breaking change is accepted, and whether the entry is older; empty if it is not."""
    if change.acceptance_reason is None:
        return ""
    old_entry = comparison.before.architecture.review.accepted.get(change.element_id)
    # Old entries count, since many teams agree first; whoever reviews should see that this one was not written for the
    # change (docs/decisions/0007-breaking-changes.md).
    entry_note = (
        " (by an entry that was there before)" if old_entry and old_entry.reason == change.acceptance_reason else ""
    )
    return f"accepted{entry_note}: {change.acceptance_reason}"


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
