"""The outline of an agreement: the partners, all interfaces at a glance and in detail, open points, signatures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.agreement_summary import (
    change_mark,
    write_change_log,
    write_open_points_section,
    write_summary_section,
)
from archgen.views.agreement.general_sections import (
    describe_standing,
    list_changed_frames,
    list_start_steps,
    write_budget_section,
    write_frame_section,
    write_start_section,
    write_terms_section,
    write_use_case_section,
)
from archgen.views.agreement.interface_sections import SectionWriter
from archgen.views.agreement.setting_section import list_changed_settings, write_setting_section
from archgen.views.agreement.signature_record import write_signature_table
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import (
    Block,
    Column,
    Figure,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
)

_SCOPE_NOTE = (
    "This agreement covers what the components and programs of one partner give to those of the other. Where something "
    "belongs to several partners, each of them answers for it, and its section says so. What belongs to both partners at both "
    "ends is theirs together and not listed."
)
_PROMISE_NOTE = (
    "Promised is what the giving partner has stated. Expected is what follows from other figures of the design: it is "
    "given for information, and nobody promises it. The version of an interface changes with what passes (names, message, "
    "fields, quality of service) and with what is promised, and with nothing else."
)


def outline_agreement(content: AgreementContent) -> Outline:
    """Return the outline of an agreement."""
    first, second = content.pair_titles
    # One writer for both directions: it remembers which messages' fields are already in the document.
    section_writer = SectionWriter(
        content.lookup, content.changes, content.signatures, start_steps=list_start_steps(content.lookup.architecture)
    )
    directions = (content.pair, content.pair[::-1])
    return Outline(
        title=f"{first} and {second}",
        subtitle="Interface agreement",
        facts=tuple(_agreement_facts(content)),
        notices=(*content.notices, *_changes_notice(content)),
        sections=(
            _partners_section(content),
            write_summary_section(content),
            *write_change_log(content),
            *(
                section
                for direction in directions
                for section in _direction_section(content, section_writer, direction)
            ),
            *_removed_section(content),
            *write_use_case_section(content),
            *write_frame_section(content),
            *write_setting_section(content),
            *write_start_section(content),
            *write_budget_section(content),
            write_terms_section(content),
            write_open_points_section(content),
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
        yield "Project version", inline_text.to_inlines(project.version)
    if standing := describe_standing(content):
        yield "Variant", inline_text.to_inlines(standing)
    if content.issue_date:
        yield "Date", inline_text.to_inlines(content.issue_date)
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
    since = content.changes.earlier_revision
    names_by_word = {
        "Frames": list_changed_frames(content),
        "Parameters and operations": list_changed_settings(content),
        "Terms": content.changes.changed_words,
    }
    others = [_name_changed(word, since, names) for word, names in names_by_word.items() if names]
    if others and not content.changes.has_changes:
        return tuple(others)
    text = (
        f"Interfaces since {since}: {content.changes.kind_counts}."
        if content.changes.has_changes
        else f"Nothing between the two has changed since {since}."
    )
    return (Paragraph(inline_text.to_inlines(text), "note"), *others)


def _name_changed(word: str, since: str, changed_names: Sequence[str]) -> Paragraph:
    names = inline_text.join_inlines((Text(name, code=True),) for name in changed_names)
    return Paragraph(inline_text.to_inlines(f"{word} that are not what they were at {since}: ", *names, "."), "note")


def _partners_section(content: AgreementContent) -> Section:
    columns = (Column("Partner", 0.9), Column("Who it is", 1.6), Column("Contact", 1.1), Column("Gives", 0.5, "right"))
    rows = []
    for partner_id in content.pair:
        partner = content.lookup.architecture.partners[partner_id]
        given_count = sum(record.terms.interface.pair[0] == partner_id for record in content.records)
        rows.append(
            (
                inline_text.to_inlines(Text(partner.title, strong=True)),
                inline_text.to_inlines(" ".join(partner.description.split())) if partner.description else (),
                inline_text.to_inlines(partner.contact) if partner.contact else (),
                inline_text.to_inlines(inline_text.count_noun(given_count, "interface")),
            )
        )
    table = drop_empty_columns(Table("table:parties", "The partners", columns, tuple(rows), numbered=False))
    drawing = Figure(f"figure:{content.graph.id}", content.graph.id, content.graph.title, content.graph.alt)
    notes = (Paragraph(inline_text.to_inlines(note)) for note in (_SCOPE_NOTE, _PROMISE_NOTE))
    return Section("page:parties", "Partners and scope", (table, *notes, drawing))


def _direction_section(
    content: AgreementContent, section_writer: SectionWriter, direction: tuple[str, ...]
) -> Iterator[Section]:
    giver_title, taker_title = (join_owner_titles(content.lookup, [partner_id]) for partner_id in direction)
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


def _signatures_section(content: AgreementContent) -> Section:
    revision = f", at revision {content.revision}" if content.revision else ""
    date = f" of {content.issue_date}" if content.issue_date else ""
    title = content.lookup.architecture.project.title
    blocks: list[Block] = [
        Paragraph(
            inline_text.to_inlines(
                f"The partners agree on the interfaces of {title} as this document{date} states them{revision}."
            )
        )
    ]
    blank = inline_text.join_lines([inline_text.to_inlines("\u00a0")] * 3)
    signers = [content.signers.get(partner_id) for partner_id in content.pair]
    rows = tuple(
        (inline_text.to_inlines(title), *(map(inline_text.to_inlines, (name, content.issue_date))), blank)
        if name
        else (inline_text.to_inlines(title), blank, blank, blank)
        for title, name in zip(content.pair_titles, signers, strict=True)
    )
    columns = (Column("Partner", 1.2), Column("Name", 1.3), Column("Date", 0.8), Column("Signature", 1.5))
    blocks.append(Table("table:signatures", "Signatures", columns, rows, numbered=False))
    if content.signatures.tags:
        blocks += [
            Paragraph(inline_text.to_inlines("Signed before:")),
            drop_empty_columns(write_signature_table(content.signatures.tags)),
        ]
    # Names never stand on another page than what they sign.
    return Section("page:signatures", "Signatures", tuple(blocks), page_break=True)
