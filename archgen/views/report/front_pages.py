"""The first pages of the printed report: what a deliverable says of itself, its history, its words."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from archgen.analyses.size_counts import measure_progress
from archgen.model.report_settings import ReportSettings
from archgen.timing.chains.chain_verdicts import VERDICT_MEANINGS
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.pages import dashboard
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.picture_shapes import Drawing
from archgen.views.shapes import (
    Block,
    Column,
    DashboardCard,
    FactRow,
    Facts,
    Figure,
    Inlines,
    KeyFigure,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
    keep_columns,
    make_columns,
)
from archgen.views.timing import timing_verdicts
from archgen.views.timing.timing_tables import is_blank

_MAX_PARTNERS = 24
_SIGNS = (
    ("in, out", "a port that reads, a port that writes"),
    ("nobody yet, outside", "who reads an output: no component, or somebody outside of the system"),
    ("≤, ≥", "at most, at least; a sum with unknown parts is at least what is known"),
)
_ROS_SIGNS = (
    ("sub, pub", "subscribes to a topic, publishes it"),
    ("serves, calls", "offers a service or an action, uses one"),
    ("R 10, BE 5", "quality of service: reliable or best effort, with the depth of the queue"),
    ("TL, D, L, M", "transient local (latched), deadline, lifespan, manual liveliness"),
    ("a grey QoS", "nobody wrote it: the default of ROS"),
    ("`nav_msgs/Odometry`", "messages without their folder: `msg`, `srv` and `action` are told by the use"),
)
_SHORT_SIGNS = (
    ("≤, ≥", "at most, at least; a sum with unknown parts is at least what is known"),
    ("Rate", "how often it comes: as promised, else as it follows from the design"),
    ("Gap", "the longest time between two of them; unbounded where nobody says that one comes"),
    ("Age", "from the start of the work that gives it until it lies at the reader"),
    ("Promised", "what the giving partner has stated; nobody promises anything else"),
    ("Open, owes", "what the giving partner has still to state"),
)
_LEVEL_WORDS = {
    "functional": "functional level",
    "annex": "everything, the ROS side in an annex",
    "inline": "everything, each component with its ROS side",
}


def make_title_facts(lookup: Lookup, edition: DocumentEdition) -> tuple[tuple[str, Inlines], ...]:
    """Return the lines of the title page; what nobody wrote has none."""
    settings, architecture = edition.settings, lookup.architecture
    lines = (
        ("Number", settings.number),
        ("Version", architecture.project.version or ""),
        ("Date", settings.date or edition.date),
        ("Authors", ", ".join(settings.authors)),
        ("Dissemination", settings.dissemination),
        ("State", describe_progress(lookup)),
        ("Level", describe_level(edition) if edition.document == "full" else ""),
        ("Revision", edition.revision),
        ("ROS distribution", architecture.distro or ""),
    )
    return tuple((name, inline_text.to_inlines(value)) for name, value in lines if value)


def describe_level(edition: DocumentEdition) -> str:
    """Say in words which level the report shows."""
    return _LEVEL_WORDS["functional" if edition.level == "functional" else edition.ros_place]


def describe_progress(lookup: Lookup) -> str:
    """Say in a line how large the architecture is, and what is not yet proven of it."""
    architecture = lookup.architecture
    parts = [inline_text.count_noun(len(architecture.components), "component")]
    results = lookup.timing.chains if lookup.timing else ()
    if results:
        troubled = timing_verdicts.list_troubled_chains(lookup)
        met = len(results) - len(troubled)
        parts.append(f"{met} of {inline_text.count_noun(len(results), 'chain')} in time")
    if open_count := len(lookup.findings) + len(dashboard.make_chain_points(lookup)):
        parts.append(inline_text.count_noun(open_count, "open point"))
    return ", ".join(parts)


def make_partner_table(lookup: Lookup, *, has_chapter: bool = False) -> Table | None:
    """List the partners with what they are and what they own, for the title page; those with a chapter are linked to it.

    With a chapter there is none of more partners than the page has room for: the chapter begins with such a table.
    """
    architecture = lookup.architecture
    if not architecture.partners or (has_chapter and len(architecture.partners) > _MAX_PARTNERS):
        return None
    counts = {row.id: row.components for row in measure_progress(architecture) if row.scope == "partner"}
    rows = tuple(
        (
            inline_text.to_inlines(
                Text(partner.title, strong=True, ref=f"partner:{partner.id}" if has_chapter else None)
            ),
            inline_text.to_inlines(" ".join((partner.description or "").split())),
            inline_text.to_inlines(str(counts.get(partner.id, 0))),
            inline_text.to_inlines(str(sum(partner.id in node.owners for node in architecture.nodes.values()))),
        )
        for partner in architecture.partners.values()
    )
    columns = make_columns("Partner", ("Who it is", 3), ("Components", 0.6, "right"), ("Nodes", 0.5, "right"))
    anchors = () if has_chapter else tuple(f"partner:{partner_id}" for partner_id in architecture.partners)
    return Table("table:partners", "Partners", columns, rows, anchors, numbered=False)


def make_use_case_table(lookup: Lookup, *, has_chapter: bool = False) -> Table | None:
    """Say what the use cases are that requirements name; those with a section of their own in the chapter lead to it."""
    use_cases = lookup.architecture.use_cases.values()
    told = lookup.steps.by_use_case if has_chapter and lookup.scope.components is None else {}
    rows = tuple(
        (
            inline_text.to_inlines(
                Text(use_case.id, ref=f"use_case:{use_case.id}") if use_case.id in told else use_case.id
            ),
            inline_text.to_inlines(Text(use_case.title, strong=True)),
            inline_text.to_inlines(" ".join((use_case.description or "").split())),
        )
        for use_case in use_cases
    )
    columns = (Column("Id", 0.4), Column("Use case", 1.2), Column("What happens", 3))
    anchors = tuple(None if use_case.id in told else f"use_case:{use_case.id}" for use_case in use_cases)
    return Table("table:use_cases", "Use cases", columns, rows, anchors) if rows else None


def make_front_sections(lookup: Lookup, edition: DocumentEdition, legend: Drawing | None) -> Iterator[Section]:
    """Yield what stands before the contents: history, abbreviations, and how tables and pictures are read."""
    settings = edition.settings
    if settings.history:
        yield Section("front:history", "Document history", (_make_history_table(settings),))
    if settings.abbreviations:
        rows = tuple((name, inline_text.to_inlines(meaning)) for name, meaning in settings.abbreviations)
        yield Section("front:abbreviations", "Abbreviations", (Facts(rows),))
    if edition.document != "full":
        yield Section("front:signs", "How to read the tables", (Facts(tuple(_list_short_signs(lookup))),))
        return
    signs = (*_SIGNS, *(_ROS_SIGNS if edition.level == "implementation" and lookup.architecture.nodes else ()))
    facts = Facts(tuple((name.replace("`", ""), inline_text.message_to_inlines(words)) for name, words in signs))
    yield Section("front:signs", "How to read the tables", (facts,))
    if legend:
        figure = Figure(
            f"figure:{legend.id}", legend.id, legend.title, "The forms of boxes and arrows.", numbered=False
        )
        yield Section("front:legend", "How to read the pictures", (figure,))


def _list_short_signs(lookup: Lookup) -> Iterator[FactRow]:
    """Yield what the columns and the verdicts mean, those that the architecture has."""
    for name, words in _SHORT_SIGNS:
        yield name, inline_text.to_inlines(words)
    verdicts = {result.verdict for result in (lookup.timing.chains if lookup.timing else ()) if result.deadline}
    for word, meaning in VERDICT_MEANINGS.items():
        if word in verdicts:
            yield word, inline_text.to_inlines(meaning)


def _make_history_table(settings: ReportSettings) -> Table:
    rows = tuple(
        tuple(inline_text.to_inlines(text) for text in (entry.version, entry.date, entry.author, entry.change))
        for entry in settings.history
    )
    columns = (Column("Version", 0.5), Column("Date", 0.7), Column("Author"), Column("Change", 3))
    return Table("table:history", "Document history", columns, rows, numbered=False)


def list_properties(lookup: Lookup, edition: DocumentEdition) -> dict[str, str]:
    """Return what templates and document properties may ask for, by name; empty where nobody wrote it."""
    settings, architecture = edition.settings, lookup.architecture
    return {
        "project": architecture.project.title,
        "number": settings.number,
        "version": architecture.project.version or "",
        "date": settings.date or edition.date,
        "authors": ", ".join(settings.authors),
        "dissemination": settings.dissemination,
        "partners": ", ".join(partner.title for partner in architecture.partners.values()),
        "revision": edition.revision,
        "level": describe_level(edition),
        "status": describe_progress(lookup),
        "history": "; ".join(
            " ".join(filter(None, (entry.version, entry.date, entry.author, entry.change)))
            for entry in settings.history
        ),
        "abbreviations": "; ".join(f"{name}: {meaning}" for name, meaning in settings.abbreviations),
        "summary": " ".join(settings.summary.split()),
    }


_STATE_ORDER = ("chains", "progress", "points", "cells", "changes")


def make_summary(lookup: Lookup, edition: DocumentEdition, overview: Section | None) -> Section | None:
    """Make the summary of a report on the whole architecture; None for one on a part. It takes the overview's place."""
    if lookup.scope.components is not None:
        return None
    glance = dashboard.make_dashboard(lookup, edition)
    blocks = overview.blocks if overview else ()
    words = [Markdown(edition.settings.summary)] if edition.settings.summary else []
    figures = Facts(tuple(_phrase_figure(figure) for figure in glance.figures))
    cards = {card.kind: card for card in glance.cards}
    sections = tuple(
        Section(f"summary:{kind}", cards[kind].title, tuple(_print_card(cards[kind])))
        for kind in _STATE_ORDER
        if kind in cards
    )
    anchor = overview.anchor if overview else "page:index"
    return Section(anchor, "Summary", (*words, *blocks, figures), sections, page_break=True)


