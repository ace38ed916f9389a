"""Tables: a header row that repeats, rows that stay whole, columns as wide as their words need, and never two tables that touch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.emit.docx import figures
from archgen.emit.docx.draft import Draft
from archgen.emit.docx.flow import Piece
from archgen.emit.docx.inlines import plain, runs
from archgen.emit.docx.markup import escape, paragraph, run, twips
from archgen.emit.docx.metrics import MONOSPACE, Face, word_width, word_widths
from archgen.emit.docx.sheets import Sheet
from archgen.views.shapes import Column, Facts, Inlines, Table

MOST_COLUMNS = 63
"""Word opens no table with more."""
_AIR = 12.0
"""Points that a cell's margins take from its width."""
_WIDEST_WORD = 0.4
"""Share of the table that one unbroken word may claim; a longer one (a topic's name) is broken."""
_WIDEST_SMALL_WORD = 0.25
_NATURAL = 2.0
"""How much more than its share a column may get for text that would else take many lines."""
_SPACER = 8.0
_SHORT = 130.0
"""Points below which a table stays on one page."""
_NAMES = 0.27
_LINE = 0.25
"""Points that the line between two rows takes; measured with LibreOffice."""
_WHOLE = "<w:cantSplit/>"
_TALL = 0.8
"""Share of a page above which a row may be split: it would not fit a page with its header."""
_LOOK = '<w:tblLook w:val="0420" w:firstRow="1" w:lastRow="0" w:firstColumn="0" w:lastColumn="0" w:noHBand="0" w:noVBand="1"/>'
_SHADE = '<w:shd w:val="clear" w:color="auto" w:fill="EDF1F4"/>'
_ALIGN = {"left": "", "right": '<w:jc w:val="right"/>', "centre": '<w:jc w:val="center"/>'}


@dataclass(frozen=True, slots=True)
class _Type:
    """The styles of a table's text and of its header row."""

    text: str = "Table Text"
    heading: str = "Table Heading"


_USUAL = _Type()
_SMALL = _Type("Small Table Text", "Small Table Heading")


@dataclass(frozen=True, slots=True)
class _Frame:
    """What a table is beside its cells: widths of columns in points, description, sheet, style and type."""

    widths: Sequence[float]
    description: str = ""
    sheet: Sheet | None = None
    style: str = "Report Table"
    kind: _Type = _USUAL


@dataclass(frozen=True, slots=True)
class _Cell:
    """A cell before it is set: its runs, its text, how it stands."""

    content: str
    text: str
    align: str = ""


def table(draft: Draft, shape: Table) -> Iterator[Piece]:
    """Give a table, with its caption above if it is numbered."""
    header = [_Cell(run(column.title), column.title, _ALIGN[column.align]) for column in shape.columns]
    anchors = (*shape.row_anchors, *(None for _ in shape.rows))
    caption_anchor = draft.fresh(shape.anchor)
    sheet, kind = fitting(draft, shape)
    if shape.numbered and shape.caption:
        yield figures.caption(draft, caption_anchor, shape.caption, sheet, "Table")
        start = ""
    else:
        start = draft.mark(caption_anchor)
    body = []
    for row, anchor in zip(shape.rows, anchors, strict=False):
        cells = [
            _Cell(runs(draft, cell), plain(cell), _ALIGN[column.align])
            for cell, column in zip(row, shape.columns, strict=False)
        ]
        cells += [_Cell("", "")] * (len(shape.columns) - len(cells))
        mark = start + draft.mark(anchor)
        start = ""
        body.append([_Cell(mark + cells[0].content, cells[0].text, cells[0].align), *cells[1:]] if mark else cells)
    widths = _widths(draft, shape.columns, shape.rows, (sheet or draft.sheets.base).text_width, kind)
    yield _grid(draft, header, body, _Frame(widths, shape.caption, sheet, kind=kind))


