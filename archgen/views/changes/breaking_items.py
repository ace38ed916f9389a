"""The edits that break partners, as a document shows them: who loses what, who agreed, and as which findings they are found."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.change_sentences import READERS_LEAD
from archgen.compare.edits import Edit
from archgen.compare.sentence_words import tick_names
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.frozen import dataclass, replace
from archgen.model.review_settings import BREAK_CATEGORIES, BreakCategory
from archgen.views.changes import breaking_verdict
from archgen.views.changes.owned_edits import name_owner
from archgen.views.changes.partner_names import name_each

_BACKTICKED = re.compile(r"`([^`]*)`")
_MAX_NAMES = 3
_MAX_PLACES = 4
_MAX_LOSSES = 4
"""How many places of one rule, and how many losses of each category by what is not read any more, are written out."""


@dataclass(frozen=True, slots=True)
class SharedLoss:
    """What some partners lose by a change, in the words and the category of `PartnerBreak`."""

    reason: str
    category: BreakCategory
    partners: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BreakingChange:
    """An edit that breaks partners: what which of them lose; then what entries of `review.accepted` say about it, and as
    which findings it is found.
    """

    change: Edit
    partners: tuple[str, ...]
    losses: tuple[SharedLoss, ...]
    agreements: tuple[str, ...]

    @property
    def short_text(self) -> str:
        """Return what changed, without who reads it: the losses say that."""
        text, _, readers = self.change.text.partition(f"; {READERS_LEAD} ")
        return text if not readers or self.losses else self.change.text

    @property
    def categories(self) -> str:
        """Return the categories of what is lost: `wire, promise`."""
        return ", ".join(self.change.break_categories)


def describe_breaking_edit(
    edit: Edit,
    comparison: Comparison,
    partner_names: Mapping[str, str],
    repeated_findings: Mapping[Diagnostic, Change],
) -> BreakingChange:
    """Describe an edit that breaks partners. `repeated_findings` say the same as a break does."""
    return BreakingChange(
        name_owner(edit, comparison, partner_names),
        name_each(edit.broken_partners, partner_names),
        tuple(_share_losses(edit, partner_names)),
        tuple(dict.fromkeys((*_describe_agreements(edit, comparison), *_name_findings(edit, repeated_findings)))),
    )


def is_shown_as_break(edit: Edit, comparison: Comparison) -> bool:
    """Whether an edit stands among the breaking ones. Other ids alone do not, unless they matter or are asked for: they
    break nobody's program.
    """
    return any(is_break_shown(category, comparison) for category in edit.break_categories)


def is_break_shown(category: BreakCategory, comparison: Comparison) -> bool:
    """Whether losses of a category are shown as breaks."""
    return category != "source" or comparison.only_breaking or comparison.policy.source > Severity.NOTE


def note_source(edit: Edit, partner_names: Mapping[str, str]) -> Edit:
    """Return an edit with a note on the partners for whom only ids change."""
    if not edit.breaks:
        return edit
    return replace(
        edit,
        text=f"{edit.text}; for {join_words(name_each(edit.broken_partners, partner_names))} only ids change (source)",
    )


def _share_losses(edit: Edit, partner_names: Mapping[str, str]) -> Iterator[SharedLoss]:
    """Yield each loss once, with the partners who have it."""
    partners: dict[tuple[str, BreakCategory], set[str]] = {}
    for partner_break in edit.breaks:
        partners.setdefault((partner_break.reason, partner_break.category), set()).add(partner_break.partner)
    shared = [
        SharedLoss(reason, category, name_each(sorted(names), partner_names))
        for (reason, category), names in partners.items()
    ]
    # With a file that is not read any more goes all that it held, with a type all its instances change: one cause, and
    # not one more reason for each element.
    is_many = edit.element_kind in {"project", "component_type"}
    yield from _limit_losses(list(_join_instances(edit, shared))) if is_many else shared


def _join_instances(edit: Edit, losses: Sequence[SharedLoss]) -> Iterator[SharedLoss]:
    """Yield losses that are the same of each instance once, with the names of what is lost."""
    elements = tuple(f"{change.element_id}." for change in edit.changes if change.element_kind != "component_type")
    names_by_loss: dict[SharedLoss, list[str]] = {}
    for loss in losses:
        named = (name for name in _BACKTICKED.findall(loss.reason) if f"{name}.".startswith(elements))
        name = next(named, "")
        # A placeholder that nobody can write in a name.
        joint = replace(loss, reason=loss.reason.replace(f"`{name}`", "\0", 1)) if name else loss
        names_by_loss.setdefault(joint, []).append(name)
    for loss, names in names_by_loss.items():
        yield replace(loss, reason=loss.reason.replace("\0", tick_names(names, _MAX_NAMES)))


def _limit_losses(losses: Sequence[SharedLoss]) -> Iterator[SharedLoss]:
    """Yield the first losses of each category, with the number of those left out behind the last one."""
    for category in BREAK_CATEGORIES:
        members = [loss for loss in losses if loss.category == category]
        surplus = members[_MAX_LOSSES:] if len(members) > _MAX_LOSSES + 1 else []
        yield from members[: len(members) - len(surplus)]
        if surplus:
            partners = tuple(sorted({partner for loss in surplus for partner in loss.partners}))
            yield SharedLoss(f"{len(surplus)} more such losses", category, partners)


def _describe_agreements(edit: Edit, comparison: Comparison) -> Iterator[str]:
    for change in edit.changes:
        if change.breaks:
            yield from breaking_verdict.describe_agreements(change, comparison)


def _name_findings(edit: Edit, repeated_findings: Mapping[Diagnostic, Change]) -> Iterator[str]:
    """Yield as which findings an edit is found, and where."""
    places: dict[str, list[str]] = {}
    for finding, change in repeated_findings.items():
        if change in edit.changes:
            places.setdefault(finding.rule, []).append(f"`{finding.span}`")
    for rule, spans in places.items():
        surplus = [f"{len(spans) - _MAX_PLACES} more places"] if len(spans) > _MAX_PLACES + 1 else []
        yield f"found as `{rule}` at {join_words([*spans[: _MAX_PLACES if surplus else None], *surplus])}"
