"""The summary: what the architecture is and where it stands, on two pages, from what the site's start page shows."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator

from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.pages import dashboard
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import (
    Block,
    DashboardCard,
    Facts,
    Inlines,
    KeyFigure,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
)
from archgen.views.timing.timing_tables import is_blank

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


def _phrase_figure(figure: KeyFigure) -> tuple[str, Inlines]:
    """Write a figure of the start page as a fact: `7 of 8: 1 not proven`."""
    value = f"{figure.value} of {figure.total}" if figure.total else figure.value
    return figure.title, (Text(value, strong=True), Text(" · "), *_leave_refs(figure.note))


def _print_card(card: DashboardCard) -> Iterator[Block]:
    for block in card.blocks:
        match block:
            case Table():
                yield drop_wordless_columns(block)
            case Paragraph():
                yield dataclasses.replace(block, inlines=tuple(part for part in block.inlines if part.text))
            case _:
                yield block
    if card.remark and not any(isinstance(block, Table) for block in card.blocks):
        yield Paragraph(inline_text.to_inlines(Text(f"{card.remark[:1].upper()}{card.remark[1:]}.", muted=True)))


def drop_wordless_columns(table: Table) -> Table:
    """Drop columns that hold nothing but bars."""
    indices = [index for index in range(len(table.columns)) if not all(is_blank(row[index]) for row in table.rows)]
    return dataclasses.replace(
        table,
        columns=tuple(table.columns[index] for index in indices),
        rows=tuple(tuple(row[index] for index in indices) for row in table.rows),
    )


def _leave_refs(inlines: Iterable[Text]) -> Inlines:
    return tuple(dataclasses.replace(part, ref=None) for part in inlines)
