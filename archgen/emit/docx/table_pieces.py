"""Tables of three sorts: those of the report with their captions, facts, and those in a chapter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.emit.docx.captions import write_caption
from archgen.emit.docx.column_widths import CELL_MARGINS, USUAL_STYLES, TableContent, choose_table_sheet, share_width
from archgen.emit.docx.docx_writer import DocxWriter
from archgen.emit.docx.page_flow import FlowPiece
from archgen.emit.docx.table_rows import TableFrame, WordCell, write_table_rows
from archgen.emit.docx.text_metrics import measure_word
from archgen.emit.docx.text_runs import MUTED_COLOUR, RunSetting, format_runs, join_text
from archgen.emit.docx.word_xml import format_run
from archgen.views.shapes import Column, Facts, Inlines, Table

MAX_COLUMNS = 63
"""Word opens no table with more."""
_NAME_SHARE = 0.17
"""Share of the width that the names of facts get, if none of them needs more."""
_ALIGNMENTS = {"left": "", "right": '<w:jc w:val="right"/>', "centre": '<w:jc w:val="center"/>'}


def write_table(writer: DocxWriter, shape: Table) -> Iterator[FlowPiece]:
    """Write a table, with its caption above if it is numbered."""
    aligns = [_ALIGNMENTS[column.align] for column in shape.columns]
    anchor = writer.find_free_anchor(shape.anchor)
    sheet, styles = choose_table_sheet(writer, shape)
    bookmark = ""
    if shape.numbered and shape.caption:
        yield write_caption(writer, anchor, shape.caption, sheet, "Table")
    else:
        bookmark = writer.format_bookmark(anchor)
    total = (sheet or writer.paper.base).text_width
    widths = share_width(writer, TableContent.from_table(shape), total, styles)
    size = writer.styles.find_face(styles.text).size
    settings = [RunSetting(size, width - CELL_MARGINS) for width in widths]
    body = []
    row_anchors = (*shape.row_anchors, *(None for _ in shape.rows))
    for row, row_anchor in zip(shape.rows, row_anchors, strict=False):
        cells = _write_cells(writer, row, aligns, settings)
        cells += [WordCell("", "")] * (len(shape.columns) - len(cells))
        bookmark += writer.format_bookmark(row_anchor)
        if bookmark:
            cells[0] = WordCell(bookmark + cells[0].runs, cells[0].text, cells[0].align)
            bookmark = ""
        body.append(cells)
    header = [
        WordCell(format_run(column.title), column.title, align)
        for column, align in zip(shape.columns, aligns, strict=True)
    ]
    yield write_table_rows(writer, header, body, TableFrame(widths, shape.caption, sheet, styles=styles))


def write_facts(writer: DocxWriter, shape: Facts) -> Iterator[FlowPiece]:
    """Write a short list of names and values as a table of two columns without a header."""
    width = writer.paper.base.text_width
    face = writer.styles.find_face("Table Text")
    longest = (
        max((measure_word(name) for name, _ in shape.rows), default=0) * face.size * face.factor + CELL_MARGINS + 2
    )
    left = min(max(longest, width * _NAME_SHARE), width / 2)
    setting = RunSetting(face.size, width - left - CELL_MARGINS)
    row_anchors = (*shape.row_anchors, *(None for _ in shape.rows))
    body = [
        [
            WordCell(writer.format_bookmark(anchor) + format_run(name, MUTED_COLOUR), name),
            WordCell(format_runs(writer, value, setting), join_text(value)),
        ]
        for (name, value), anchor in zip(shape.rows, row_anchors, strict=False)
    ]
    if body:
        yield write_table_rows(writer, [], body, TableFrame((left, width - left), style="Report Facts"))


def write_chapter_table(writer: DocxWriter, rows: Sequence[Sequence[Inlines]], aligns: Sequence[str]) -> FlowPiece:
    """Write a table from a chapter, without caption and number; its first row is the header."""
    cells = [_write_cells(writer, row, aligns, [RunSetting()] * len(row)) for row in rows]
    # Of a column's longest text the root: a long one breaks into lines, and must not squeeze the others.
    weights = [max(1.0, *(len(row[n].text) ** 0.5 for row in cells)) for n in range(len(cells[0]))]
    columns = [Column(cell.text, weight) for cell, weight in zip(cells[0], weights, strict=True)]
    content = TableContent(columns, rows[1:])
    widths = share_width(writer, content, writer.paper.base.text_width, USUAL_STYLES)
    return write_table_rows(writer, cells[0], cells[1:], TableFrame(widths))


def _write_cells(
    writer: DocxWriter, row: Sequence[Inlines], aligns: Sequence[str], settings: Sequence[RunSetting]
) -> list[WordCell]:
    return [
        WordCell(format_runs(writer, cell, setting), join_text(cell), align)
        for cell, align, setting in zip(row, aligns, settings, strict=False)
    ]
