"""Tables of three sorts: those of the report with their captions, facts, and those in a chapter.

How wide columns are follows from the widths of words, as does whether they fit a sheet: Word knows no such layout.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from archgen.emit.docx.captions import write_caption
from archgen.emit.docx.docx_writer import ColumnMeasures, DocxWriter
from archgen.emit.docx.page_flow import FlowPiece, PaperSheet
from archgen.emit.docx.text_pieces import MUTED_SETTING, RunSetting, format_runs, join_text, measure_bar
from archgen.emit.docx.word_xml import escape_text, format_paragraph, format_run, points_to_twips
from archgen.emit.text_metrics import (
    TextFace,
    join_hard_blanks,
    measure_code,
    measure_word,
    measure_words,
    share_width,
    split_name,
)
from archgen.frozen import dataclass, replace
from archgen.views.shapes import Column, Facts, Inlines, Table

_CELL_MARGINS = 10.0
"""Points that a cell's margins take from its width."""
_MAX_WORD_SHARE = 0.4
"""Share of the table that one unbroken word may claim; a longer one (a topic's name) is broken."""
_MAX_SMALL_WORD_SHARE = 0.25
_MAX_DENSE_NAME_SHARE = 0.2
_MAX_NAME_SHARE = 0.3
"""Share of the upright page that a name may claim before it is broken behind its underscores, points and slashes."""


@dataclass(frozen=True, slots=True)
class TableStyles:
    """The styles of a table's text and of its header row."""

    text: str = "Table Text"
    heading: str = "Table Heading"


_USUAL_STYLES = TableStyles()
_SMALL_STYLES = TableStyles("Small Table Text", "Small Table Heading")


@dataclass(frozen=True, slots=True)
class TableContent:
    """The columns and rows of a table, as far as its widths depend on them. `table_id` is that of a table of the outline."""

    columns: Sequence[Column]
    rows: Sequence[Sequence[Inlines]]
    table_id: int | None = None
    max_name_share: float = _MAX_NAME_SHARE

    @classmethod
    def from_table(cls, shape: Table) -> TableContent:
        """Return the content of a table of the outline, which lives as long as the report is written."""
        max_name_share = _MAX_DENSE_NAME_SHARE if shape.dense else _MAX_NAME_SHARE
        return cls(shape.columns, shape.rows, id(shape), max_name_share)


def choose_table_sheet(writer: DocxWriter, shape: Table) -> tuple[PaperSheet | None, TableStyles]:
    """Return a table's sheet (None for the usual one) and styles.

    Small type comes before a turned page, and that only if even so its words do not fit.
    """
    base, wide = writer.paper.base, writer.paper.wide
    content = TableContent.from_table(shape)
    if shape.wide:
        fits = _fits_sheet(writer, content, wide, _USUAL_STYLES, _MAX_WORD_SHARE)
        return wide, _USUAL_STYLES if fits else _SMALL_STYLES
    if not shape.dense and _fits_sheet(writer, content, base, _USUAL_STYLES, _MAX_WORD_SHARE):
        return None, _USUAL_STYLES
    fits = _fits_sheet(writer, content, base, _SMALL_STYLES, _MAX_SMALL_WORD_SHARE)
    return (None if fits else wide), _SMALL_STYLES


def _share_width(writer: DocxWriter, content: TableContent, total: float, styles: TableStyles) -> list[float]:
    """Return the width of each column in points."""
    words, lines, parts = _measure_columns(writer, content, styles)
    weights = [column.weight for column in content.columns]
    return share_width([min(width, total * _MAX_WORD_SHARE) for width in words], lines, parts, weights, total)


def _measure_columns(writer: DocxWriter, content: TableContent, styles: TableStyles) -> ColumnMeasures:
    """Return the width of each column's longest word, of its longest line, and of its longest part of a name."""
    # Asked three times for a table: whether it needs a turned page, whether it fits one, and how wide its columns are.
    if content.table_id is None:
        return _measure_cells(writer, content, styles)
    key = (content.table_id, styles.text)
    if key not in writer.column_measures:
        writer.column_measures[key] = _measure_cells(writer, content, styles)
    return writer.column_measures[key]


