"""Hold an agreement against what was signed: which interfaces and terms are others now.

New titles and ids alone bind nobody to anything else, and are left out: the document still shows them. Nor does anybody
depart from what is only expected; that is listed by itself.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.partner_interfaces import find_interfaces_between
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.interface_record import InterfaceKey
from archgen.views.agreement.output_promises import list_launch_words
from archgen.views.agreement.plain_terms import CONTRADICTION_KIND
from archgen.views.agreement.term_changes import AgreementChanges, TermChange


def write_verdict(changes: AgreementChanges) -> Iterator[str]:
    """Yield lines: whether all is as it was signed, what is not, and what is only expected otherwise."""
    departures, expected_changes = list(list_departures(changes)), list(list_expected_changes(changes))
    yield f"not as signed at {changes.earlier_revision}:" if departures else f"as signed at {changes.earlier_revision}"
    yield from (f"  {line}" for line in departures)
    if expected_changes:
        yield "expected otherwise now, promised by nobody:"
        yield from (f"  {line}" for line in expected_changes)


def list_launch_notes(content: AgreementContent) -> Iterator[str]:
    """Yield what the launch made of what was signed by rules that did not see it."""
    if content.signatures.rules > 1 or content.earlier_lookup is None:
        return
    words = (
        f"{sentence}{f' ({place})' if place.file else ''}"
        for interface in find_interfaces_between(content.earlier_lookup.architecture, *content.pair)
        for sentence, place in list_launch_words(interface)
    )
    for each in dict.fromkeys(words):
        yield f"as signed by the words; since then it is known that {each}, in the signed version too"


def has_departures(changes: AgreementChanges) -> bool:
    """Whether an interface or a binding term is not as it was signed."""
    return any(list_departures(changes))


def group_departures(changes: AgreementChanges) -> dict[InterfaceKey, tuple[str, ...]]:
    """Return what is not as it was signed, by interface: what is gone or promises less first."""
    departures: dict[InterfaceKey, tuple[str, ...]] = {
        record.key: ("was signed, and is gone",) for record in changes.removed_records
    }
    terms_by_key = {key: _list_binding_terms(changes, key) for key in changes.changes_by_key}
    changed_keys = sorted(key for key, terms in terms_by_key.items() if terms)
    for key in sorted(changed_keys, key=lambda key: not any(term.is_weaker for term in terms_by_key[key])):
        terms = sorted(terms_by_key[key], key=lambda term: not term.is_weaker)
        departures[key] = tuple(f"{'weaker: ' if term.is_weaker else ''}{_describe_term(term)}" for term in terms)
    return departures | dict.fromkeys(sorted(changes.added_keys), ("was not signed",))


def list_departures(changes: AgreementChanges) -> Iterator[str]:
    """Yield lines on each interface that is not as it was signed."""
    for key, lines in group_departures(changes).items():
        if key in changes.changes_by_key:
            yield f"`{key[0]}` ({_describe_versions(changes, key)})"
            yield from (f"  {line}" for line in lines)
        else:
            yield f"`{key[0]}` {lines[0]}"
    yield from (f"terms: {title} is not as it was signed" for title in changes.changed_words)


def list_expected_changes(changes: AgreementChanges) -> Iterator[str]:
    """Yield a line for each figure that is expected otherwise now, and that nobody promises."""
    for key in sorted(changes.changes_by_key):
        for term in changes.changes_by_key[key].terms:
            if term.is_expected:
                yield f"`{key[0]}`: {_describe_term(term)}"


def _list_binding_terms(changes: AgreementChanges, key: InterfaceKey) -> list[TermChange]:
    return [
        term
        for term in changes.terms_of(key)
        if term.kind not in {"renamed", "moved"}
        and term.term_kind != "title"
        and not term.is_expected
        # One that is gone is nobody's loss.
        and not (term.term_kind == CONTRADICTION_KIND and term.kind == "removed")
    ]


def _describe_versions(changes: AgreementChanges, key: InterfaceKey) -> str:
    signed_version, version = changes.earlier_versions[key], changes.later_versions[key]
    if signed_version == version:
        return f"version {version}, as signed"
    return f"version {version}, {signed_version} was signed"


def _describe_term(term: TermChange) -> str:
    if term.before is None:
        return f"{term.name} was not signed: {term.after}" if term.after else f"{term.name} was not signed"
    if term.after is None:
        return f"{term.name} was signed, and is gone: {term.before}"
    return f"{term.name} was signed as {term.before or 'nothing'}, and is {term.after or 'nothing'}"
