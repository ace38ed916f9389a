"""The wording of a comparison that all formats share: signs, headings, what is only text, figures of chains."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from archgen.compare import ChainChange, Change, Comparison
from archgen.compare.kinds import ELEMENT_KINDS, Effect, find_effect
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.value_arithmetic import is_boundless
from archgen.views.inline_text import count_noun
from archgen.views.shapes import Inlines, Text

CHANGE_SIGNS = {"added": "+", "removed": "\u2212", "changed": "~", "renamed": "→", "moved": "→"}
"""A sign for each kind of change, so that nothing depends on colour."""
_CHANGE_MARKS: dict[str, Literal["added", "removed", "changed"]] = {"added": "added", "removed": "removed"}


@dataclass(frozen=True, slots=True)
class ChangeGroup:
    """The changes below one heading. `group_id` is empty for changes outside of all groups."""

    group_id: str
    title: str
    changes: tuple[Change, ...]

    @property
    def heading(self) -> str:
        """Return the heading as one line of text."""
        return f"{self.group_id}: {self.title}" if self.group_id and self.title else self.title or self.group_id


def group_changes(changes: Iterable[Change], comparison: Comparison) -> Iterator[ChangeGroup]:
    """Group changes by the group of their element, then those outside of all groups by kind."""
    groups = {**comparison.before.architecture.groups, **comparison.after.architecture.groups}
    changes_by_heading: dict[tuple[bool, str], list[Change]] = {}
    for change in changes:
        # Kinds without a heading are those inside of groups: their ids begin with the group's.
        heading_name = ELEMENT_KINDS[change.element_kind].heading
        changes_by_heading.setdefault(
            (heading_name is not None, heading_name or change.element_id.partition(".")[0]), []
        ).append(change)
    for is_ungrouped, heading_name in sorted(key for key in changes_by_heading if not key[0]):
        yield ChangeGroup(
            heading_name,
            groups[heading_name].title if heading_name in groups else "",
            tuple(changes_by_heading[is_ungrouped, heading_name]),
        )
    for heading_name in dict.fromkeys(kind.heading for kind in ELEMENT_KINDS.values() if kind.heading):
        if (True, heading_name) in changes_by_heading:
            yield ChangeGroup("", heading_name, tuple(changes_by_heading[True, heading_name]))


def is_textual(change: Change) -> bool:
    """Whether a change only concerns texts, pictures and addresses: nothing of the system itself."""
    return find_effect(change.element_kind, change.key) is Effect.TEXT


def summarize_comparison(comparison: Comparison) -> str:
    """Count what changed, and name whom it concerns and breaks: `3 changes (1 added, 2 removed); concerns certh`."""
    concern_note = f"; concerns {', '.join(comparison.concerned_owners)}" if comparison.concerned_owners else ""
    broken_ids = broken_partners(comparison.changes)
    return count_differences(comparison) + concern_note + (f"; breaks {', '.join(broken_ids)}" if broken_ids else "")


def count_differences(comparison: Comparison) -> str:
    """Count changes and findings: `3 changes (1 added, 2 removed), 1 new finding`."""
    counts = count_by_kind(comparison.changes)
    count_phrases = [count_noun(len(comparison.changes), "change") + (f" ({counts})" if counts else "")]
    count_phrases += [count_noun(len(comparison.new_findings), "new finding")] if comparison.new_findings else []
    count_phrases += [count_noun(len(comparison.cured_findings), "cured finding")] if comparison.cured_findings else []
    count_phrases += (
        [count_noun(len(comparison.silenced_findings), "silenced finding")] if comparison.silenced_findings else []
    )
    return ", ".join(count_phrases)


def count_by_kind(changes: Iterable[Change]) -> str:
    """Count changes by kind: `1 added, 2 removed`."""
    kinds = Counter(str(change.kind) for change in changes)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in CHANGE_SIGNS if kinds[kind])


def broken_partners(changes: Iterable[Change]) -> tuple[str, ...]:
    """Return the partners for whom something breaks, sorted."""
    return tuple(sorted({partner for change in changes for partner in change.broken_partners}))


REFUSAL_HELP = "`review.breaking: error` refuses this: mend it, or agree on it and write the reason below `review: accepted:` at the element."
"""What to do about changes that the project's policy refuses."""


def partners_by_reason(change: Change) -> dict[str, list[str]]:
    """Return each reason why a change breaks somebody, with the partners it breaks."""
    partners: dict[str, list[str]] = {}
    for partner_break in change.breaks:
        partners.setdefault(partner_break.reason, []).append(partner_break.partner)
    return partners


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


def text_runs(text: str) -> Inlines:
    """Split a sentence into runs, with what is in backticks as code; a backtick without a second one is a backtick."""
    # Splitting with one capturing group alternates: odd pieces were in backticks.
    pieces = re.split(r"`([^`]*)`", text)
    return tuple(Text(piece, code=index % 2 == 1) for index, piece in enumerate(pieces) if piece)


def sign_text(change: Change) -> Text:
    """Return the sign of a change as a run."""
    return Text(CHANGE_SIGNS[change.kind], strong=True, change=_CHANGE_MARKS.get(change.kind, "changed"))


def format_bound(result: ChainResult | None) -> str:
    """Format how long a chain takes at most."""
    if result is None:
        return "not there"
    if is_boundless(result.bound):
        return "no bound"
    if result.bound.value is None:
        return "unknown"
    return ("" if result.bound.complete else "at least ") + format_duration(result.bound.value)


def format_growth(chain_change: ChainChange) -> str:
    """Format by how much a bound grew or shrank; empty if that is unknown or nothing."""
    # The difference to an "at least" is no difference.
    old_bound, new_bound = (
        chain_result.bound.value if chain_result and chain_result.bound.complete else None
        for chain_result in (chain_change.before, chain_change.after)
    )
    if old_bound is None or new_bound is None or old_bound == new_bound:
        return ""
    return f"{'+' if new_bound > old_bound else '-'}{format_duration(abs(new_bound - old_bound))}"


def format_deadline(chain_change: ChainChange) -> str:
    """Format the deadline of the second version; if it changed, with the old one."""
    old_deadline, new_deadline = (
        _format_result_deadline(chain_result) for chain_result in (chain_change.before, chain_change.after)
    )
    if chain_change.before and chain_change.after and old_deadline != new_deadline:
        return f"{old_deadline or 'none'} → {new_deadline or 'none'}"
    return new_deadline or old_deadline


def _format_result_deadline(result: ChainResult | None) -> str:
    return format_duration(result.deadline.value) if result and result.deadline and result.deadline.value else ""


def format_verdict(chain_change: ChainChange) -> str:
    """Format whether the deadline is met, and whether it was before if that differs."""
    old_verdict, new_verdict = (
        chain_result.verdict if chain_result and chain_result.deadline and chain_result.deadline.value else ""
        for chain_result in (chain_change.before, chain_change.after)
    )
    if not new_verdict:
        return ""
    return f"{new_verdict} (was {old_verdict})" if old_verdict and old_verdict != new_verdict else new_verdict