def _measure_cells(writer: DocxWriter, content: TableContent, styles: TableStyles) -> ColumnMeasures:
    text, head = writer.styles.find_face(styles.text), writer.styles.find_face(styles.heading)
    words = [max(measure_words(column.title), default=0) * head.size * head.factor for column in content.columns]
    lines = [
        math.fsum(measure_words(column.title)) * head.size * head.factor + column.title.count(" ") * head.size / 4
        for column in content.columns
    ]
    parts = list(words)
    max_name = writer.paper.base.text_width * content.max_name_share
    for row in content.rows:
        for index, cell in enumerate(row[: len(words)]):
            line_width = 0.0
            for item in cell:
                if bar := measure_bar(item):
                    words[index] = max(words[index], bar)
                    parts[index] = max(parts[index], bar)
                    line_width += bar
                scale = text.size * text.factor
                widths = (
                    [measure_code(word) * text.size for word in item.text.split()]
                    if item.code
                    else [width * scale for width in measure_words(item.text)]
                )
                words[index] = max(words[index], *_list_least_widths(item.text, widths, max_name), 0)
                max_part = 0.0 if item.code else math.inf
                parts[index] = max(parts[index], *_list_least_widths(item.text, widths, max_part), 0)
                line_width = math.fsum(widths) + (0.0 if item.line_break else line_width)
                # A blank is about a quarter of the type size.
                lines[index] = max(lines[index], line_width + len(widths) * scale / 4)
    return (
        [width + _CELL_MARGINS for width in words],
        [width + _CELL_MARGINS for width in lines],
        [width + _CELL_MARGINS for width in parts],
    )


def _list_least_widths(text: str, widths: Sequence[float], max_name: float) -> list[float]:
    """Return the widths of words, of those above a limit that of their longest part."""
    return [
        width if width <= max_name else max(width * len(part) / len(word) for part in split_name(word))
        for word, width in zip(join_hard_blanks(text).split(), widths, strict=False)
    ]


def _fits_sheet(
    writer: DocxWriter, content: TableContent, sheet: PaperSheet, styles: TableStyles, max_share: float
) -> bool:
    """Tell whether the longest words of all columns stand beside each other; none claims more than a share of the sheet."""
    words, _, _ = _measure_columns(writer, content, styles)
    return math.fsum(min(width, sheet.text_width * max_share) for width in words) <= sheet.text_width


_SPACER_HEIGHT = 8.0
_TABLE_END = "</w:tbl>"
_SHORT_HEIGHT = 130.0
"""Points below which a table stays on one page."""
_FACTS_HEIGHT = 300.0
"""The same for a table of facts, which has no header row to repeat: its rows are read together."""
_LINE_HEIGHT = 0.25
"""Points that the line between two rows takes; measured with LibreOffice."""
_BOLD = "<w:b/><w:bCs/>"
_LARGE = f'{_BOLD}<w:color w:val="0B5A9C"/><w:sz w:val="32"/><w:szCs w:val="32"/>'
"""The figures of a table without a header: what stands below them says what they are."""
_MAX_BLOCK_SHARE = 0.6
"""Share of a page that a small table takes at most to stay on one."""
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
    styles: TableStyles = _USUAL_STYLES
    is_whole: bool = False
    """Stays on one page where it takes no more than most of one."""


def _write_table_rows(
    writer: DocxWriter, header: Sequence[WordCell], body: Sequence[Sequence[WordCell]], frame: TableFrame
) -> FlowPiece:
    """Write a table (without header row if that is empty), with the small empty paragraph behind it.

    Two tables with nothing between them are one table to Word.
    """
    styles = writer.styles
    heights = [_measure_row(row, frame.widths, styles.find_face(frame.styles.text)) for row in body]
    header_height = _measure_row(header, frame.widths, styles.find_face(frame.styles.heading)) if header else 0.0
    page = (frame.sheet or writer.paper.base).text_height
    limit = page * _MAX_BLOCK_SHARE if frame.is_whole else _SHORT_HEIGHT if header else _FACTS_HEIGHT
    short = header_height + math.fsum(heights) <= limit
    # A template's plain grid does not tell its first row from the others.
    shade = _HEADER_SHADE if styles.find_style_id(frame.style) == styles.find_style_id("Table Grid") else ""
    starts = [f'<w:tc><w:tcPr><w:tcW w:w="{points_to_twips(width)}" w:type="dxa"/>' for width in frame.widths]
    rows = []
    if header:
        heading_style = f'<w:pStyle w:val="{styles.find_style_id(frame.styles.heading)}"/>'
        header_starts = [start + shade for start in starts]
        rows.append(_format_row(header_starts, header, heading_style, _KEEP_WHOLE + "<w:tblHeader/>"))
    text_style = f'<w:pStyle w:val="{styles.find_style_id(frame.styles.text)}"/>'
    max_height = page * _MAX_WHOLE_SHARE
    last = len(body) - 1
    # The last row is not alone on a page, unless the two would fill one.
    kept_rows = {0, last - 1} if math.fsum(heights[-2:]) < max_height else {0}
    for index, row in enumerate(body):
        # The header row stays with the first row, a short table with all of them.
        keep = "<w:keepNext/>" if index < last and (short or index in kept_rows) else ""
        rows.append(_format_row(starts, row, text_style + keep, _KEEP_WHOLE if heights[index] < max_height else ""))
    # Exactly so high: the style's own spaces would add to it.
    line = points_to_twips(_SPACER_HEIGHT)
    spacing = f'<w:spacing w:before="0" w:after="0" w:line="{line}" w:lineRule="exact"/>'
    xml = (
        _format_opening(writer, frame, headed=bool(header))
        + "".join(rows)
        + _TABLE_END
        + format_paragraph(writer.styles.find_style_id("Normal"), "", spacing)
    )
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


