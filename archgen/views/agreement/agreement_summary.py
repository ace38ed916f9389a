"""The tables of an agreement over all its interfaces: at a glance, and what is still open."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.interface_terms import InterfaceTerms, partner_titles
from archgen.views.agreement.partner_interfaces import PartnerInterface
from archgen.views.agreement.term_changes import NAME_KIND, AgreementChanges, InterfaceRecord, write_signed_kind
from archgen.views.shapes import Block, Column, Inlines, Paragraph, Section, Table, Text, drop_empty_columns
from archgen.views.tables import architecture_tables


def write_summary_section(content: AgreementContent) -> Section:
    """List all interfaces, including removed ones."""
    rows = [_summary_row(content, record) for record in content.records]
    rows += [_removed_row(content, record) for record in (content.changes.removed_records if content.changes else ())]
    columns = (
        Column("Interface", 1.6),
        Column("Change", 1.1),
        Column("From", 0.8),
        Column("What flows", 1.7),
        Column("Rate", 0.95),
        Column("Still open", 1),
    )
    table = drop_empty_columns(Table("table:interfaces", "All interfaces", columns, tuple(rows)))
    active_directions = {record.terms.interface.pair for record in content.records}
    silent_notes = (
        Paragraph(
            inline_text.to_inlines(
                f"Nothing flows from {partner_titles(content.lookup, direction[:1])} to {partner_titles(content.lookup, direction[1:])}."
            )
        )
        for direction in (content.pair, content.pair[::-1])
        if direction not in active_directions
    )
    return Section("page:summary", "At a glance", (*([table] if rows else []), *silent_notes))


def _summary_row(content: AgreementContent, record: InterfaceRecord) -> tuple[Inlines, ...]:
    interface_terms = record.terms
    return (
        inline_text.to_inlines(Text(interface_terms.title, ref=interface_terms.interface.anchor)),
        change_mark(content.changes, record),
        inline_text.to_inlines(partner_titles(content.lookup, interface_terms.interface.pair[:1])),
        _carried_runs(interface_terms.interface),
        _rate_runs(interface_terms),
        _open_term_runs(interface_terms.open_terms, len(interface_terms.findings)),
    )


def _rate_runs(interface_terms: InterfaceTerms) -> Inlines:
    """Return how often it flows, or within what it is answered, without the origin of the figure."""
    for fact_name, value in interface_terms.facts:
        if fact_name.startswith("Rate"):
            return value[:1]
        if fact_name.startswith("Answers within") and not value[0].muted:
            return inline_text.to_inlines("answered within ", value[0])
    return ()


def _removed_row(content: AgreementContent, record: InterfaceRecord) -> tuple[Inlines, ...]:
    interface_terms = record.terms
    # Its partners may have other ids now: their titles are those of the architecture that had it.
    lookup = content.earlier_lookup or content.lookup
    return (
        inline_text.to_inlines(Text(interface_terms.title, ref=f"removed:{interface_terms.interface.anchor}")),
        inline_text.to_inlines(write_signed_kind("removed")),
        inline_text.to_inlines(partner_titles(lookup, interface_terms.interface.pair[:1])),
        _carried_runs(interface_terms.interface),
        (),
        (),
    )


def _carried_runs(interface: PartnerInterface) -> Inlines:
    """Return what flows in a few words: the type, and the message that carries it."""
    carried_parts = (
        [inline_text.to_inlines(interface.type)] if interface.type and interface.type != interface.message else []
    )
    carried_parts += [inline_text.to_inlines(Text(interface.message, code=True))] if interface.message else []
    return inline_text.join_lines(carried_parts) or inline_text.to_inlines(interface.flow)


def _open_term_runs(open_terms: Sequence[str], finding_count: int) -> Inlines:
    """Return what is still to be settled: the unknown terms, and the number of findings."""
    phrases = [", ".join(open_terms)] if open_terms else []
    phrases += [inline_text.count_noun(finding_count, "finding")] if finding_count else []
    return inline_text.to_inlines("; ".join(phrases)) if phrases else ()


def change_mark(changes: AgreementChanges | None, record: InterfaceRecord) -> Inlines:
    """Return the change of an interface as sign and word, with its old name and the kinds of terms that changed."""
    change_kind = changes.change_kind(record.key) if changes else None
    if not changes or not change_kind:
        return ()
    change = changes.changes_by_key.get(record.key)
    runs = [write_signed_kind(change_kind)]
    if change and change.old_name:
        runs += [Text(" (was "), Text(change.old_name, code=True), Text(")")]
    # The name is told already.
    kinds = dict.fromkeys(term.term_kind for term in changes.terms_of(record.key) if term.term_kind != NAME_KIND)
    return (*runs, *([Text(f": {', '.join(kinds)}")] if kinds else []))


def write_open_points_section(content: AgreementContent) -> Section:
    """List what is not settled, and every finding at either end."""
    records_with_open_terms = [
        (record.terms, record.terms.open_terms) for record in content.records if record.terms.open_terms
    ]
    rows = tuple(
        (
            inline_text.to_inlines(Text(interface_terms.title, ref=interface_terms.interface.anchor)),
            inline_text.to_inlines(", ".join(names)),
        )
        for interface_terms, names in records_with_open_terms
    )
    blocks: list[Block] = []
    if rows:
        columns = (Column("Interface"), Column("Not settled yet", 1.4))
        blocks.append(Table("table:missing", "Terms that are not settled yet", columns, rows))
    own_findings = list(
        dict.fromkeys(interface_finding for record in content.records for interface_finding in record.terms.findings)
    )
    end_ids = {
        interface_end.component.id
        for record in content.records
        for interface_end in record.terms.ends
        if interface_end.component
    }
    end_ids |= {
        interface_end.node for record in content.records for interface_end in record.terms.ends if interface_end.node
    }
    near_findings = [
        finding for finding in content.lookup.findings if finding.element in end_ids and finding not in own_findings
    ]
    finding_tables = (
        architecture_tables.make_finding_table(own_findings, "table:points"),
        architecture_tables.make_finding_table(near_findings, "table:near"),
    )
    for table, caption in zip(
        finding_tables, ("Findings on the interfaces", "Other findings at their ends"), strict=True
    ):
        if table:
            blocks.append(Table(table.anchor, caption, table.columns, table.rows))
    if not blocks:
        blocks.append(
            Paragraph(
                inline_text.to_inlines(
                    "Nothing is open: every term is settled, and archgen finds nothing at either end."
                )
            )
        )
    return Section("page:open", "Open points", tuple(blocks))
