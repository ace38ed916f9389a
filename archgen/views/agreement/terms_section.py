"""The section on what holds for all interfaces of an agreement: terms in words, and variants."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.agreed_terms import GENERAL_TERMS, find_agreement
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.term_changes import AgreementChanges
from archgen.views.shapes import Column, Facts, Inlines, Paragraph, Section, Table, Text

_LEAD = (
    "What the two agree on in words, for all interfaces; each interface's own section has the rest. Where it says that nothing "
    "is said, neither of the two owes the other one anything in this respect."
)
_ALWAYS = "The project has no variants: what stands here holds always."
_OTHERS = "What holds in others, documents of their own say."


def write_terms_section(content: AgreementContent) -> Section:
    """Write the terms, each with what is not said; and what differs in which variant."""
    terms = find_agreement(content.lookup.architecture.agreements, *content.pair).terms
    nothing = inline_text.to_inlines(Text("nothing is said of it", muted=True))
    rows = [
        (title, inline_text.message_to_inlines(terms[name]) if name in terms else nothing)
        for name, title in GENERAL_TERMS.items()
    ]
    rows.append(("Variants", inline_text.to_inlines(" ".join(_describe_variants(content)))))
    lead = Paragraph(inline_text.to_inlines(_LEAD))
    return Section("page:terms", "Terms", (lead, Facts(tuple(rows)), *_write_variant_table(content)))


def describe_standing(content: AgreementContent) -> str:
    """Return in which variant a document holds; empty where the project has none."""
    if content.standing:
        return f"as it stands in {', '.join(content.standing)}"
    return "without its variants" if content.lookup.architecture.variants else ""


def list_variant_differences(changes: AgreementChanges) -> Iterator[str]:
    """Yield sentences on what two partners owe each other otherwise in a variant."""
    yield from (f"`{key[0]}` is there, too." for key in sorted(changes.added_keys))
    yield from (f"`{record.key[0]}` is not there." for record in changes.removed_records)
    for key in sorted(changes.changes_by_key):
        for term in changes.terms_of(key):
            if not term.is_expected and term.term_kind != "title":
                yield f"`{key[0]}`: {term.name}: {term.after or 'nothing'}; here: {term.before or 'nothing'}."


def _describe_variants(content: AgreementContent) -> Iterator[str]:
    standing = describe_standing(content)
    yield f"This document holds for the project {standing}." if standing else _ALWAYS
    if content.standing:
        yield _OTHERS


def _write_variant_table(content: AgreementContent) -> Iterator[Table]:
    rows: list[tuple[Inlines, ...]] = []
    for name, changes in content.variant_changes.items():
        differences = list(list_variant_differences(changes)) or ["Nothing: it is as here."]
        title = content.lookup.architecture.variants[name].title
        lines = inline_text.join_lines(map(inline_text.message_to_inlines, differences))
        rows.append((inline_text.to_inlines(title), lines))
    if rows:
        columns = (Column("Variant", 0.8), Column("What differs between the two", 3))
        yield Table("table:agreed_variants", "What differs in variants", columns, tuple(rows), numbered=False)