def fitting(draft: Draft, shape: Table) -> tuple[Sheet | None, _Type]:
    """Choose a table's sheet and type: small type before a turned page, and that only if even so its words do not fit."""
    base, wide = draft.sheets.base, draft.sheets.wide
    if shape.wide:
        return wide, _USUAL if _fits(draft, shape, wide, _USUAL, _WIDEST_WORD) else _SMALL
    if _fits(draft, shape, base, _USUAL, _WIDEST_WORD):
        return None, _USUAL
    return (None if _fits(draft, shape, base, _SMALL, _WIDEST_SMALL_WORD) else wide), _SMALL


def facts(draft: Draft, shape: Facts) -> Iterator[Piece]:
    """Give a short list of names and values as a table of two columns without a header."""
    width = draft.sheets.base.text_width
    face = draft.styles.face("Table Text")
    longest = max((word_width(name) for name, _ in shape.rows), default=0) * face.size * face.factor + _AIR + 2
    left = min(max(longest, width * _NAMES), width / 2)
    body = [
        [_Cell(run(name, '<w:color w:val="55606A"/>'), name), _Cell(runs(draft, value), plain(value))]
        for name, value in shape.rows
    ]
    if body:
        yield _grid(draft, [], body, _Frame((left, width - left), style="Report Facts"))


def simple(draft: Draft, header: Sequence[Inlines], body: Sequence[Sequence[Inlines]], aligns: Sequence[str]) -> Piece:
    """Give a table from a chapter, without caption and number."""
    cells = [_Cell(runs(draft, cell), plain(cell), align) for cell, align in zip(header, aligns, strict=True)]
    rows = [
        [_Cell(runs(draft, cell), plain(cell), align) for cell, align in zip(row, aligns, strict=True)] for row in body
    ]
    weights = [max(1.0, *(len(row[n].text) ** 0.5 for row in [cells, *rows])) for n in range(len(cells))]
    columns = tuple(Column(cell.text, weight) for cell, weight in zip(cells, weights, strict=True))
    texts = tuple(tuple(row) for row in body)
    widths = _widths(draft, columns, texts, draft.sheets.base.text_width, _USUAL)
    return _grid(draft, cells, rows, _Frame(widths))


def _grid(draft: Draft, header: Sequence[_Cell], body: Sequence[Sequence[_Cell]], frame: _Frame) -> Piece:
    """Set a table, with the small empty paragraph behind it that keeps it from the next."""
    styles, widths, kind = draft.styles, frame.widths, frame.kind
    heights = [_height(row, widths, styles.face(kind.text)) for row in body]
    top = _height(header, widths, styles.face(kind.heading)) if header else 0.0
    height = (frame.sheet or draft.sheets.base).text_height
    short = top + sum(heights) <= _SHORT
    shade = _SHADE if styles.id(frame.style) == styles.id("Table Grid") else ""
    starts = [f'<w:tc><w:tcPr><w:tcW w:w="{twips(width)}" w:type="dxa"/>' for width in widths]
    rows = []
    if header:
        shaded = [start + shade for start in starts]
        rows.append(_row(shaded, header, f'<w:pStyle w:val="{styles.id(kind.heading)}"/>', _WHOLE + "<w:tblHeader/>"))
    last = len(body) - 1
    for index, row in enumerate(body):
        keep = "<w:keepNext/>" if index < last and (short or index == 0) else ""
        whole = _WHOLE if heights[index] < height * _TALL else ""
        rows.append(_row(starts, row, f'<w:pStyle w:val="{styles.id(kind.text)}"/>{keep}', whole))
    spacing = f'<w:spacing w:before="0" w:after="0" w:line="{twips(_SPACER)}" w:lineRule="exact"/>'
    xml = _opening(draft, frame, headed=bool(header)) + "".join(rows) + "</w:tbl>"
    together = heights if short else heights[:2]
    rest = heights[len(together) :]
    spacer = paragraph(styles.id("Normal"), "", spacing)
    return Piece(xml + spacer, (top + sum(together), *rest, _SPACER), repeat=top, sheet=frame.sheet)


