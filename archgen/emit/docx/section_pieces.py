"""The report's sections in order, as pieces: each shape to its writer."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.figures import choose_sheet, write_figure
from archgen.emit.docx.markdown_chapters import write_chapter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.table_pieces import choose_table_sheet, drop_spacer, write_facts, write_table
from archgen.emit.docx.text_pieces import Heading, keep_with_next, write_bullets, write_heading, write_paragraph
from archgen.frozen import dataclass
from archgen.views.shapes import Block, Bullets, Facts, Figure, Markdown, Outline, Paragraph, Section, Table, Text

_SCOPE_LEVEL = 2
"""Chapters and the sections of their first level (components) keep their wide pictures and tables to themselves."""


@dataclass(frozen=True, slots=True)
class OutlineItem:
    """A heading (`block` is None) or a block, with the section that it stands in."""

    section: Section
    level: int
    block: Block | None
    appendix: bool
    new_page: bool = False


def list_anchors(outline: Outline) -> frozenset[str]:
    """Return everything in a report that a reference can point at."""
    return frozenset(anchor for section in outline.sections for anchor in _iter_anchors(section))


def write_sections(writer: DocxWriter, outline: Outline) -> Iterator[FlowPiece]:
    """Write all sections. The first begins a page; lettered appendices count anew."""
    yield from _drop_last_spacers(_write_all(writer, outline))


def _write_all(writer: DocxWriter, outline: Outline) -> Iterator[FlowPiece]:
    lettered = False
    for index, section in enumerate(outline.sections):
        if section.appendix and not lettered:
            # Their list is another one in Word too, and begins with A.
            writer.heading_counts, lettered = [], True
        new_page = index == 0 or section.page_break
        items = tuple(_iter_items(section, 1, appendix=section.appendix, new_page=new_page))
        starts = [place for place, item in enumerate(items) if item.block is None and item.level <= _SCOPE_LEVEL]
        for start, end in zip(starts, [*starts[1:], len(items)], strict=True):
            pieces = list(_write_scope(writer, items[start:end]))
            yield from _keep_whole(writer, pieces) if items[start].level == _SCOPE_LEVEL else pieces


def _keep_whole(writer: DocxWriter, pieces: Sequence[FlowPiece]) -> Iterator[FlowPiece]:
    """Yield the pieces of a component, or of what else has a section of its own, so that a page has all of it if one can."""
    height = math.fsum(piece.height for piece in pieces)
    fits = height <= writer.paper.base.text_height and all(piece.sheet is None for piece in pieces)
    for piece, following in itertools.pairwise((*pieces, None)):
        if piece is not None:
            yield keep_with_next(piece) if fits and following is not None else piece


def _drop_last_spacers(pieces: Iterator[FlowPiece]) -> Iterator[FlowPiece]:
    """Drop the space behind a table that ends a chapter: on a full page it would begin one that stays blank."""
    for piece, following in itertools.pairwise((*pieces, None)):
        if piece is not None:
            yield drop_spacer(piece) if following is not None and following.new_page else piece


def _iter_items(section: Section, level: int, *, appendix: bool, new_page: bool) -> Iterator[OutlineItem]:
    yield OutlineItem(section, level, None, appendix, new_page)
    for block in section.blocks:
        yield OutlineItem(section, level, block, appendix)
    for below in section.sections:
        yield from _iter_items(below, level + 1, appendix=appendix, new_page=below.page_break)


def _write_scope(writer: DocxWriter, items: Sequence[OutlineItem]) -> Iterator[FlowPiece]:
    """Write a chapter or a component. What needs another sheet comes last, so that the text before it fills its pages."""
    sheet_needs = [item.block is not None and not item.appendix and _needs_sheet(writer, item.block) for item in items]
    last = max(
        (index for index, item in enumerate(items) if item.block is not None and not sheet_needs[index]), default=-1
    )
    late = []
    for index, item in enumerate(items):
        if sheet_needs[index] and index < last and isinstance(item.block, (Figure, Table)):
            late.append(item)
            place = Text("The picture", ref=item.block.anchor, is_number=True)
            inlines = (place, Text(" stands on the wide page that follows: "), Text(item.block.caption))
            yield write_paragraph(writer, Paragraph(inlines))
        elif _stays_with_next(writer, items[index : index + 3]) or _opens_section(items, index):
            (piece,) = _write_item(writer, item)
            yield keep_with_next(piece)
        else:
            yield from _write_item(writer, item)
    for item in late:
        yield from _write_item(writer, item)


def _stays_with_next(writer: DocxWriter, items: Sequence[OutlineItem]) -> bool:
    """Tell whether the first of some items is a sentence on the figure or table behind it, or a paragraph before that one.

    Such a paragraph stays where the figure or table turns the page: else it might be alone on its own.
    """
    if _leads_to_block(items[:2]) or _is_title(items):
        return True
    is_lead = isinstance(items[0].block, Paragraph) and _leads_to_block(items[1:])
    return is_lead and items[2].block is not None and _needs_sheet(writer, items[2].block)


def _opens_section(items: Sequence[OutlineItem], index: int) -> bool:
    """Tell whether an item is the paragraph between a heading and a title: both would stand alone at the end of a page."""
    is_first = index > 0 and items[index - 1].block is None and isinstance(items[index].block, Paragraph)
    return is_first and _is_title(items[index + 1 : index + 3])


def _is_title(items: Sequence[OutlineItem]) -> bool:
    """Tell whether the first of some items is the paragraph over a table without a caption, or strong words over anything."""
    if len(items) < 2 or not isinstance(items[0].block, Paragraph):  # noqa: PLR2004 - both are there
        return False
    is_title = all(run.strong for run in items[0].block.inlines)
    block = items[1].block
    return block is not None and (is_title or (isinstance(block, Table) and not block.numbered))


def _leads_to_block(items: Sequence[OutlineItem]) -> bool:
    """Tell whether the first of two items is a sentence that names the figure or table behind it by its number."""
    if len(items) < 2 or not isinstance(items[0].block, Paragraph):  # noqa: PLR2004 - both are there
        return False
    following = items[1].block
    anchor = following.anchor if isinstance(following, (Figure, Table)) else None
    return any(part.is_number and part.ref == anchor for part in items[0].block.inlines)


def _needs_sheet(writer: DocxWriter, block: Block) -> bool:
    """Tell whether a block needs another sheet than the usual one."""
    if isinstance(block, Table):
        return choose_table_sheet(writer, block)[0] is not None
    if isinstance(block, Figure) and (picture := writer.pictures.get(block.graph)):
        return choose_sheet(writer, picture.width, picture.height)[0] is not None
    return False


def _write_item(writer: DocxWriter, item: OutlineItem) -> Iterator[FlowPiece]:
    section = item.section
    match item.block:
        case None:
            heading = Heading(section.anchor, section.title, item.level, item.appendix, item.new_page)
            yield write_heading(writer, heading)
        case Paragraph():
            yield write_paragraph(writer, item.block)
        case Markdown():
            yield from write_chapter(writer, item.block, section.anchor, item.level, appendix=item.appendix)
        case Figure():
            yield from write_figure(writer, item.block)
        case Bullets():
            yield from write_bullets(writer, item.block)
        case Facts():
            yield from write_facts(writer, item.block)
        case Table():
            yield from write_table(writer, item.block)


def _iter_anchors(section: Section) -> Iterator[str]:
    yield section.anchor
    for block in section.blocks:
        if isinstance(block, (Table, Figure)):
            yield block.anchor
        if isinstance(block, (Table, Facts)):
            yield from (anchor for anchor in block.row_anchors if anchor)
    for below in section.sections:
        yield from _iter_anchors(below)
