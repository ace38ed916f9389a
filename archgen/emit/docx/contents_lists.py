"""The title page, and the tables of contents, figures and tables: every entry a link with the number of its page.

Word gets a real field around them, which somebody can update. LibreOffice keeps what such a field holds as it is, wrong numbers too, while it
computes the page of an entry that stands outside of one. So the outer field is written for those alone who know Word 2016's additions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.opc.parts.coreprops import CorePropertiesPart
from docx.oxml.coreprops import CT_CoreProperties
from docx.package import Package

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.figures import write_figure
from archgen.emit.docx.page_flow import FlowPiece, PaperSheet
from archgen.emit.docx.table_pieces import write_facts, write_table
from archgen.emit.docx.text_pieces import ParagraphContent, join_text, write_paragraph, write_text
from archgen.emit.docx.word_xml import (
    clean_line,
    escape_text,
    format_field,
    format_paragraph,
    format_run,
    points_to_twips,
)
from archgen.emit.own_file_marks import PROGRAM_NAME, PROGRAM_PART
from archgen.frozen import dataclass, replace
from archgen.views.shapes import Facts, Figure, Outline, Section, Table

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


def list_placeholder_values(outline: Outline) -> dict[str, str]:
    """Return what a template may ask for by a name in double braces: what the document says of itself, and its facts."""
    facts = {name.casefold(): join_text(value).replace("\n", ", ") for name, value in outline.facts}
    return {**facts, **outline.properties, "title": outline.title, "subtitle": outline.subtitle}


def write_title_page(writer: DocxWriter, outline: Outline, cover_names: Collection[str]) -> Iterator[FlowPiece]:
    """Write the title page, without what a template's cover shows: `cover_names` are the placeholders on it.

    A cover that shows the title and facts of its own needs no page of facts behind it.
    """
    if "title" not in cover_names:
        yield write_text(writer, ParagraphContent(format_run(outline.title), outline.title), "Title")
        if outline.subtitle:
            yield write_text(writer, ParagraphContent(format_run(outline.subtitle), outline.subtitle), "Subtitle")
    shows_facts = "title" in cover_names and len(cover_names) > 1
    facts = tuple(row for row in outline.facts if row[0].casefold() not in cover_names)
    if facts and not shows_facts:
        yield from write_facts(writer, Facts(facts))
    if outline.title_table and not shows_facts:
        yield from write_table(writer, outline.title_table)
    for notice in outline.notices:
        yield write_paragraph(writer, notice)


def write_front_sections(writer: DocxWriter, outline: Outline, cover_names: Collection[str]) -> Iterator[FlowPiece]:
    """Write what stands before the contents, under headings that neither count nor are listed."""
    sections = outline.front_sections
    if "title" in cover_names and len(cover_names) > 1:
        # What the cover has no line for is not lost.
        facts = tuple(row for row in outline.facts if row[0].casefold() not in cover_names)
        partners = (outline.title_table,) if outline.title_table else ()
        blocks = (*((Facts(facts),) if facts else ()), *partners)
        sections = (Section("front:document", "About this document", blocks), *sections) if blocks else sections
    for section in sections:
        yield write_front_heading(writer, section.title)
        for block in section.blocks:
            if isinstance(block, Facts):
                yield from write_facts(writer, block)
            elif isinstance(block, Table):
                yield from write_table(writer, block)
            elif isinstance(block, Figure):
                yield from write_figure(writer, block)


def write_front_heading(writer: DocxWriter, title: str) -> FlowPiece:
    """Write a heading that no list has: without number and outline level, which a template's style may bring."""
    face = writer.styles.find_face("TOC Heading")
    properties = '<w:numPr><w:numId w:val="0"/></w:numPr><w:outlineLvl w:val="9"/>'
    xml = format_paragraph(writer.styles.find_style_id("TOC Heading"), format_run(title), properties)
    return FlowPiece(xml, (face.line,), face.before, face.after, keep_next=True)


_MAX_LENGTH = 255
"""Characters that Word allows in a property; python-docx raises ValueError beyond them."""
_PROPERTY_NAMES = {"author": "authors", "category": "dissemination", "version": "version", "content_status": "status"}
"""Word's properties, and what the document says of itself under other names."""


def write_core_properties(document: Document, package: Package, outline: Outline) -> None:
    """Write the report's own properties. The template's are gone (see `report_template`)."""
    # An empty part comes first: the one that python-docx would add says python-docx, and the time of day.
    part = CorePropertiesPart(
        PackURI("/docProps/core.xml"), CONTENT_TYPE.OPC_CORE_PROPERTIES, CT_CoreProperties.new(), package
    )
    package.relate_to(part, RELATIONSHIP_TYPE.CORE_PROPERTIES)
    properties = document.core_properties
    properties.title = clean_line(outline.title)[:_MAX_LENGTH]
    said = {name: clean_line(value)[:_MAX_LENGTH] for name, value in outline.properties.items()}
    # Word has no field for a document's number; its readers look for it in the subject.
    number = outline.properties.get("number", "")
    subject = f"{number} {outline.subtitle}".strip() if number else outline.subtitle
    properties.subject = clean_line(subject)[:_MAX_LENGTH]
    for name, key in _PROPERTY_NAMES.items():
        if said.get(key):
            setattr(properties, name, said[key])
    properties.language = clean_line(outline.language)[:_MAX_LENGTH]
    _write_program_name(package)


def _write_program_name(package: Package) -> None:
    """Say which program wrote the document, as all that write Word files do: by this its next version may replace it."""
    xml = (
        "<?xml version='1.0' encoding='UTF-8' standalone='yes'?>\n"
        '<Properties xmlns="http://schemas.openxmlformats.org/officeDocument/2006/extended-properties">'
        f"<Application>{PROGRAM_NAME}</Application></Properties>"
    )
    part = Part(PackURI(f"/{PROGRAM_PART}"), CONTENT_TYPE.OFC_EXTENDED_PROPERTIES, xml.encode(), package)
    package.relate_to(part, RELATIONSHIP_TYPE.EXTENDED_PROPERTIES)
