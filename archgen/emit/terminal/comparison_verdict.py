"""The verdict on breaking changes: how many, what the project's policy says, which accepted entries are idle."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare import Comparison
from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.safe_text import make_visible
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.review_settings import AcceptedChange


def verdict_lines(comparison: Comparison) -> Iterator[str]:
    """Yield the verdict as plain text, one sentence a line."""
    yield make_visible(describe_verdict(comparison))
    yield from map(make_visible, _describe_cure(comparison))
    for entry in comparison.idle_acceptances:
        yield make_visible(_describe_idle(comparison, entry))


def describe_verdict(comparison: Comparison) -> str:
    """Describe how many changes break whom, and whether the project refuses them."""
    if comparison.breaking_severity is Severity.OFF:
        return "`review.breaking` is off: this project does not ask what breaks another partner"
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return "no change breaks another partner"
    partners = sorted({partner for change in breaking_changes for partner in change.broken_partners})
    count_phrase = (
        f"{len(breaking_changes)} breaking change{'' if len(breaking_changes) == 1 else 's'} for {', '.join(partners)}"
    )
    accepted_count = sum(change.acceptance_reason is not None for change in breaking_changes)
    if accepted_count == len(breaking_changes):
        return f"{count_phrase}, accepted"
    accepted_note = f", {accepted_count} of them accepted" if accepted_count else ""
    if comparison.is_refused:
        return f"error: {count_phrase}{accepted_note}; `review.breaking: error` refuses what is not accepted"
    return f"{comparison.breaking_severity}: {count_phrase}{accepted_note}"


def _describe_cure(comparison: Comparison) -> Iterator[str]:
    """Describe what to write to accept the first change that is refused."""
    refused_changes = [change for change in comparison.changes if change.breaks and change.acceptance_reason is None]
    if comparison.is_refused and refused_changes:
        element_id = refused_changes[0].element_id
        yield f"  = help: mend it, or agree on it and say why: `review: {{accepted: {{{element_id}: THE REASON}}}}`"


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
