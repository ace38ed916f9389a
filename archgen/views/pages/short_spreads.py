"""Of many partners, those that have little in a short form, so that two share a page: one table, and sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.shapes import Block, Inlines, Paragraph, Table, Text, drop_empty_columns, make_columns

if TYPE_CHECKING:
    from archgen.views.pages.partner_spreads import SpreadWriter

_MANY_PARTNERS = 12
"""With more of them, a page for each would make a document of partners alone."""
_MAX_FLOWS, _MAX_COMPONENTS = 12, 6


def is_short(writer: SpreadWriter, partner: Partner) -> bool:
    """Return whether a partner shares a page with another one."""
    flows = sum(len(sides.get(partner.id, ())) for sides in (writer.given, writer.taken))
    is_small = flows <= _MAX_FLOWS and len(writer.components.get(partner.id, ())) <= _MAX_COMPONENTS
    return writer.folds and is_small and len(writer.partners) > _MANY_PARTNERS


def list_short_blocks(writer: SpreadWriter, partner: Partner) -> Iterator[Block]:
    """Yield what a partner gives and takes in one table, and in sentences what rests on it."""
    cells = tuple(
        ((Text(verb, strong=True),) if not at else (), *writer.write_flow(row, side))
        for side, verb in enumerate(("Gives", "Takes"))
        for at, row in enumerate(
            writer.gather_rows((writer.given, writer.taken)[side].get(partner.id, ()), side, by_output=True)
        )
    )
    columns = make_columns(
        ("", 0.5),
        ("What, by or for", 1.6),
        ("To or from", 1.5),
        ("Topic", 1.3),
        ("Rate", 0.7, "right"),
        ("Gap ≤", 0.7, "right"),
        ("Age ≤", 0.65, "right"),
        ("Promised", 0.7),
        ("Open", 0.7),
    )
    caption = f"What {partner.title} gives and takes"
    yield drop_empty_columns(Table(f"table:flows/{partner.id}", caption, columns, cells, numbered=False, dense=True))
    deadlines = [_phrase_deadline(row) for each in writer.list_deadline_blocks(partner) for row in each.rows]
    for paragraph in writer.list_impact_blocks(partner):
        words = inline_text.join_inlines(deadlines, "; ")
        yield Paragraph((*paragraph.inlines, *((Text(" Deadlines: "), *words, Text(".")) if words else ())))


def _phrase_deadline(row: tuple[Inlines, ...]) -> Inlines:
    chain, _, share, bound, deadline, verdict = row
    words = (Text(" ("), *share, Text(" of "), *bound, Text(" are its own, deadline "), *deadline, Text(": "))
    return (*chain, *words, *verdict, Text(")"))