def _measure_row(cells: Sequence[WordCell], widths: Sequence[float], face: TextFace) -> float:
    most = 1
    for cell, width in zip(cells, widths, strict=True):
        if cell.text:
            most = max(most, sum(face.count_lines(line, width - _CELL_MARGINS) for line in cell.text.split("\n")))
    return most * face.line + face.before + face.after + _LINE_HEIGHT


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
    widths = _share_width(writer, TableContent.from_table(shape), total, styles)
    size = writer.styles.find_face(styles.text).size
    settings = [RunSetting(size, width - _CELL_MARGINS) for width in widths]
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
    has_header = any(column.title for column in shape.columns)
    if not has_header:
        body = [[replace(cell, runs=cell.runs.replace(_BOLD, _LARGE)) for cell in row] for row in body]
    style = "Report Table" if has_header else "Report Facts"
    frame = TableFrame(widths, shape.caption, sheet, style, styles, is_whole=not shape.numbered)
    yield _write_table_rows(writer, header if has_header else [], body, frame)


def write_facts(writer: DocxWriter, shape: Facts) -> Iterator[FlowPiece]:
    """Write a short list of names and values as a table of two columns without a header."""
    width = writer.paper.base.text_width
    face = writer.styles.find_face("Table Text")
    longest = (
        max((measure_word(name) for name, _ in shape.rows), default=0) * face.size * face.factor + _CELL_MARGINS + 2
    )
    left = min(max(longest, width * _NAME_SHARE), width / 2)
    setting = RunSetting(face.size, width - left - _CELL_MARGINS)
    row_anchors = (*shape.row_anchors, *(None for _ in shape.rows))
    body = [
        [
            WordCell(writer.format_bookmark(anchor) + format_run(name, MUTED_SETTING), name),
            WordCell(format_runs(writer, value, setting), join_text(value)),
        ]
        for (name, value), anchor in zip(shape.rows, row_anchors, strict=False)
    ]
    if body:
        yield _write_table_rows(writer, [], body, TableFrame((left, width - left), style="Report Facts"))


def write_chapter_table(writer: DocxWriter, rows: Sequence[Sequence[Inlines]], aligns: Sequence[str]) -> FlowPiece:
    """Write a table from a chapter, without caption and number; its first row is the header."""
    cells = [_write_cells(writer, row, aligns, [RunSetting()] * len(row)) for row in rows]
    # Of a column's longest text the root: a long one breaks into lines, and must not squeeze the others.
    weights = [max(1.0, *(len(row[n].text) ** 0.5 for row in cells)) for n in range(len(cells[0]))]
    columns = [Column(cell.text, weight) for cell, weight in zip(cells[0], weights, strict=True)]
    content = TableContent(columns, rows[1:])
    widths = _share_width(writer, content, writer.paper.base.text_width, _USUAL_STYLES)
    return _write_table_rows(writer, cells[0], cells[1:], TableFrame(widths))


def _write_cells(
    writer: DocxWriter, row: Sequence[Inlines], aligns: Sequence[str], settings: Sequence[RunSetting]
) -> list[WordCell]:
    return [
        WordCell(format_runs(writer, cell, setting), join_text(cell), align)
        for cell, align, setting in zip(row, aligns, settings, strict=False)
    ]
