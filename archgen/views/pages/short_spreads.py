"""Of many partners each in a short form, on a page or less: one table, and sentences."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.shapes import Block, Inlines, Paragraph, Table, Text, drop_empty_columns, make_columns

MANY_PARTNERS = 12
"""With more of them, a spread for each would make a document of partners alone."""
MAX_SHORT_ROWS = 8
_MAX_DEADLINES = 3


def list_short_blocks(
    partner: Partner,
    sides: Iterable[tuple[str, Sequence[tuple[Inlines, ...]], str]],
    deadline_rows: Iterable[tuple[Inlines, ...]],
    impacts: Iterable[Paragraph],
) -> Iterator[Block]:
    """Yield what a partner gives and takes in one table, and in sentences what rests on it.

    Each side is a verb, the rows of its flows, and a sentence on those that are told together.
    """
    cells, remarks = [], []
    for verb, rows, words in sides:
        remarks += [f"{verb} {words}"] if words else []
        cells += [((Text(verb, strong=True),) if not at else (), *row) for at, row in enumerate(rows)]
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
    yield drop_empty_columns(
        Table(f"table:flows/{partner.id}", caption, columns, tuple(cells), numbered=False, dense=True)
    )
    if remarks:
        yield Paragraph(inline_text.to_inlines(Text(" ".join((*remarks, "The workbook has each.")), muted=True)))
    deadlines = list(map(_phrase_deadline, deadline_rows))
    for paragraph in impacts:
        shares = inline_text.join_first(deadlines, _MAX_DEADLINES, "; ")
        yield Paragraph((*paragraph.inlines, *((Text(" Deadlines: "), *shares, Text(".")) if shares else ())))


def _phrase_deadline(row: tuple[Inlines, ...]) -> Inlines:
    chain, _, share, bound, deadline, verdict = row
    words = (Text(" ("), *share, Text(" of "), *bound, Text(" are its own, deadline "), *deadline, Text(": "))
    return (*chain, *words, *verdict, Text(")"))
