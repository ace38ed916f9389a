"""What pages of all kinds have: parts where tables are long, the place where a thing is written, a word on what is not drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import replace
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import Architecture, find_made_element
from archgen.views import inline_text
from archgen.views.element_references import place_run
from archgen.views.lookup import Lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.picture_shapes import GraphKind
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


_KINDS_BY_FOLDER: dict[str, GraphKind] = {"components": "component", "groups": "group"}
"""The kinds of pictures that a note stands for, by the folder of their ids. One note is enough for a component's two."""


def keep_drawn(blocks: Iterable[Block], edition: DocumentEdition) -> tuple[Block, ...]:
    """Drop figures that are not among the drawings, with a note where they are left out for their number."""
    return tuple(_iterate_drawn(blocks, edition))


def _iterate_drawn(blocks: Iterable[Block], edition: DocumentEdition) -> Iterator[Block]:
    for block in blocks:
        if not isinstance(block, Figure) or block.graph in edition.drawings:
            yield block
        elif _KINDS_BY_FOLDER.get(block.graph.partition("/")[0]) in edition.undrawn_kinds:
            yield _make_note()


def make_timing_note(edition: DocumentEdition) -> tuple[Section, ...]:
    """Return a section in the place of the pictures of each group's timing, where these are left out."""
    if "group-timing" not in edition.undrawn_kinds:
        return ()
    return (Section("timing:groups", "Group by group", (_make_note(),)),)


def _make_note() -> Paragraph:
    """Return the note: where the same is to be seen, and how to have the picture."""
    link = Text("explorer", ref="page:explorer")
    return Paragraph(
        (
            Text("No picture is drawn here, since there would be very many. The ", muted=True),
            link,
            Text(" shows the same; ", muted=True),
            Text("archgen site --component-pictures", code=True),
            Text(" draws them all.", muted=True),
        )
    )


_PLACELESS = frozenset({"types", "variants", "libraries"})
"""What ships with archgen is in none of the project's files, but in those of its packed form; variants are in several."""


def place_pages(lookup: Lookup, pages: Iterable[Page]) -> tuple[Page, ...]:
    """Return the pages, those on something that is written in a file with its place."""
    spans = _list_spans(lookup.architecture)
    return tuple(_place_page(lookup, page, spans[page.anchor]) if page.anchor in spans else page for page in pages)


def _place_page(lookup: Lookup, page: Page, place: Span) -> Page:
    placed_page = replace(page, place=place_run(lookup, place))
    made = find_made_element(lookup.architecture.made_elements, place)
    if made is None or not made.passes:
        return placed_page
    words = str(made).replace("`", "")
    is_phrase = bool(page.lead) and page.lead[-1].isalnum()
    lead = f"{page.lead}, {words}" if is_phrase else f"{page.lead} {words[0].upper()}{words[1:]}.".lstrip()
    return replace(placed_page, lead=lead)


def _list_spans(architecture: Architecture) -> Mapping[str, Span]:
    """Return where each element with a page is written, by the page's anchor."""
    kinds = [("component", architecture.components), ("component", architecture.shells)]
    kinds += [(kind, getattr(architecture, name)) for name, kind in SECTION_KINDS.items() if name not in _PLACELESS]
    spans = {f"{kind}:{name}": element.at for kind, elements in kinds for name, element in elements.items()}
    return {anchor: span for anchor, span in spans.items() if span is not NO_SPAN}
