"""The verdict on breaking changes: how many, what the project's policy says, which accepted entries are idle."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.agreements import (
    AgreementJudge,
    AgreementTarget,
    agreement_key,
    find_partner_id,
    list_agreement_targets,
)
from archgen.compare.key_phrases import tick_names
from archgen.diagnostics import Severity, did_you_mean, join_words, order_naturally
from archgen.frozen import NamedTuple
from archgen.model.project_settings import (
    BREAK_CATEGORIES,
    AcceptedChange,
    BreakCategory,
    BreakPolicy,
    agreement_file,
)
from archgen.views.changes.named_elements import name_each, name_partners
from archgen.views.inline_text import count_noun

_MAX_FILES = 4
_ALL_CLEAR = "no change breaks another partner"
_PLAIN_TEXT = re.compile(r"[A-Za-z_](?:[\w ./-]*[\w])?", re.ASCII)
"""A text that YAML reads as itself; the words that it reads as something else are no ids."""


def describe_verdict(comparison: Comparison) -> Iterator[str]:
    """Yield how many changes break whom and what the policy says, then the accepted entries that are idle."""
    obstacle = describe_obstacle(comparison)
    verdict = _judge_changes(comparison)
    if obstacle and comparison.policy.gravest is not Severity.OFF:
        certain_note = f"; certain: {verdict.sentence}" if any(change.breaks for change in comparison.changes) else ""
        yield f"{comparison.policy.gravest}: {obstacle}{certain_note}"
    else:
        yield f"{verdict.severity}: {verdict.sentence}" if verdict.severity else verdict.sentence
    for entry in comparison.idle_acceptances:
        yield _describe_idle(comparison, entry)


def describe_all_clear(comparison: Comparison) -> str:
    """Return that no change breaks another partner; empty where one does, nobody can tell, or there is nobody else."""
    is_asked = comparison.is_judged and comparison.policy.gravest is not Severity.OFF
    if not comparison.changes or not is_asked or len(name_partners(comparison)) < 2:  # noqa: PLR2004
        return ""
    return _ALL_CLEAR if not any(change.breaks for change in comparison.changes) else ""


def describe_obstacle(comparison: Comparison) -> str:
    """Describe what keeps a comparison from being judged, empty if nothing does."""
    old_files, new_files = comparison.before.unread_files, comparison.after.unread_files
    notes = [f"{tick_names(new_files, _MAX_FILES)} cannot be read"] if new_files else []
    notes += [f"{tick_names(old_files, _MAX_FILES)} could not be read before"] if old_files else []
    return f"cannot be judged: {join_words(notes)}" if notes else ""


def describe_refusal(comparison: Comparison) -> str:
    """Describe who may accept what the policy refuses, in front of `write_missing_entries`; empty if nothing is refused,
    or nobody can judge that.
    """
    partners = sorted(_find_refused_targets(comparison), key=order_naturally)
    return f"mend it, or {_say_why(partners, comparison)}:" if partners else ""


def write_missing_entries(comparison: Comparison) -> tuple[str, ...]:
    """Return what partners write to accept all that is refused: YAML, with the files that it belongs into in its first
    line.
    """
    files_by_entries: dict[str, list[str]] = {}
    for partner, targets in sorted(_find_refused_targets(comparison).items()):
        file = agreement_file(find_partner_id(partner, comparison.matched_ids))
        files_by_entries.setdefault(
            "\n".join(("review:", "  accepted:", *(f"    {line}" for line in _write_lines(targets, "THE REASON")))), []
        ).append(file)
    return tuple(
        f"# {join_words(files)}{', each' if len(files) > 1 else ''}\n{entries}"
        for entries, files in files_by_entries.items()
    )


def _find_refused_targets(comparison: Comparison) -> Mapping[str, Sequence[AgreementTarget]]:
    """Return what entries have to name to accept what the policy refuses, by the partner who did not agree. What cannot be
    judged is nothing that anybody could agree on.
    """
    targets: dict[str, dict[AgreementTarget, None]] = {}
    for change in comparison.changes if comparison.is_judged else ():
        if not _is_acceptable(change):
            continue
        refused_breaks = [
            each for each in change.breaks if each.agreement is None and comparison.severity_of(each) is Severity.ERROR
        ]
        for partner in dict.fromkeys(each.partner for each in refused_breaks):
            own_breaks = [each for each in refused_breaks if each.partner == partner]
            targets.setdefault(partner, {}).update(dict.fromkeys(list_agreement_targets(change, own_breaks)))
    return {partner: list(names) for partner, names in targets.items()}


def describe_remedy(change: Change, comparison: Comparison) -> str:
    """Describe what to do about a change that breaks partners who did not agree, in one line."""
    if not comparison.is_judged:
        return "mend what cannot be read first: only what is judged can be accepted"
    if not _is_acceptable(change):
        return "mend it, or let both sign again: a signature is excused by none that accepts"
    partners = change.unheard_partners
    partner_ids = [find_partner_id(partner, comparison.matched_ids) for partner in partners]
    files = join_words([f"`{agreement_file(partner_id)}`" for partner_id in partner_ids])
    targets = list_agreement_targets(change, [each for each in change.breaks if each.agreement is None])
    return f"mend it, or {_say_why(partners, comparison)}, in {files}: {_write_flow_entries(targets, 'THE REASON')}"


def _is_acceptable(change: Change) -> bool:
    """Whether partners may accept a change: what both signed, both sign again, unless they end it."""
    return change.kind == "removed" or any(each.category != "agreement" for each in change.breaks)


def _say_why(partners: Sequence[str], comparison: Comparison) -> str:
    names = join_words(name_each(partners, name_partners(comparison)))
    return f"{names} {'says' if len(partners) == 1 else 'each say'} why it is right"


def join_categories(categories: Iterable[BreakCategory]) -> str:
    """Return categories once each, in the order of the policy: `wire, promise`."""
    present_categories = set(categories)
    return ", ".join(category for category in BREAK_CATEGORIES if category in present_categories)


def write_policy(comparison: Comparison) -> str:
    """Return the policy that refuses changes, as files write it: `review.breaking: error`, or the categories it names."""
    policy = comparison.policy
    if policy == BreakPolicy.from_severity(Severity.ERROR):
        return "`review.breaking: error`"
    refusing = [category for category in BREAK_CATEGORIES if policy.severity_of(category) is Severity.ERROR]
    return f"`review.breaking: {{{', '.join(f'{category}: error' for category in refusing)}}}`"


def describe_agreements(change: Change, comparison: Comparison) -> Iterator[str]:
    """Yield which partners agreed on a breaking change and why, then the entries about it that excuse nothing."""
    agreements = {each.partner: each for each in change.breaks if each.agreement is not None}
    partner_names = name_partners(comparison)
    for partner, agreed in sorted(agreements.items()):
        yield f"accepted by {join_words(name_each([partner], partner_names))}: {agreed.agreement}"
        if not agreed.agreed_hash:
            yield f"which says no hash, and so accepts what had changed when it was written: add `was: {agreed.hash}`"
    for entry in change.claims:
        yield _describe_claim(entry, change, comparison)
    # Where only breaking changes are shown, the verdict lists all idle entries.
    for entry in () if comparison.only_breaking else comparison.idle_acceptances:
        if entry.element == change.element_id and entry not in comparison.before.architecture.review.accepted:
            yield f"what {_describe_place(entry)} accepts is `{entry.key}`, and breaks nobody here; what breaks is `{agreement_key(change)}`"


def _describe_claim(entry: AcceptedChange, change: Change, comparison: Comparison) -> str:
    """Describe an entry that excuses nothing: why not, and what to write where."""
    partners_by_file = {find_partner_id(each, comparison.matched_ids): each for each in change.broken_partners}
    place = _describe_place(entry)
    flaw = AgreementJudge.from_comparison(comparison).find_flaw(entry, change)
    if flaw == "foreign file":
        names = join_words(name_each(change.broken_partners, name_partners(comparison)))
        return f"said in {place}, not by {names}: {entry.reason}"
    own_breaks = [each for each in change.breaks if each.partner == partners_by_file[entry.partner or ""]]
    needed_entry = _write_flow_entries(list_agreement_targets(change, own_breaks), entry.reason)
    if flaw == "no key":
        return f"said in {place} without a `key`, which would accept whatever changes: write {needed_entry}"
    if flaw == "other change":
        return f"said in {place}, which agreed to another change than this one: now it would be {needed_entry}"
    if flaw == "other author":
        names = join_words(name_each([entry.partner or ""], name_partners(comparison)))
        return f"said in {place}, not by {names}: none of its `reviewers` wrote it: {entry.reason}"
    return f"said in {place} before this change, of another one: {entry.reason}"


def _describe_place(entry: AcceptedChange) -> str:
    return f"`{entry.at.file}`" if entry.at.file else "the project"


def _write_flow_entries(targets: Iterable[AgreementTarget], reason: str) -> str:
    """Return the section that accepts something, in one line."""
    return "`review: {accepted: {" + ", ".join(_write_lines(targets, reason)) + "}}`"


def _write_lines(targets: Iterable[AgreementTarget], reason: str) -> Iterator[str]:
    bodies_by_element: dict[str, list[str]] = {}
    for target in dict.fromkeys(targets):
        body = f"{{key: {_quote_text(target.key)}, was: {_quote_text(target.hash)}, reason: {_quote_text(reason)}}}"
        bodies_by_element.setdefault(target.element, []).append(body)
    for element_id, bodies in bodies_by_element.items():
        text = ", ".join(bodies)
        yield f"{_quote_text(element_id)}: {text if len(bodies) == 1 else f'[{text}]'}"


def _quote_text(text: str) -> str:
    """Return a text as it may stand in a mapping in one line: JSON's strings are YAML's. Signs that nobody sees are
    escaped.
    """
    return text if _PLAIN_TEXT.fullmatch(text) else json.dumps(text, ensure_ascii=not text.isprintable())


class _Verdict(NamedTuple):
    """How many changes break whom; the severity is None where there is nothing to answer."""

    severity: Severity | None
    sentence: str


def _judge_changes(comparison: Comparison) -> _Verdict:
    if comparison.policy.gravest is Severity.OFF:
        return _Verdict(None, "`review.breaking` is off: this project does not ask what breaks another partner")
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return _Verdict(None, _ALL_CLEAR)
    partners = sorted({name for change in breaking_changes for name in change.broken_partners}, key=order_naturally)
    categories = join_categories(each.category for change in breaking_changes for each in change.breaks)
    names = ", ".join(name_each(partners, name_partners(comparison)))
    sentence = f"{count_noun(len(breaking_changes), 'breaking change')} for {names} ({categories})"
    accepted_count = sum(change.acceptance_reason is not None for change in breaking_changes)
    if accepted_count == len(breaking_changes):
        return _Verdict(None, f"{sentence}, accepted")
    sentence += f", {accepted_count} of them accepted" if accepted_count else ""
    severity = max(map(comparison.break_severity, breaking_changes))
    if severity is Severity.ERROR:
        sentence += f"; {write_policy(comparison)} refuses what is not accepted"
    return _Verdict(severity, sentence)


def _describe_idle(comparison: Comparison, entry: AcceptedChange) -> str:
    place_note = f" ({entry.at})" if entry.at.file else ""
    key_note = f" with the key `{entry.key}`" if entry.key else ""
    sentence = f"note: accepted entry `{entry.element}`{key_note}{place_note} names no breaking change here"
    # Ids of both versions: an entry may name an element that was removed.
    known_ids = {element.own_id for elements in comparison.versions.elements for element in elements.values()}
    if entry.element in known_ids:
        return sentence
    guess = did_you_mean(entry.element, known_ids)
    return f"{sentence}, and nothing in either version has this id" + (f"; {guess}" if guess else "")
