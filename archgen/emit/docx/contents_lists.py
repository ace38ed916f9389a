"""The tables of contents, figures and tables: every entry a link with the number of its page.

Word gets a real field around them, which somebody can update. LibreOffice keeps what such a field holds as it is, wrong numbers too, while it
computes the page of an entry that stands outside of one. So the outer field is written for those alone who know Word 2016's additions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.title_page import write_front_heading
from archgen.emit.docx.word_xml import escape_text, format_field, format_paragraph, format_run, points_to_twips

_MAX_LEVEL = 3
"""Levels of headings in the table of contents, if they fit a page or two."""
_MAX_LINES = 100
"""From this many lines on the contents have the first two levels alone."""
_MAX_TABLES = 60
_NUMBER_WIDTH = 30.0
"""Points at the right that page numbers take."""


def write_contents(
    writer: DocxWriter, pages: Mapping[str, int], lists: Collection[str] = ("figures", "tables")
) -> Iterator[FlowPiece]:
    """Write the contents, and the lists that are asked for. `pages` has the page of each bookmark.

    A list of a single figure or table, or of none, is left out, and one of so many tables that nobody reads it.
    """
    # Switches (ECMA-376 17.16.5.68): \o by levels of headings, \h links, \z no numbers on a screen, \u outline levels of other
    # styles, \c the captions with a SEQ field of a name.
    level_count = _MAX_LEVEL - (sum(entry.level <= _MAX_LEVEL for entry in writer.headings) > _MAX_LINES)
    headings = [(entry, f"toc {entry.level}") for entry in writer.headings if entry.level <= level_count]
    yield from _write_list(writer, "Contents", f'TOC \\o "1-{level_count}" \\h \\z \\u', headings, pages)
    for title, kind in (("Figures", "Figure"), ("Tables", "Table")):
        entries = [(entry, "table of figures") for entry in writer.find_contents(kind)]
        if kind == "Table" and "tables" in lists and len(entries) > _MAX_TABLES:
            writer.warn(f"the report has {len(entries)} tables: a list of more than {_MAX_TABLES} is left out")
        elif len(entries) > 1 and title.casefold() in lists:
            yield from _write_list(writer, title, f'TOC \\h \\z \\c "{kind}"', entries, pages)


def _write_list(
    writer: DocxWriter,
    title: str,
    instruction: str,
    entries: Sequence[tuple[ContentsEntry, str]],
    pages: Mapping[str, int],
) -> Iterator[FlowPiece]:
    """Write a list of entries with their styles, in a field that Word computes by an instruction."""
    if not entries:
        return
    yield write_front_heading(writer, title)
    last = len(entries) - 1
    for index, (entry, style) in enumerate(entries):
        before = _format_field_start(instruction) if index == 0 else ""
        after = _format_run_for_word('<w:fldChar w:fldCharType="end"/>') if index == last else ""
        yield _write_entry(writer, entry, style, pages.get(entry.bookmark, 1), (before, after))


def _write_entry(
    writer: DocxWriter, entry: ContentsEntry, style: str, page: int, field_runs: tuple[str, str]
) -> FlowPiece:
    """Write an entry with the number of its page. `field_runs` are the runs of the field that begins or ends with it."""
    face = writer.styles.find_face(style)
    width = writer.paper.base.text_width
    separator = ": " if style == "table of figures" else "  " if entry.label else ""
    text = f"{entry.label}{separator}{entry.title}"
    link = format_run(text) + "<w:r><w:tab/></w:r>" + format_field(f"PAGEREF {entry.bookmark} \\h", str(page))
    runs = f'{field_runs[0]}<w:hyperlink w:anchor="{entry.bookmark}" w:history="1">{link}</w:hyperlink>{field_runs[1]}'
    tabs = f'<w:tabs><w:tab w:val="right" w:leader="dot" w:pos="{points_to_twips(width)}"/></w:tabs>'
    # A style with an indent at the right keeps its words off the numbers itself.
    rows = (face.line,) * face.count_lines(text, width - (0 if face.right else _NUMBER_WIDTH))
    xml = format_paragraph(writer.styles.find_style_id(style), runs, tabs)
    return FlowPiece(xml, rows, face.before, face.after, whole=True)


def _format_field_start(instruction: str) -> str:
    return (
        _format_run_for_word('<w:fldChar w:fldCharType="begin"/>')
        + _format_run_for_word(f'<w:instrText xml:space="preserve"> {escape_text(instruction)} </w:instrText>')
        + _format_run_for_word('<w:fldChar w:fldCharType="separate"/>')
    )


def _format_run_for_word(content: str) -> str:
    """Return a run whose content is only for programs that know Word 2016's additions (ECMA-376 part 3)."""
    choice = f'<mc:Choice Requires="w16se">{content}</mc:Choice>'
    return f"<w:r><mc:AlternateContent>{choice}<mc:Fallback/></mc:AlternateContent></w:r>"
