"""The outline of an agreement: the partners, all interfaces at a glance and in detail, open points, signatures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.grouping import group_pairs
from archgen.model.architecture import Partner
from archgen.model.partner_interfaces import PartnerInterface
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.general_sections import (
    describe_standing,
    list_changed_frames,
    list_changed_settings,
    list_start_steps,
    write_budget_section,
    write_frame_section,
    write_setting_section,
    write_start_section,
    write_terms_section,
    write_use_case_section,
)
from archgen.views.agreement.interface_record import InterfaceRecord, write_signature_table
from archgen.views.agreement.interface_sections import SectionWriter
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.agreement.promise_rows import RATE, join_figures
from archgen.views.agreement.term_changes import NAME_KIND, AgreementChanges, write_signed_kind
from archgen.views.element_references import message_link
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
    make_columns,
)

_MAX_OWN_ROWS = 2
"""With the same point open at more interfaces than these, it has one row with all of them: it would drown the others."""


def write_summary_section(content: AgreementContent) -> Section:
    """List all interfaces."""
    rows = [_summary_row(content, record) for record in content.records]
    columns = make_columns(
        ("Interface", 1.6), ("From", 0.8), ("What flows", 1.7), ("Rate", 1.05), ("Version", 0.8), ("Still open", 1)
    )
    table = drop_empty_columns(Table("table:interfaces", "All interfaces", columns, tuple(rows), numbered=False))
    active_directions = {record.terms.interface.pair for record in content.records}
    silent_notes = (
        Paragraph(
            inline_text.to_inlines(
                f"Nothing flows from {join_owner_titles(content.lookup, direction[:1])} to {join_owner_titles(content.lookup, direction[1:])}."
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
        inline_text.to_inlines(join_owner_titles(content.lookup, interface_terms.interface.pair[:1])),
        _carried_runs(interface_terms.interface),
        _rate_runs(interface_terms),
        _version_runs(content, record),
        _open_term_runs(
            interface_terms.open_terms, len(interface_terms.contradictions), len(interface_terms.late_chains)
        ),
    )


def _rate_runs(interface_terms: InterfaceTerms) -> Inlines:
    """Return how often it flows, or within what it is answered, and whether that is promised."""
    for row in interface_terms.promise_rows:
        if row.name.key in {RATE.key, "response"} and (row.promised or row.expected):
            words = "answered within " if row.name.key == "response" else ""
            figure = join_figures(row.promised or row.expected)
            return inline_text.join_lines(
                [
                    inline_text.to_inlines(f"{words}{figure}"),
                    (Text("promised" if row.promised else "expected", muted=True),),
                ]
            )
    return ()


def _version_runs(content: AgreementContent, record: InterfaceRecord) -> Inlines:
    version, signatures = record.terms.version, content.signatures
    if not signatures.revision:
        return inline_text.to_inlines(version)
    signed_version = signatures.versions.get(record.key)
    word = (
        "not signed"
        if signed_version is None
        else "as signed"
        if signed_version == record.terms.find_version(signatures.rules)
        else "changed"
    )
    return inline_text.join_lines([inline_text.to_inlines(version), (Text(word, muted=word == "as signed"),)])


def _carried_runs(interface: PartnerInterface) -> Inlines:
    """Return what flows in a few words: the type, and the message that carries it."""
    carried_parts = (
        [inline_text.to_inlines(interface.type)] if interface.type and interface.type != interface.message else []
    )
    carried_parts += [inline_text.to_inlines(message_link(interface.message))] if interface.message else []
    return inline_text.join_lines(carried_parts) or inline_text.to_inlines(interface.flow)


def _open_term_runs(open_terms: Sequence[str], contradiction_count: int, late_chain_count: int) -> Inlines:
    """Return what is still to be settled: the open terms, and how many contradictions and late chains there are."""
    phrases = [", ".join(open_terms)] if open_terms else []
    phrases += [inline_text.count_noun(contradiction_count, "contradiction")] if contradiction_count else []
    phrases += [inline_text.count_noun(late_chain_count, "late chain")] if late_chain_count else []
    return inline_text.to_inlines("; ".join(phrases))


def write_change_log(content: AgreementContent) -> Iterator[Section]:
    """List the interfaces that came, went or changed since the earlier revision."""
    changes = content.changes
    if changes is None or not changes.has_changes:
        return
    rows = [
        (
            inline_text.to_inlines(Text(record.terms.title, ref=record.terms.interface.anchor)),
            mark,
            _version_step(changes.earlier_versions.get(record.key), record.terms.version),
        )
        for record in content.records
        if (mark := change_mark(changes, record))
    ]
    rows += [
        (
            inline_text.to_inlines(Text(record.terms.title, ref=f"removed:{record.terms.interface.anchor}")),
            inline_text.to_inlines(write_signed_kind("removed")),
            inline_text.to_inlines(f"was {record.terms.version}"),
        )
        for record in changes.removed_records
    ]
    columns = (Column("Interface", 1.4), Column("Change", 2), Column("Version", 1))
    table = Table("table:log", "What changed", columns, tuple(rows), numbered=False)
    yield Section("page:log", f"Changes since {changes.earlier_revision}", (table,))


def _version_step(old_version: str | None, new_version: str) -> Inlines:
    if old_version is None:
        return inline_text.to_inlines(new_version)
    is_same = old_version == new_version
    return inline_text.to_inlines(f"{new_version}, as before" if is_same else f"{old_version} → {new_version}")


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
    """List what the two have not settled yet, what is open at one or two interfaces first."""
    records_by_point = group_pairs((point, record) for record in content.records for point in record.terms.open_points)
    shared_points = [point for point, records in records_by_point.items() if len(records) > _MAX_OWN_ROWS]
    rows: list[tuple[Inlines, ...]] = []
    for record in content.records:
        own_points = [point for point in record.terms.open_points if point not in shared_points]
        if own_points:
            points = inline_text.join_lines(map(inline_text.message_to_inlines, own_points))
            rows.append(((_interface_link(record),), points))
    for point in shared_points:
        count = f"{len(records_by_point[point])} of {inline_text.count_noun(len(content.records), 'interface')}"
        links = inline_text.join_inlines(((_interface_link(record),) for record in records_by_point[point]), ", ")
        interfaces = inline_text.join_lines([inline_text.to_inlines(Text(count, strong=True)), links])
        rows.append((interfaces, inline_text.message_to_inlines(point)))
    columns = (Column("Interface", 1.4), Column("Not settled yet", 1.6))
    table = Table("table:missing", "What is not settled yet", columns, tuple(rows), numbered=False)
    nothing = Paragraph(
        inline_text.to_inlines("Nothing is open: every term is settled, and nothing contradicts another.")
    )
    return Section("page:open", "Open points", (table if rows else nothing,))


def _interface_link(record: InterfaceRecord) -> Text:
    return Text(record.terms.title, ref=record.terms.interface.anchor)


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
                inline_text.to_inlines(" ".join((partner.description or "").split())),
                inline_text.to_inlines(partner.contact),
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
