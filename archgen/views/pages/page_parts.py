"""Pages in parts: rows of very long tables, and pictures of which there are many, get further pages of their own.

A browser takes seconds for a table of 10,000 rows, and for 100 pictures on one page.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.frozen import replace
from archgen.views import inline_text
from archgen.views.shapes import Block, Bullets, Figure, Page, Paragraph, Section, Table, Text

MAX_ROWS = 1_500
"""The rows of a table on one page: some 700 kB."""
MAX_FIGURES = 20
PARTS_KIND = "parts"
"""The kind of the further pages: they are no elements, and nobody counts them."""


def split_pages(pages: Iterable[Page]) -> Iterator[Page]:
    """Yield the pages, each that is too long followed by the pages with its further parts."""
    for page in pages:
        further_pages: list[Page] = []
        section = _shorten_section(page, page.section, further_pages)
        yield replace(page, section=section) if further_pages else page
        yield from further_pages


def _shorten_section(page: Page, section: Section, further_pages: list[Page]) -> Section:
    """Return a section of a page with what fits; add pages with the rest."""
    blocks: list[Block] = []
    figures = [block for block in section.blocks if isinstance(block, Figure)]
    if len(figures) > MAX_FIGURES:
        further_pages += (_make_figure_page(page, figure) for figure in figures)
        blocks.append(Bullets(tuple(inline_text.to_inlines(Text(each.caption, ref=each.anchor)) for each in figures)))
    for block in section.blocks:
        if isinstance(block, Table) and len(block.rows) > MAX_ROWS:
            (note, first_part), *further_parts = _split_table(block)
            blocks += [note, first_part]
            further_pages += (_make_table_page(page, *part) for part in further_parts)
        elif not isinstance(block, Figure) or len(figures) <= MAX_FIGURES:
            blocks.append(block)
    sections = tuple(_shorten_section(page, inner, further_pages) for inner in section.sections)
    return replace(section, blocks=tuple(blocks), sections=sections)


def _make_figure_page(page: Page, figure: Figure) -> Page:
    path = f"{page.path.removesuffix('.html')}/{figure.graph.rpartition('/')[2]}.html"
    return _make_further_page(page, path, f"page:{figure.anchor}", figure.caption, (figure,))


def _make_table_page(page: Page, note: Paragraph, part: Table) -> Page:
    path = f"{page.path.removesuffix('.html')}-{part.anchor.rpartition('/')[2]}.html"
    return _make_further_page(page, path, f"page:{part.anchor}", part.caption, (note, part))


def _make_further_page(page: Page, path: str, anchor: str, title: str, blocks: tuple[Block, ...]) -> Page:
    crumbs = (*page.crumbs, (page.title, page.anchor))
    return Page(path, anchor, title, PARTS_KIND, Section(anchor, title, blocks), crumbs, page.lead)


def _split_table(table: Table) -> Iterator[tuple[Paragraph, Table]]:
    """Yield the parts of a table, each with a paragraph that links to all of them."""
    starts = range(0, len(table.rows), MAX_ROWS)
    spans = [f"{start + 1:,} to {min(start + MAX_ROWS, len(table.rows)):,}" for start in starts]
    anchors = [table.anchor, *(f"{table.anchor}/{start + 1}" for start in starts[1:])]
    links = [(Text(span, ref=anchor),) for span, anchor in zip(spans, anchors, strict=True)]
    note = Paragraph(inline_text.to_inlines(f"{len(table.rows):,} rows: ", *inline_text.join_inlines(links), "."))
    for start, span, anchor in zip(starts, spans, anchors, strict=True):
        part = replace(
            table,
            anchor=anchor,
            caption=f"{table.caption}: {span}",
            rows=table.rows[start : start + MAX_ROWS],
            row_anchors=table.row_anchors[start : start + MAX_ROWS],
        )
        yield note, part
