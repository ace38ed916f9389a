"""A table's rows as text, and their heights.

python-docx's `Document.add_table` takes 0.86 ms for a cell with a style: 8.5 s for the 9,930 cells of example_ramcip, whose whole
report takes 1.2 s. As text its 457 tables take 0.04 s, and less than 0.06 s to parse.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from archgen.emit.docx.column_widths import CELL_MARGINS, USUAL_STYLES, TableStyles
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.paper_sheets import PaperSheet
from archgen.emit.docx.text_metrics import TextFace
from archgen.emit.docx.word_xml import escape_text, format_paragraph, points_to_twips

_SPACER_HEIGHT = 8.0
_TABLE_END = "</w:tbl>"
_SHORT_HEIGHT = 130.0
"""Points below which a table stays on one page."""
_FACTS_HEIGHT = 300.0
"""The same for a table of facts, which has no header row to repeat: its rows are read together."""
_LINE_HEIGHT = 0.25
"""Points that the line between two rows takes; measured with LibreOffice."""
_KEEP_WHOLE = "<w:cantSplit/>"
_MAX_WHOLE_SHARE = 0.8
"""Share of a page above which a row may be split: it would not fit a page with its header."""
# Header row and bands across, no first column; `w:val` is the same in the bits that Word 2007 reads.
_LOOK = '<w:tblLook w:val="0420" w:firstRow="1" w:lastRow="0" w:firstColumn="0" w:lastColumn="0" w:noHBand="0" w:noVBand="1"/>'
_HEADER_SHADE = '<w:shd w:val="clear" w:color="auto" w:fill="EDF1F4"/>'


@dataclass(frozen=True, slots=True)
class WordCell:
    """A cell before it is written: its runs, their plain text, its alignment as properties of its paragraph."""

    runs: str
    text: str
    align: str = ""


@dataclass(frozen=True, slots=True)
class TableFrame:
    """What a table is beside its cells: widths of columns in points, description, sheet, style, and styles of its text."""

    widths: Sequence[float]
    description: str = ""
    sheet: PaperSheet | None = None
    style: str = "Report Table"
    styles: TableStyles = USUAL_STYLES


def write_table_rows(
    writer: DocxWriter, header: Sequence[WordCell], body: Sequence[Sequence[WordCell]], frame: TableFrame
) -> FlowPiece:
    """Write a table (without header row if that is empty), with the small empty paragraph behind it.

    Two tables with nothing between them are one table to Word.
    """
    styles = writer.styles
    heights = [_measure_row(row, frame.widths, styles.find_face(frame.styles.text)) for row in body]
    header_height = _measure_row(header, frame.widths, styles.find_face(frame.styles.heading)) if header else 0.0
    short = header_height + math.fsum(heights) <= (_SHORT_HEIGHT if header else _FACTS_HEIGHT)
    # A template's plain grid does not tell its first row from the others.
    shade = _HEADER_SHADE if styles.find_style_id(frame.style) == styles.find_style_id("Table Grid") else ""
    starts = [f'<w:tc><w:tcPr><w:tcW w:w="{points_to_twips(width)}" w:type="dxa"/>' for width in frame.widths]
    rows = []
    if header:
        heading_style = f'<w:pStyle w:val="{styles.find_style_id(frame.styles.heading)}"/>'
        header_starts = [start + shade for start in starts]
        rows.append(_format_row(header_starts, header, heading_style, _KEEP_WHOLE + "<w:tblHeader/>"))
    text_style = f'<w:pStyle w:val="{styles.find_style_id(frame.styles.text)}"/>'
    max_height = (frame.sheet or writer.paper.base).text_height * _MAX_WHOLE_SHARE
    last = len(body) - 1
    # The last row is not alone on a page, unless the two would fill one.
    kept_rows = {0, last - 1} if math.fsum(heights[-2:]) < max_height else {0}
    for index, row in enumerate(body):
        # The header row stays with the first row, a short table with all of them.
        keep = "<w:keepNext/>" if index < last and (short or index in kept_rows) else ""
        rows.append(_format_row(starts, row, text_style + keep, _KEEP_WHOLE if heights[index] < max_height else ""))
    xml = _format_opening(writer, frame, headed=bool(header)) + "".join(rows) + _TABLE_END + _format_spacer(writer)
    # What stays together is one row to the estimate of pages.
    together = heights if short else heights[:2]
    piece_rows = (header_height + math.fsum(together), *heights[len(together) :], _SPACER_HEIGHT)
    return FlowPiece(xml, piece_rows, repeat=header_height, sheet=frame.sheet)


def drop_spacer(piece: FlowPiece) -> FlowPiece:
    """Return a table without the empty paragraph behind it; any other piece as it is. Its height stays: a page is full early."""
    end = piece.xml.rfind(_TABLE_END) + len(_TABLE_END)
    is_table = piece.xml.startswith("<w:tbl>")
    return replace(piece, xml=piece.xml[:end]) if is_table else piece


def _format_opening(writer: DocxWriter, frame: TableFrame, *, headed: bool) -> str:
    # The table is as wide as its rounded columns, which may be a twip off their rounded sum: width and grid must agree.
    widths = [points_to_twips(width) for width in frame.widths]
    columns = "".join([f'<w:gridCol w:w="{width}"/>' for width in widths])
    # Fixed: the widths are chosen here, and each program has its own way with an automatic layout.
    return (
        f'<w:tbl><w:tblPr><w:tblStyle w:val="{writer.styles.find_style_id(frame.style)}"/><w:tblW w:w="{sum(widths)}" w:type="dxa"/>'
        f'<w:tblLayout w:type="fixed"/>{_LOOK if headed else ""}{_format_description(frame.description)}</w:tblPr>'
        f"<w:tblGrid>{columns}</w:tblGrid>"
    )


def _format_description(description: str) -> str:
    """Return what screen readers say of a table."""
    if not description:
        return ""
    text = escape_text(description)
    return f'<w:tblCaption w:val="{text}"/><w:tblDescription w:val="{text}"/>'


def _format_row(starts: Sequence[str], cells: Sequence[WordCell], paragraph_style: str, row_properties: str) -> str:
    inner = "".join(
        [
            f"{start}</w:tcPr><w:p><w:pPr>{paragraph_style}{cell.align}</w:pPr>{cell.runs}</w:p></w:tc>"
            for start, cell in zip(starts, cells, strict=True)
        ]
    )
    return f"<w:tr>{f'<w:trPr>{row_properties}</w:trPr>' if row_properties else ''}{inner}</w:tr>"


def _format_spacer(writer: DocxWriter) -> str:
    # Exactly so high: the style's own spaces would add to it.
    line = points_to_twips(_SPACER_HEIGHT)
    spacing = f'<w:spacing w:before="0" w:after="0" w:line="{line}" w:lineRule="exact"/>'
    return format_paragraph(writer.styles.find_style_id("Normal"), "", spacing)


def _measure_row(cells: Sequence[WordCell], widths: Sequence[float], face: TextFace) -> float:
    most = 1
    for cell, width in zip(cells, widths, strict=True):
        if cell.text:
            most = max(most, sum(face.count_lines(line, width - CELL_MARGINS) for line in cell.text.split("\n")))
    return most * face.line + face.before + face.after + _LINE_HEIGHT
