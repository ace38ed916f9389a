"""The tables of contents, figures and tables: every entry a link with the number of its page.

Word gets a real field around them, which somebody can update. LibreOffice keeps what such a field holds as it is, wrong numbers too, while it
computes the page of an entry that stands outside of one. So the outer field is written for those alone who know Word 2016's additions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.paper_sheets import PaperSheet
from archgen.emit.docx.title_page import write_front_heading
from archgen.emit.docx.word_xml import escape_text, format_field, format_paragraph, format_run, points_to_twips
from archgen.frozen import dataclass, replace

_MAX_LEVEL = 3
"""Levels of headings in the table of contents, if they fit a page or two."""
_MAX_LINES = 100
"""From this many lines on the contents have the first two levels alone."""
_MAX_TABLES = 60
_MIN_COLUMN_LINES = 45
"""From this many lines on, more than a page, the contents stand in two columns."""
_MIN_COLUMN_WIDTH = 200.0
"""Points that a column must have for a heading to fit a line or two."""
_NUMBER_WIDTH = 30.0
"""Points at the right that page numbers take."""


@dataclass(frozen=True, slots=True)
class ContentsList:
    """One of the lists: its title, the instruction that Word computes it by, entries with their styles, its sheet."""

    title: str
    instruction: str
    entries: Sequence[tuple[ContentsEntry, str]]
    sheet: PaperSheet


def write_contents(
    writer: DocxWriter,
    pages: Mapping[str, int],
    lists: Collection[str] = ("figures", "tables"),
    *,
    one_column: bool = False,
) -> Iterator[FlowPiece]:
    """Write the contents, and the lists that are asked for. `pages` has the page of each bookmark.

    A list of a single figure or table, or of none, is left out, and one of so many tables that nobody reads it.
    """
    # Switches (ECMA-376 17.16.5.68): \o by levels of headings, \h links, \z no numbers on a screen, \u outline levels of other
    # styles, \c the captions with a SEQ field of a name.
    level_count = _MAX_LEVEL - (sum(entry.level <= _MAX_LEVEL for entry in writer.headings) > _MAX_LINES)
    headings = [(entry, f"toc {entry.level}") for entry in writer.headings if entry.level <= level_count]
    base = writer.paper.base
    columns = replace(base, columns=2)
    has_columns = not one_column and len(headings) >= _MIN_COLUMN_LINES and columns.column_width >= _MIN_COLUMN_WIDTH
    instruction = f'TOC \\o "1-{level_count}" \\h \\z \\u'
    yield from _write_list(
        writer, ContentsList("Contents", instruction, headings, columns if has_columns else base), pages
    )
    for title, kind in (("Figures", "Figure"), ("Tables", "Table")):
        entries = [(entry, "table of figures") for entry in writer.find_contents(kind)]
        if kind == "Table" and "tables" in lists and len(entries) > _MAX_TABLES:
            writer.warn(f"the report has {len(entries)} tables: a list of more than {_MAX_TABLES} is left out")
        elif len(entries) > 1 and title.casefold() in lists:
            yield from _write_list(writer, ContentsList(title, f'TOC \\h \\z \\c "{kind}"', entries, base), pages)


def _write_list(writer: DocxWriter, contents: ContentsList, pages: Mapping[str, int]) -> Iterator[FlowPiece]:
    """Write a list of entries in a field that Word computes."""
    entries, last = contents.entries, len(contents.entries) - 1
    if not entries:
        return
    yield write_front_heading(writer, contents.title)
    for index, (entry, style) in enumerate(entries):
        before = _format_field_start(contents.instruction) if index == 0 else ""
        after = _format_run_for_word('<w:fldChar w:fldCharType="end"/>') if index == last else ""
        link = format_run(_join_title(entry, style)) + "<w:r><w:tab/></w:r>"
        number = format_field(f"PAGEREF {entry.bookmark} \\h", str(pages.get(entry.bookmark, 1)))
        runs = before + f'<w:hyperlink w:anchor="{entry.bookmark}" w:history="1">{link}{number}</w:hyperlink>' + after
        yield _write_entry(writer, runs, _join_title(entry, style), style, contents.sheet)


def _write_entry(writer: DocxWriter, runs: str, text: str, style: str, sheet: PaperSheet) -> FlowPiece:
    """Write the paragraph of an entry."""
    face = writer.styles.find_face(style)
    width = sheet.column_width
    tabs = f'<w:tabs><w:tab w:val="right" w:leader="dot" w:pos="{points_to_twips(width)}"/></w:tabs>'
    # A style with an indent at the right keeps its words off the numbers itself.
    line_count = face.count_lines(text, width - (0 if face.right else _NUMBER_WIDTH))
    xml = format_paragraph(writer.styles.find_style_id(style), runs, tabs)
    # Beside another column, a line takes its share of the page's height.
    line, before, after = (height / sheet.columns for height in (face.line, face.before, face.after))
    return FlowPiece(xml, (line,) * line_count, before, after, whole=True, sheet=sheet)


def _join_title(entry: ContentsEntry, style: str) -> str:
    separator = ": " if style == "table of figures" else "  " if entry.label else ""
    return f"{entry.label}{separator}{entry.title}"


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
