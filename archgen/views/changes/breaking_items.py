"""The edits that break partners, as a document shows them: who loses what, who agreed, and as which findings they are reported.

Beside them: edits of what belongs to another partner, and new findings that say the same as one of both.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.change_sentences import READERS_LEAD
from archgen.compare.edits import Edit, find_affected_names, find_left_out
from archgen.compare.key_phrases import shorten_text, tick_names
from archgen.diagnostics import Diagnostic, Severity, fit_lines, join_words
from archgen.frozen import dataclass, replace
from archgen.model.project_settings import BREAK_CATEGORIES, BreakCategory
from archgen.views.changes import breaking_verdict
from archgen.views.changes.named_elements import name_each

_BACKTICKED = re.compile(r"`([^`]*)`")
_PAIR_RULES = frozenset({"incompatible-qos", "two-domains", "two-clocks"})
"""Those whose findings name two ends in front of a colon."""
_RULES = _PAIR_RULES | {"remapped-away", "unfed-input", "late-chain", "overloaded-host", "saturated-link"}
"""The rules whose findings have a break that says the same. Others say more than that somebody loses something."""

_UNREAD_RULES = frozenset({"missing-detail", "unchecked-message", "unmapped-component"})
"""The rules that find what is missing of an element: they say nothing new of one that is not read any more."""


def find_repeated_findings(comparison: Comparison) -> Mapping[Diagnostic, Change]:
    """Return the new findings that a change tells, each with the change."""
    breaking_changes = [change for change in comparison.changes if change.breaks]
    # Later ones come first, and what breaks somebody counts more than what is only not read any more.
    return dict(_find_unread_subjects(comparison)) | {
        finding: change
        for finding in comparison.new_findings
        if finding.rule in _RULES
        for change in breaking_changes[::-1]
        if _tells_finding(change, finding)
    }


def _find_unread_subjects(comparison: Comparison) -> Iterator[tuple[Diagnostic, Change]]:
    """Yield the findings about what a file held that is not read any more, with a change of the edit that says so."""
    for left_out in find_left_out(comparison, comparison.changes):
        # Only a breaking change is shown with findings.
        if not any(change.breaks for change in left_out.removals):
            continue
        names = find_affected_names(comparison, left_out.removals)
        for finding in comparison.new_findings:
            subjects = _BACKTICKED.findall(finding.message)[:1]
            if finding.rule in _UNREAD_RULES and names.issuperset(subjects):
                yield finding, left_out.removals[0]


def _tells_finding(change: Change, finding: Diagnostic) -> bool:
    """Whether one of the losses of a change names all that the finding names."""
    needed_names = set(_name_subjects(finding))
    for each in change.breaks:
        names = {*_BACKTICKED.findall(each.reason), *change.element_id.split("."), change.element_id}
        if needed_names and needed_names <= names:
            return True
    return False


def _name_subjects(finding: Diagnostic) -> Iterator[str]:
    """Yield what a finding is about: the names in front of its explanation, ports with their complete ids."""
    names = _BACKTICKED.findall(finding.message.partition(": ")[0])
    if finding.rule in _PAIR_RULES:
        yield from names
    elif finding.rule == "remapped-away":
        yield from names[:2]
    elif finding.rule == "unfed-input" and len(names) > 1:
        yield f"{names[1]}.{names[0]}"
    elif finding.rule == "late-chain" and finding.element:
        yield finding.element
    elif finding.rule in {"overloaded-host", "saturated-link"}:
        # Of what follows behind the name, as the largest part of the traffic, breaks say nothing.
        yield from names[:1]


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


def note_source(edit: Edit, partner_names: Mapping[str, str], broken_partners: Collection[str]) -> Edit:
    """Return an edit with a note on the partners for whom only ids change; of those whom another edit breaks this is not
    true.
    """
    partners = name_each((each for each in edit.broken_partners if each not in broken_partners), partner_names)
    return replace(edit, text=f"{edit.text}; for {join_words(partners)} only ids change (source)") if partners else edit


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
    places: dict[str, dict[str, None]] = {}
    for finding, change in repeated_findings.items():
        if change in edit.changes:
            places.setdefault(finding.rule, {})[f"`{finding.span}`"] = None
    for rule, spans in places.items():
        yield f"found as `{rule}` at {join_words(fit_lines([*spans], _MAX_PLACES + 1, '{} more places'))}"


_TITLE = re.compile(r" \([^()`]*\)")
"""What stands behind an id whose element has another title."""
_LIST_OF_NAMES = re.compile(r",? (?:and )?`")


def name_owner(edit: Edit, comparison: Comparison, partner_names: Mapping[str, str], known_owner: str = "") -> Edit:
    """Return an edit that says whose element it changes, unless that is known from its heading, or there is only one
    partner.
    """
    if edit.element_kind == "component_type" and all(each.element_kind != "component_type" for each in edit.changes):
        return edit  # of a selection only what follows the type: whose that is, the sentence says itself
    owners = [_find_owner(change, comparison) for change in edit.changes]
    owner = owners[0] if len(set(owners)) == 1 else None
    if not owner or len(partner_names) < 2 or owner == known_owner:  # noqa: PLR2004 - with one partner nothing is foreign
        return edit
    names = dict.fromkeys([edit.element_id, *(change.old_id for change in edit.changes if change.old_id)])
    places = [(edit.text.find(ticked), len(ticked)) for ticked in (f"`{shorten_text(name)}`" for name in names)]
    start, length = min(((place, size) for place, size in places if place >= 0), default=(0, 0))
    title = _TITLE.match(edit.text, start + length)
    end = title.end() if title else start + length
    head, tail = edit.text[:end], edit.text[end:]
    if not length or _LIST_OF_NAMES.match(tail):
        return edit
    return replace(edit, text=f"{head} of {name_each([owner], partner_names)[0]}{tail}")


def find_group_owner(group_id: str, comparison: Comparison) -> str:
    """Return who owned a group before the change, or owns it if it is new; empty for nobody."""
    is_there = ("group", group_id) in comparison.versions.elements_after
    common_id = group_id if is_there else comparison.matched_ids.common_id("group", group_id)
    return comparison.versions.find_owner("group", common_id) or ""


def _find_owner(change: Change, comparison: Comparison) -> str | None:
    """Return who owned an element before the change, or owns it if it is new; None where the sentence says it anyway."""
    if change.element_kind == "partner" or change.key == "owner":
        return None
    kind = "input" if change.element_kind == "connection" else change.element_kind
    is_gone = change.kind == "removed"
    common_id = comparison.matched_ids.common_id(kind, change.element_id) if is_gone else change.element_id
    return comparison.versions.find_owner(kind, common_id)