def _opening(draft: Draft, frame: _Frame, *, headed: bool) -> str:
    total = sum(twips(width) for width in frame.widths)
    columns = "".join([f'<w:gridCol w:w="{twips(width)}"/>' for width in frame.widths])
    return (
        f'<w:tbl><w:tblPr><w:tblStyle w:val="{draft.styles.id(frame.style)}"/><w:tblW w:w="{total}" w:type="dxa"/>'
        f'<w:tblLayout w:type="fixed"/>{_LOOK if headed else ""}{_described(frame.description)}</w:tblPr>'
        f"<w:tblGrid>{columns}</w:tblGrid>"
    )


def _described(description: str) -> str:
    return (
        f'<w:tblCaption w:val="{escape(description)}"/><w:tblDescription w:val="{escape(description)}"/>'
        if description
        else ""
    )


def _row(starts: Sequence[str], cells: Sequence[_Cell], set_as: str, kind: str) -> str:
    inner = "".join(
        [
            f"{start}</w:tcPr><w:p><w:pPr>{set_as}{cell.align}</w:pPr>{cell.content}</w:p></w:tc>"
            for start, cell in zip(starts, cells, strict=True)
        ]
    )
    return f"<w:tr>{f'<w:trPr>{kind}</w:trPr>' if kind else ''}{inner}</w:tr>"


def _height(cells: Sequence[_Cell], widths: Sequence[float], face: Face) -> float:
    most = 1
    for cell, width in zip(cells, widths, strict=True):
        if cell.text:
            most = max(most, sum(face.lines(line, width - _AIR) for line in cell.text.split("\n")))
    return most * face.line + face.before + face.after + _LINE


def _needs(
    draft: Draft, columns: Sequence[Column], rows: Sequence[Sequence[Inlines]], kind: _Type
) -> tuple[list[float], list[float]]:
    """Give the width of each column's longest word and of its longest line, with the cell's margins."""
    text, head = draft.styles.face(kind.text), draft.styles.face(kind.heading)
    words = [max(word_widths(column.title), default=0) * head.size * head.factor for column in columns]
    whole = list(words)
    for row in rows:
        for index, cell in enumerate(row[: len(words)]):
            used = 0.0
            for item in cell:
                scale = text.size * (text.factor if not item.code else MONOSPACE)
                widths = [width * scale for width in word_widths(item.text)]
                words[index] = max(words[index], *widths, 0)
                used = sum(widths) + (0.0 if item.line_break else used)
                whole[index] = max(whole[index], used + len(widths) * scale / 4)
    return [width + _AIR for width in words], [width + _AIR for width in whole]


def _fits(draft: Draft, shape: Table, sheet: Sheet, kind: _Type, most: float) -> bool:
    longest, _ = _needs(draft, shape.columns, shape.rows, kind)
    return sum(min(width, sheet.text_width * most) for width in longest) <= sheet.text_width


def _widths(
    draft: Draft, columns: Sequence[Column], rows: Sequence[Sequence[Inlines]], total: float, kind: _Type
) -> list[float]:
    """Share the width by the columns' weights, but give each the room of its longest word, as far as there is any."""
    words, whole = _needs(draft, columns, rows, kind)
    least = [min(width, total * _WIDEST_WORD) for width in words]
    if sum(least) >= total:
        return [width * total / sum(least) for width in least]
    weight = sum(max(column.weight, 0.01) for column in columns)
    share = [total * max(column.weight, 0.01) / weight for column in columns]
    wanted = [max(part, min(line, part * _NATURAL)) for part, line in zip(share, whole, strict=True)]
    spare = [max(want - need, 0) for want, need in zip(wanted, least, strict=True)]
    room = total - sum(least)
    return [
        need + room * (extra / sum(spare) if sum(spare) else 1 / len(least))
        for need, extra in zip(least, spare, strict=True)
    ]
