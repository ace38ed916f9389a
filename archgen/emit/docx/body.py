"""The report's sections in order, as pieces: each shape to its writer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.emit.docx import chapters, figures, tables, text
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.views.shapes import Block, Bullets, Facts, Figure, Markdown, Outline, Paragraph, Section, Table, Text

_SCOPE = 2
"""Chapters and the sections of their first level (components) keep their wide pictures and tables to themselves."""


def anchors(outline: Outline) -> frozenset[str]:
    """Give everything in a report that a reference can point at."""
    return frozenset(found for section in outline.sections for found in _anchors(section))


def sections(draft: Draft, outline: Outline) -> Iterator[Piece]:
    """Give the pieces of all sections. The first begins a page; lettered appendices count anew."""
    lettered = False
    for index, section in enumerate(outline.sections):
        if section.appendix and not lettered:
            draft.counts, lettered = [], True
        items = tuple(_items(section, 1, appendix=section.appendix, new_page=index == 0 or section.page_break))
        starts = [place for place, item in enumerate(items) if item.block is None and item.level <= _SCOPE]
        for start, end in zip(starts, [*starts[1:], len(items)], strict=True):
            yield from _scope(draft, items[start:end])


@dataclass(frozen=True, slots=True)
class _Item:
    """A heading (`block` is None) or a block, with the section that it stands in."""

    section: Section
    level: int
    block: Block | None
    appendix: bool
    new_page: bool = False


def _items(section: Section, level: int, *, appendix: bool, new_page: bool) -> Iterator[_Item]:
    yield _Item(section, level, None, appendix, new_page)
    for block in section.blocks:
        yield _Item(section, level, block, appendix)
    for below in section.sections:
        yield from _items(below, level + 1, appendix=appendix, new_page=below.page_break)


def _scope(draft: Draft, items: Sequence[_Item]) -> Iterator[Piece]:
    """Give a chapter's or a component's pieces. What needs a turned page comes last, so that the text before it fills its pages."""
    turned = [item.block is not None and not item.appendix and _turns(draft, item.block) for item in items]
    last = max((index for index, item in enumerate(items) if item.block is not None and not turned[index]), default=-1)
    late = []
    for index, item in enumerate(items):
        if turned[index] and index < last and isinstance(item.block, (Figure, Table)):
            late.append(item)
            words = (Text("On the wide page that follows: "), Text(item.block.caption, ref=item.block.anchor))
            yield text.said(draft, Paragraph(words))
        else:
            yield from _item(draft, item)
    for item in late:
        yield from _item(draft, item)


def _turns(draft: Draft, block: Block) -> bool:
    if isinstance(block, Table):
        return tables.fitting(draft, block)[0] is not None
    if isinstance(block, Figure) and (picture := draft.pictures.get(block.graph)):
        return figures.fitting(draft, picture.width, picture.height)[0] is not None
    return False


def _item(draft: Draft, item: _Item) -> Iterator[Piece]:
    match item.block:
        case None:
            section = item.section
            yield text.heading(
                draft, section.anchor, section.title, item.level, appendix=item.appendix, new_page=item.new_page
            )
        case Paragraph():
            yield text.said(draft, item.block)
        case Markdown():
            yield from chapters.chapter(draft, item.block, item.section.anchor, item.level, appendix=item.appendix)
        case Figure():
            yield from figures.figure(draft, item.block)
        case Bullets():
            yield from text.bullets(draft, item.block)
        case Facts():
            yield from tables.facts(draft, item.block)
        case Table():
            yield from tables.table(draft, item.block)


def _anchors(section: Section) -> Iterator[str]:
    yield section.anchor
    for block in section.blocks:
        if isinstance(block, (Table, Figure)):
            yield block.anchor
        if isinstance(block, Table):
            yield from (anchor for anchor in block.row_anchors if anchor)
    for below in section.sections:
        yield from _anchors(below)
