"""The outline of an agreement: the partners, all interfaces at a glance and in detail, open points, signatures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.agreement.interface_sections import SectionWriter
from archgen.views.agreement.interface_terms import InterfaceTerms, partner_titles
from archgen.views.agreement.partner_interfaces import PartnerInterface
from archgen.views.agreement.term_changes import SIGNED_KINDS, AgreementChanges, InterfaceRecord
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Column,
    Figure,
    Graph,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
)
from archgen.views.tables import architecture_tables

_OWNERSHIP_NOTE = (
    "An element whose owner nobody wrote has that of its group or component, a node those of its components. Where an element "
    "belongs to several partners, or a component to one and its node to another, each of them answers for its interfaces, and "
    "the interface says so. What belongs to both partners at both ends is theirs together and not listed."
)


@dataclass(frozen=True, slots=True)
class AgreementContent:
    """What an agreement is made of. `earlier_lookup` is None unless changes are asked for; `notices` come first."""

    lookup: Lookup
    pair: tuple[str, str]
    records: tuple[InterfaceRecord, ...]
    graph: Graph
    revision: str = ""
    changes: AgreementChanges | None = None
    notices: tuple[Paragraph, ...] = ()
    earlier_lookup: Lookup | None = None
    """Look-ups of the architecture at the earlier revision."""

    @property
    def pair_titles(self) -> tuple[str, str]:
        """Return the titles of both partners."""
        return partner_titles(self.lookup, self.pair[:1]), partner_titles(self.lookup, self.pair[1:])


def outline_agreement(content: AgreementContent) -> Outline:
    """Return the outline of an agreement."""
    first, second = content.pair_titles
    # One writer for both directions: it remembers which messages' fields are already in the document.
    section_writer = SectionWriter(content.lookup, content.changes)
    directions = (content.pair, content.pair[::-1])
    return Outline(
        title=f"{first} and {second}",
        subtitle="Interface agreement",
        facts=tuple(_agreement_facts(content)),
        notices=(*content.notices, *_changes_notice(content)),
        sections=(
            _partners_section(content),
            _summary_section(content),
            *(
                section
                for direction in directions
                for section in _direction_section(content, section_writer, direction)
            ),
            *_removed_section(content),
            _open_points_section(content),
            _signatures_section(content),
        ),
    )


def _agreement_facts(content: AgreementContent) -> Iterator[tuple[str, Inlines]]:
    project = content.lookup.architecture.project
    yield (
        "Between",
        inline_text.join_lines(
            _partner_runs(content.lookup.architecture.partners[partner_id]) for partner_id in content.pair
        ),
    )
    yield "Project", inline_text.to_inlines(project.title)
    if project.version:
        yield "Version", inline_text.to_inlines(project.version)
    if content.revision:
        yield "Revision", inline_text.to_inlines(content.revision)
    if content.changes:
        yield "Changes since", inline_text.to_inlines(content.changes.earlier_revision)
    if content.lookup.architecture.distro:
        yield "ROS distribution", inline_text.to_inlines(content.lookup.architecture.distro)


def _partner_runs(partner: Partner) -> Inlines:
    return inline_text.to_inlines(
        Text(partner.title, strong=True), *([f", {partner.contact}"] if partner.contact else [])
    )


def _changes_notice(content: AgreementContent) -> tuple[Paragraph, ...]:
    if content.changes is None:
        return ()
    if not content.changes.has_changes:
        return (
            Paragraph(
                inline_text.to_inlines(
                    f"Nothing between the two has changed since {content.changes.earlier_revision}."
                ),
                "note",
            ),
        )
    counts = {
        "added": len(content.changes.added_keys),
        "changed": len(content.changes.changes_by_key or {}),
        "removed": len(content.changes.removed_records),
    }
    count_phrase = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
    return (
        Paragraph(
            inline_text.to_inlines(f"Interfaces since {content.changes.earlier_revision}: {count_phrase}."), "note"
        ),
    )


def _partners_section(content: AgreementContent) -> Section:
    columns = (Column("Partner", 0.9), Column("Who it is", 1.6), Column("Contact", 1.1), Column("Gives", 0.5, "right"))
    rows = []
    for partner_id in content.pair:
        partner = content.lookup.architecture.partners[partner_id]
        given_count = sum(record.terms.interface.pair[0] == partner_id for record in content.records)
        rows.append(
            (
                inline_text.to_inlines(Text(partner.title, strong=True)),
                inline_text.to_inlines(" ".join((partner.description or "").split())),
                inline_text.to_inlines(partner.contact) if partner.contact else (),
                inline_text.to_inlines(inline_text.count_noun(given_count, "interface")),
            )
        )
    table = drop_empty_columns(Table("table:parties", "The partners", columns, tuple(rows), numbered=False))
    drawing = Figure(f"figure:{content.graph.id}", content.graph.id, content.graph.title, content.graph.alt)
    return Section(
        "page:parties", "Partners and scope", (table, Paragraph(inline_text.to_inlines(_OWNERSHIP_NOTE)), drawing)
    )


def _summary_section(content: AgreementContent) -> Section:
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
        carried_runs(interface_terms.interface),
        _rate_runs(interface_terms),
        open_term_runs(interface_terms.open_terms, len(interface_terms.findings)),
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
    return (
        inline_text.to_inlines(Text(interface_terms.title, ref=f"removed:{interface_terms.interface.anchor}")),
        inline_text.to_inlines(Text(SIGNED_KINDS["removed"], change="removed")),
        inline_text.to_inlines(partner_titles(content.lookup, interface_terms.interface.pair[:1])),
        carried_runs(interface_terms.interface),
        (),
        (),
    )


def carried_runs(interface: PartnerInterface) -> Inlines:
    """Return what flows in a few words: the type, and the message that carries it."""
    carried_parts = (
        [inline_text.to_inlines(interface.type)] if interface.type and interface.type != interface.message else []
    )
    carried_parts += [inline_text.to_inlines(Text(interface.message, code=True))] if interface.message else []
    return inline_text.join_lines(carried_parts) or inline_text.to_inlines(interface.flow)


def open_term_runs(open_terms: Sequence[str], finding_count: int) -> Inlines:
    """Return what is still to be settled: the unknown terms, and the number of findings."""
    phrases = [", ".join(open_terms)] if open_terms else []
    phrases += [inline_text.count_noun(finding_count, "finding")] if finding_count else []
    return inline_text.to_inlines("; ".join(phrases)) if phrases else ()


def change_mark(changes: AgreementChanges | None, record: InterfaceRecord) -> Inlines:
    """Return the change of an interface as sign and word, with the kinds of terms that changed."""
    change_kind = changes.change_kind(record.key) if changes else ""
    if not changes or not change_kind:
        return ()
    names = ", ".join(dict.fromkeys(term_change.term_kind for term_change in changes.changes_of(record.key)))
    return inline_text.to_inlines(
        Text(SIGNED_KINDS[change_kind], change=change_kind), *([f": {names}"] if names else [])
    )


def _direction_section(
    content: AgreementContent, section_writer: SectionWriter, direction: tuple[str, ...]
) -> Iterator[Section]:
    giver_title, taker_title = (partner_titles(content.lookup, [partner_id]) for partner_id in direction)
    direction_records = [record for record in content.records if record.terms.interface.pair == direction]
    if direction_records:
        sections = tuple(
            section_writer.write_section(record, record.terms.interface.anchor, change_mark(content.changes, record))
            for record in direction_records
        )
        name = f"From {giver_title} to {taker_title}"
        lead = Paragraph(
            inline_text.to_inlines(
                f"{giver_title} gives, {taker_title} takes: {inline_text.count_noun(len(direction_records), 'interface')}."
            )
        )
        yield Section(f"way:{direction[0]}", name, (lead,), sections)


def _removed_section(content: AgreementContent) -> Iterator[Section]:
    if content.changes and content.changes.removed_records and content.earlier_lookup:
        # Removed interfaces are described by the architecture that had them.
        section_writer = SectionWriter(content.earlier_lookup)
        lead = Paragraph(
            inline_text.to_inlines(
                f"These stood in the agreement at {content.changes.earlier_revision}, and are gone."
            ),
            "warning",
        )
        sections = tuple(
            section_writer.write_removed(record, f"removed:{record.terms.interface.anchor}")
            for record in content.changes.removed_records
        )
        yield Section("page:removed", "Removed", (lead,), sections)


def _open_points_section(content: AgreementContent) -> Section:
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


def _signatures_section(content: AgreementContent) -> Section:
    revision = f", at revision {content.revision}" if content.revision else ""
    title = content.lookup.architecture.project.title
    lead = Paragraph(
        inline_text.to_inlines(
            f"The partners agree on the interfaces of {title} as this document states them{revision}."
        )
    )
    blank = inline_text.join_lines([inline_text.to_inlines("\u00a0")] * 3)
    rows = tuple((inline_text.to_inlines(title), blank, blank, blank) for title in content.pair_titles)
    columns = (Column("Partner", 1.2), Column("Name", 1.3), Column("Date", 0.8), Column("Signature", 1.5))
    table = Table("table:signatures", "Signatures", columns, rows, numbered=False)
    return Section("page:signatures", "Signatures", (lead, table))
