"""The texts of an outline, as a reader meets them: headings, captions, paragraphs, cells line by line, names of facts."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.views.shapes import Block, Bullets, Facts, Figure, Inlines, Markdown, Paragraph, Section, Table


def list_texts(section: Section) -> Iterator[str]:
    """Yield the texts of a section and of those below it."""
    yield section.title
    for block in section.blocks:
        yield from list_block_texts(block)
    for below in section.sections:
        yield from list_texts(below)


def list_block_texts(block: Block) -> Iterator[str]:
    """Yield the texts of a block."""
    match block:
        case Paragraph():
            yield from _split_lines(block.inlines)
        case Markdown():
            yield block.text
        case Figure():
            yield block.caption
        case Bullets():
            yield from (line for item in block.items for line in _split_lines(item))
        case Facts():
            for name, value in block.rows:
                yield name
                yield from _split_lines(value)
        case Table():
            yield from _list_table_texts(block)


def _list_table_texts(table: Table) -> Iterator[str]:
    yield table.caption
    yield from (column.title for column in table.columns)
    for row in table.rows:
        for cell in row:
            yield from _split_lines(cell)


def _split_lines(inlines: Inlines) -> Iterator[str]:
    text = "".join(f"\n{part.text}" if part.line_break else part.text for part in inlines)
    yield from text.split("\n")
