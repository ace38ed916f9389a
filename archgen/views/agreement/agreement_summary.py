"""The tables of an agreement over all its interfaces: at a glance, what changed, and what is still open."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.model.partner_interfaces import PartnerInterface
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.interface_record import InterfaceRecord
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.agreement.promise_rows import RATE, join_figures
from archgen.views.agreement.term_changes import NAME_KIND, AgreementChanges, write_signed_kind
from archgen.views.element_references import message_link
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import Column, Inlines, Paragraph, Section, Table, Text, drop_empty_columns, make_columns

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
    return inline_text.to_inlines("; ".join(phrases)) if phrases else ()


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
    records_by_point = _group_open_points(content.records)
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


def _group_open_points(records: Sequence[InterfaceRecord]) -> Mapping[str, Sequence[InterfaceRecord]]:
    """Return the interfaces at which each point is open."""
    grouped: dict[str, list[InterfaceRecord]] = {}
    for record in records:
        for point in record.terms.open_points:
            grouped.setdefault(point, []).append(record)
    return grouped


def _interface_link(record: InterfaceRecord) -> Text:
    return Text(record.terms.title, ref=record.terms.interface.anchor)
