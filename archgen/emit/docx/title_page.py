"""The title page: title, subtitle, the facts about the document, and what the reader must know first."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.table_pieces import write_facts
from archgen.emit.docx.text_pieces import ParagraphContent, write_paragraph, write_text
from archgen.emit.docx.text_runs import join_text
from archgen.emit.docx.word_xml import format_run
from archgen.views.shapes import Facts, Outline


def list_placeholder_values(outline: Outline) -> dict[str, str]:
    """Return what a template may ask for by a name in double braces: title, subtitle, and the facts by their names."""
    facts = {name.casefold(): join_text(value).replace("\n", ", ") for name, value in outline.facts}
    return {**facts, "title": outline.title, "subtitle": outline.subtitle}


def write_title_page(writer: DocxWriter, outline: Outline, *, title_on_cover: bool) -> Iterator[FlowPiece]:
    """Write the title page; without the title where the template's cover shows it."""
    if not title_on_cover:
        yield write_text(writer, ParagraphContent(format_run(outline.title), outline.title), "Title")
        if outline.subtitle:
            yield write_text(writer, ParagraphContent(format_run(outline.subtitle), outline.subtitle), "Subtitle")
    if outline.facts:
        yield from write_facts(writer, Facts(outline.facts))
    for notice in outline.notices:
        yield write_paragraph(writer, notice)
