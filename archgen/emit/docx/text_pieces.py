"""Headings, paragraphs and lists, as pieces of the report's flow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.heading_numbers import format_heading_number
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.style_table import HEADING_LEVELS
from archgen.emit.docx.text_runs import format_runs, join_text
from archgen.emit.docx.word_xml import format_paragraph, format_run, name_bookmark
from archgen.views.shapes import Bullets, Inlines, Paragraph

_PARAGRAPH_STYLES = {"text": "Normal", "note": "Note Box", "warning": "Warning Box", "error": "Error Box"}
_LIST_STEP = 18.0
"""Points that a list moves to the right for each level."""


@dataclass(frozen=True, slots=True)
class ParagraphContent:
    """What stands in a paragraph: its runs, their plain text, and the points of height that pictures among them add."""

    runs: str
    text: str
    picture_height: float = 0


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading before it is written. `level` counts from 1."""

    anchor: str
    title: str
    level: int
    appendix: bool = False
    new_page: bool = False


def write_heading(writer: DocxWriter, heading: Heading) -> FlowPiece:
    """Write a numbered heading; it goes into the table of contents."""
    level = min(heading.level, HEADING_LEVELS)
    anchor = writer.find_free_anchor(heading.anchor)
    label = _count_heading(writer, level, appendix=heading.appendix)
    entry = ContentsEntry(name_bookmark(anchor), label, heading.title, level)
    writer.headings.append(entry)
    # The heading styles number chapters; an appendix has the same style and the lettered list.
    number = _format_number(level - 1, writer.numbering.appendix) if heading.appendix else ""
    properties = ("<w:pageBreakBefore/>" if heading.new_page else "") + number
    face = writer.styles.find_face(f"heading {level}")
    rows = (face.line,) * face.count_lines(f"{label} {heading.title}", writer.paper.base.text_width)
    runs = writer.format_bookmark(anchor) + format_run(heading.title)
    return FlowPiece(
        format_paragraph(writer.styles.find_heading_id(level), runs, properties),
        rows,
        face.before,
        face.after,
        keep_next=True,
        whole=True,
        new_page=heading.new_page,
        marks=(entry.bookmark,),
    )


def write_content(writer: DocxWriter, inlines: Inlines) -> ParagraphContent:
    """Write runs of text with their plain text."""
    return ParagraphContent(format_runs(writer, inlines), join_text(inlines))


def write_paragraph(writer: DocxWriter, shape: Paragraph) -> FlowPiece:
    """Write a paragraph, plain or one that stands out."""
    return write_text(writer, write_content(writer, shape.inlines), _PARAGRAPH_STYLES[shape.kind])


def write_text(
    writer: DocxWriter, content: ParagraphContent, style: str = "Normal", properties: str = "", indent: float = 0
) -> FlowPiece:
    """Write a paragraph in a style, `indent` points from the left margin."""
    face = writer.styles.find_face(style)
    width = writer.paper.base.text_width - indent
    count = sum(face.count_lines(line, width) for line in content.text.split("\n"))
    rows = (*((face.line,) * (count - 1)), face.line + content.picture_height)
    xml = format_paragraph(writer.styles.find_style_id(style), content.runs, properties)
    return FlowPiece(xml, rows, face.before, face.after)


def keep_with_next(piece: FlowPiece) -> FlowPiece:
    """Return a paragraph that stays on the page, and the paper, of what follows it."""
    style_end = piece.xml.index("/>", piece.xml.index("<w:pStyle")) + 2
    xml = f"{piece.xml[:style_end]}<w:keepNext/>{piece.xml[style_end:]}"
    return replace(piece, xml=xml, keep_next=True, whole=True)


def write_bullets(writer: DocxWriter, shape: Bullets) -> Iterator[FlowPiece]:
    """Write a list, each item a paragraph."""
    list_id = writer.numbering.add_ordered_list(1) if shape.ordered else writer.numbering.bullet
    for item in shape.items:
        yield write_list_item(writer, write_content(writer, item), list_id, 0, ordered=shape.ordered)


def write_list_item(
    writer: DocxWriter, content: ParagraphContent, list_id: int, depth: int, *, ordered: bool
) -> FlowPiece:
    """Write an item of a list; the outermost list has depth 0."""
    style = "List Number" if ordered else "List Bullet"
    return write_text(writer, content, style, _format_number(depth, list_id), _LIST_STEP * (depth + 1))


def _count_heading(writer: DocxWriter, level: int, *, appendix: bool) -> str:
    """Count a heading, and return its number as text."""
    counts = writer.heading_counts
    counts[level:] = []
    counts += [0] * (level - len(counts))
    counts[level - 1] += 1
    return format_heading_number(writer.numbering.appendices if appendix else writer.numbering.headings, counts)


def _format_number(depth: int, list_id: int) -> str:
    return f'<w:numPr><w:ilvl w:val="{depth}"/><w:numId w:val="{list_id}"/></w:numPr>'
