"""Of many partners, those that have little in a short form, so that two share a page: one table, and sentences."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.shapes import Block, Inlines, Paragraph, Table, Text, drop_empty_columns, make_columns

_MANY_PARTNERS = 12
"""With more of them, a page for each would make a document of partners alone."""
_MAX_FLOWS, _MAX_COMPONENTS = 12, 6


def is_short(flow_count: int, component_count: int, partner_count: int) -> bool:
    """Return whether one of so many partners shares a page with another one."""
    return flow_count <= _MAX_FLOWS and component_count <= _MAX_COMPONENTS and partner_count > _MANY_PARTNERS


def list_short_blocks(
    partner: Partner,
    flow_rows: Sequence[Iterable[tuple[Inlines, ...]]],
    deadlines: Iterable[Table],
    impacts: Iterable[Paragraph],
) -> Iterator[Block]:
    """Yield what a partner gives and takes, two lists of rows, in one table, and in sentences what rests on it."""
    cells = tuple(
        ((Text(verb, strong=True),) if not at else (), *row)
        for verb, rows in zip(("Gives", "Takes"), flow_rows, strict=True)
        for at, row in enumerate(rows)
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
    words = inline_text.join_inlines([_phrase_deadline(row) for each in deadlines for row in each.rows], "; ")
    for paragraph in impacts:
        yield Paragraph((*paragraph.inlines, *((Text(" Deadlines: "), *words, Text(".")) if words else ())))


def _phrase_deadline(row: tuple[Inlines, ...]) -> Inlines:
    chain, _, share, bound, deadline, verdict = row
    words = (Text(" ("), *share, Text(" of "), *bound, Text(" are its own, deadline "), *deadline, Text(": "))
    return (*chain, *words, *verdict, Text(")"))
