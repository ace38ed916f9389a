"""The report's sections in order, as pieces: each shape to its writer."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit.docx import chapters, figures, tables, text
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.views.shapes import Block, Bullets, Facts, Figure, Markdown, Outline, Paragraph, Section, Table


def anchors(outline: Outline) -> frozenset[str]:
    """Give everything in a report that a reference can point at."""
    return frozenset(found for section in outline.sections for found in _anchors(section))


def sections(draft: Draft, outline: Outline) -> Iterator[Piece]:
    """Give the pieces of all sections. The first begins a page; lettered appendices count anew."""
    lettered = False
    for index, section in enumerate(outline.sections):
        if section.appendix and not lettered:
            draft.counts, lettered = [], True
        yield from _section(draft, section, 1, appendix=section.appendix, new_page=index == 0 or section.page_break)


def _section(draft: Draft, section: Section, level: int, *, appendix: bool, new_page: bool) -> Iterator[Piece]:
    yield text.heading(draft, section.anchor, section.title, level, appendix=appendix, new_page=new_page)
    for block in section.blocks:
        yield from _block(draft, block, section, appendix=appendix)
    for below in section.sections:
        yield from _section(draft, below, level + 1, appendix=appendix, new_page=below.page_break)


def _block(draft: Draft, block: Block, section: Section, *, appendix: bool) -> Iterator[Piece]:
    match block:
        case Paragraph():
            yield text.said(draft, block)
        case Markdown():
            yield from chapters.chapter(draft, block, section.anchor, appendix=appendix)
        case Figure():
            yield from figures.figure(draft, block)
        case Bullets():
            yield from text.bullets(draft, block)
        case Facts():
            yield from tables.facts(draft, block)
        case Table():
            yield from tables.table(draft, block)


def _anchors(section: Section) -> Iterator[str]:
    yield section.anchor
    for block in section.blocks:
        if isinstance(block, (Table, Figure)):
            yield block.anchor
        if isinstance(block, Table):
            yield from (anchor for anchor in block.row_anchors if anchor)
    for below in section.sections:
        yield from _anchors(below)
