"""Captions of figures and tables, their numbers as fields that Word counts (python-docx has a style for them, and no number)."""

from __future__ import annotations

from typing import Literal

from archgen.emit.docx.docx_writer import ContentsEntry, DocxWriter
from archgen.emit.docx.page_flow import FlowPiece, PaperSheet
from archgen.emit.docx.word_xml import format_field, format_paragraph, format_run, name_bookmark


def write_caption(
    writer: DocxWriter,
    anchor: str,
    text: str,
    sheet: PaperSheet | None,
    kind: Literal["Figure", "Table"] = "Figure",
) -> FlowPiece:
    """Write a caption; it goes into the list of figures or tables."""
    entries = writer.figures if kind == "Figure" else writer.tables
    anchor = writer.find_free_anchor(anchor)
    number = str(len(entries) + 1)
    entry = ContentsEntry(name_bookmark(anchor), f"{kind} {number}", text)
    entries.append(entry)
    # The field's name is the one that the list of figures or tables collects (`\c` in `contents_lists`).
    label = format_run(f"{kind} ") + format_field(f"SEQ {kind} \\* ARABIC", number)
    runs = writer.format_label(anchor, label) + format_run(f": {text}")
    face = writer.styles.find_face("caption")
    rows = (face.line,) * face.count_lines(f"{entry.label}: {text}", (sheet or writer.paper.base).text_width)
    # A table's caption stands above it, and must not stay behind on the page before.
    above = kind == "Table"
    return FlowPiece(
        format_paragraph(
            writer.styles.find_style_id("caption"),
            writer.format_bookmark(anchor) + runs,
            "<w:keepNext/>" if above else "",
        ),
        rows,
        face.before,
        face.after,
        keep_next=above,
        whole=True,
        sheet=sheet,
        marks=(entry.bookmark,),
        captions=kind,
    )
