"""The title page: title, subtitle, the facts about the document, and what the reader must know first."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.docx import tables, text
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.inlines import plain
from archgen.emit.docx.markup import run
from archgen.views.shapes import Facts, Outline


def values(outline: Outline) -> dict[str, str]:
    """Give what a template may ask for by a name in double braces: title, subtitle, and the facts by their names."""
    named = {name.casefold(): plain(value).replace("\n", ", ") for name, value in outline.facts}
    return {**named, "title": outline.title, "subtitle": outline.subtitle}


def pieces(draft: Draft, outline: Outline, *, titled: bool) -> Iterator[Piece]:
    """Give the title page's pieces; without the title where the template's cover shows it (`titled`)."""
    if not titled:
        yield text.flowing(draft, text.Words(run(outline.title), outline.title), "Title")
        if outline.subtitle:
            yield text.flowing(draft, text.Words(run(outline.subtitle), outline.subtitle), "Subtitle")
    if outline.facts:
        yield from tables.facts(draft, Facts(outline.facts))
    for notice in outline.notices:
        yield text.said(draft, notice)
