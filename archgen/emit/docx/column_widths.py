"""How wide the columns of a table are, and whether its words fit a sheet: by the widths of words, as Word knows no such layout."""

from __future__ import annotations

import math
from collections.abc import Sequence

from archgen.emit.docx.docx_writer import ColumnMeasures, DocxWriter
from archgen.emit.docx.paper_sheets import PaperSheet
from archgen.emit.docx.text_pieces import measure_bar
from archgen.emit.text_metrics import join_hard_blanks, measure_code, measure_words, split_name
from archgen.frozen import dataclass
from archgen.views.shapes import Column, Inlines, Table

CELL_MARGINS = 10.0
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


USUAL_STYLES = TableStyles()
SMALL_STYLES = TableStyles("Small Table Text", "Small Table Heading")


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
        fits = _fits_sheet(writer, content, wide, USUAL_STYLES, _MAX_WORD_SHARE)
        return wide, USUAL_STYLES if fits else SMALL_STYLES
    if not shape.dense and _fits_sheet(writer, content, base, USUAL_STYLES, _MAX_WORD_SHARE):
        return None, USUAL_STYLES
    fits = _fits_sheet(writer, content, base, SMALL_STYLES, _MAX_SMALL_WORD_SHARE)
    return (None if fits else wide), SMALL_STYLES


def share_width(writer: DocxWriter, content: TableContent, total: float, styles: TableStyles) -> list[float]:
    """Return the width of each column in points.

    Each has the room of its longest line where that is less than its share by weight, and what is left goes to the others;
    none has less than its longest word, as far as there is room.
    """
    words, lines, parts = _measure_columns(writer, content, styles)
    least = [min(width, total * _MAX_WORD_SHARE) for width in words]
    if math.fsum(least) >= total:
        # Names give way first: they may be broken, other words may not.
        excess, give = math.fsum(least) - total, [max(a - b, 0) for a, b in zip(least, parts, strict=True)]
        share = min(excess / math.fsum(give), 1) if any(give) else 0
        least = [width - room * share for width, room in zip(least, give, strict=True)]
        return [width * total / math.fsum(least) for width in least]
    lines = [max(line, word) for line, word in zip(lines, least, strict=True)]
    if math.fsum(lines) <= total:
        return [line * total / math.fsum(lines) for line in lines]
    # A weight of 0 or less is no mistake to stop at: such a column gets what its words need.
    weights = [max(column.weight, 0.01) for column in content.columns]
    return _fill_widths(lines, least, weights, total)


def _fill_widths(lines: Sequence[float], least: Sequence[float], weights: Sequence[float], total: float) -> list[float]:
    """Give columns their longest lines, or their longest words, as long as the others' shares by weight allow no more."""
    widths: dict[int, float] = {}
    open_columns = list(range(len(lines)))
    while open_columns:
        room = total - math.fsum(widths.values())
        weight = math.fsum(weights[index] for index in open_columns)
        shares = {index: room * weights[index] / weight for index in open_columns}
        # Who needs more than its share comes first: what it takes, the others lack.
        settled = {index: least[index] for index in open_columns if least[index] > shares[index]} or {
            index: lines[index] for index in open_columns if lines[index] <= shares[index]
        }
        widths |= settled or shares
        open_columns = [index for index in open_columns if index not in (settled or shares)]
    return [widths[index] for index in range(len(lines))]


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
        [width + CELL_MARGINS for width in words],
        [width + CELL_MARGINS for width in lines],
        [width + CELL_MARGINS for width in parts],
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
