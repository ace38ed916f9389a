"""What a document says about itself: its title page, and its properties."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.opc.parts.coreprops import CorePropertiesPart
from docx.oxml.coreprops import CT_CoreProperties
from docx.package import Package

from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.figures import write_figure
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.table_pieces import write_facts, write_table
from archgen.emit.docx.text_pieces import ParagraphContent, join_text, write_paragraph, write_text
from archgen.emit.docx.word_xml import clean_line, format_paragraph, format_run
from archgen.emit.own_file_marks import PROGRAM_NAME, PROGRAM_PART
from archgen.views.shapes import Facts, Figure, Outline, Section, Table


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
    """Write the report's own properties. The template's are gone (see `template_repair`)."""
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