def stack_figure(figure: KeyFigure) -> Inlines:
    """Write a figure of the start page with its words below it."""
    value = f"{figure.value} of {figure.total}" if figure.total else figure.value
    note = "".join(part.text for part in figure.note)
    return Text(value, strong=True), Text(f"{figure.title}: {note}", muted=True, line_break=True)


def _phrase_figure(figure: KeyFigure) -> tuple[str, Inlines]:
    """Write a figure of the start page as a fact: `7 of 8: 1 not proven`."""
    value = f"{figure.value} of {figure.total}" if figure.total else figure.value
    return figure.title, (
        Text(value, strong=True),
        Text(" · "),
        *(dataclasses.replace(part, ref=None) for part in figure.note),
    )


def _print_card(card: DashboardCard) -> Iterator[Block]:
    for block in card.blocks:
        match block:
            case Table():
                # Columns that hold nothing but bars are dropped.
                places = range(len(block.columns))
                yield keep_columns(block, (at for at in places if not all(is_blank(row[at]) for row in block.rows)))
            case Paragraph():
                yield dataclasses.replace(block, inlines=tuple(part for part in block.inlines if part.text))
            case _:
                yield block
    if card.remark and not any(isinstance(block, Table) for block in card.blocks):
        yield Paragraph(inline_text.to_inlines(Text(f"{card.remark[:1].upper()}{card.remark[1:]}.", muted=True)))
